#include "common/butterfly.h"

#include <algorithm>

namespace lacerta {

std::vector<float> ExtraordinaryStencil(int valence) {
  if (valence == 2) return {3.0f / 8, -1.0f / 8};
  if (valence == 3) return {5.0f / 12, -1.0f / 12, -1.0f / 12};
  if (valence == 4) return {3.0f / 8, 0.0f, -1.0f / 8, 0.0f};
  std::vector<float> weights(valence);
  constexpr double kPi = 3.14159265358979323846;
  for (int j = 0; j < valence; ++j) {
    weights[j] = static_cast<float>((0.25 + std::cos(2 * kPi * j / valence) + 0.5 * std::cos(4 * kPi * j / valence)) / valence);
  }
  return weights;
}

StencilTable::StencilTable(const Topology& topology) {
  for (uint32_t v = 0; v < topology.num_vertices; ++v) {
    const size_t valence = topology.valence[v];
    if (topology.role[v] != CurveRole::kSmooth || !IsExtraordinary(topology, v)) continue;
    if (weights_.size() <= valence) weights_.resize(valence + 1);
    if (weights_[valence].empty()) weights_[valence] = ExtraordinaryStencil(static_cast<int>(valence));
  }
}

namespace butterfly_internal {

uint32_t NextCurveEdge(const Topology& t, uint32_t edge, uint32_t vertex) {
  // Walk the fan of `vertex` from the curve edge `edge` to the next one, either way round: a fan with border ends in one.
  uint32_t face = t.edge_faces[edge][0];
  uint32_t spoke = edge;
  do {
    const auto& tri = t.triangles[face];
    const int corner = tri[0] == vertex ? 0 : tri[1] == vertex ? 1 : 2;
    const uint32_t e1 = t.face_edges[face][(corner + 1) % 3], e2 = t.face_edges[face][(corner + 2) % 3];
    spoke = e1 == spoke ? e2 : e1;
    face = FaceAcross(t, face, spoke);
  } while (!t.on_curve[spoke]);
  return spoke;
}

}  // namespace butterfly_internal

namespace {

// Whether the eight-point stencil of `edge` needs no case of its own: no curve at either end, and no extraordinary vertex.
bool IsPlain(const Topology& t, uint32_t edge) {
  for (const uint32_t v : t.edges[edge]) {
    if (t.role[v] != CurveRole::kSmooth || IsExtraordinary(t, v)) return false;
  }
  return true;
}

// For every corner of a face the vertex on the other side of its opposite edge; kNone beyond the border: #F.
std::vector<Triangle> VerticesAcross(const Topology& t) {
  std::vector<Triangle> across(t.num_faces());
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    const auto& [f, g] = t.edge_faces[e];
    const int i = EdgeCorner(t, f, e);
    if (g == kNone) {
      across[f][i] = kNone;
      continue;
    }
    const int k = EdgeCorner(t, g, e);
    across[f][i] = t.triangles[g][k];
    across[g][k] = t.triangles[f][i];
  }
  return across;
}

// What VisitRegular adds up at an edge that IsPlain, in the same order: nearly all edges of fine levels are.
Vec3f PredictPlain(const Topology& t, const std::vector<Triangle>& across, const Vec3f* positions, uint32_t edge) {
  constexpr int kNext[3] = {1, 2, 0}, kPrevious[3] = {2, 0, 1};
  const auto& [a, b] = t.edges[edge];
  Vec3f sum;
  sum += positions[a] * 0.5f;
  sum += positions[b] * 0.5f;
  for (const uint32_t face : t.edge_faces[edge]) {
    const int corner = EdgeCorner(t, face, edge);
    sum += positions[t.triangles[face][corner]] * 0.125f;
    sum += positions[across[face][kNext[corner]]] * -0.0625f;
    sum += positions[across[face][kPrevious[corner]]] * -0.0625f;
  }
  return sum;
}

}  // namespace

void PredictMidpoints(const Topology& t, const StencilTable& table, const Vec3f* positions, Vec3f* midpoints) {
  const std::vector<Triangle> across = VerticesAcross(t);
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    if (IsPlain(t, e)) {
      midpoints[e] = PredictPlain(t, across, positions, e);
      continue;
    }
    Vec3f sum;
    VisitStencil(t, table, e, [&](uint32_t v, float weight) { sum += positions[v] * weight; });
    midpoints[e] = sum;
  }
}

std::vector<Vec3f> PredictMidpoints(const Topology& topology, const StencilTable& table, const std::vector<Vec3f>& positions) {
  std::vector<Vec3f> midpoints(topology.num_edges());
  PredictMidpoints(topology, table, positions.data(), midpoints.data());
  return midpoints;
}

}  // namespace lacerta
