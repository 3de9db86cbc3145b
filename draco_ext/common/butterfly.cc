#include "common/butterfly.h"

#include "common/fast_point.h"

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

// Of every vertex, whether an edge between two such vertices needs no case of its own: no curve, and no extraordinary vertex. #V.
std::vector<uint8_t> PlainVertices(const Topology& t) {
  std::vector<uint8_t> is_plain(t.num_vertices);
  for (uint32_t v = 0; v < t.num_vertices; ++v) is_plain[v] = t.role[v] == CurveRole::kSmooth && !IsExtraordinary(t, v);
  return is_plain;
}

// What VisitRegular adds up at an edge between two plain vertices, in the same order: nearly all edges of fine levels are.
template <typename Point>
Vec3f PredictPlain(const Topology& t, const std::vector<uint32_t>& opposite_pairs, const Vec3f* positions, uint32_t edge) {
  constexpr int kNext[3] = {1, 2, 0}, kPrevious[3] = {2, 0, 1};
  const auto& [a, b] = t.edges[edge];
  Point sum{};
  const auto add = [&](uint32_t v, float weight) { sum += LoadPoint<Point>(positions + v) * weight; };
  add(a, 0.5f);
  add(b, 0.5f);
  for (const uint32_t face : t.edge_faces[edge]) {
    const auto& sides = t.face_edges[face];
    const Triangle& corners = t.triangles[face];
    const int corner = EdgeCorner(t, face, edge), next = kNext[corner], previous = kPrevious[corner];
    add(corners[corner], 0.125f);
    add(opposite_pairs[sides[next]] ^ corners[next], -0.0625f);
    add(opposite_pairs[sides[previous]] ^ corners[previous], -0.0625f);
  }
  return ToVec3f(sum);
}

template <typename Point>
void Predict(const Topology& t, const StencilTable& table, const Vec3f* positions, Vec3f* midpoints) {
  const std::vector<uint8_t> is_plain = PlainVertices(t);
  const std::vector<uint32_t> opposite_pairs = OppositePairs(t);
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    const auto& [a, b] = t.edges[e];
    if (is_plain[a] != 0 && is_plain[b] != 0) {
      midpoints[e] = PredictPlain<Point>(t, opposite_pairs, positions, e);
      continue;
    }
    Vec3f sum;
    VisitStencil(t, table, e, [&](uint32_t v, float weight) { sum += positions[v] * weight; });
    midpoints[e] = sum;
  }
}

}  // namespace

void PredictMidpoints(const Topology& t, const StencilTable& table, std::vector<Vec3f>* positions) {
  positions->resize(size_t{t.num_vertices} + t.num_edges());
  Predict<FastPoint>(t, table, positions->data(), positions->data() + t.num_vertices);
}

std::vector<Vec3f> PredictMidpoints(const Topology& topology, const StencilTable& table, const std::vector<Vec3f>& positions) {
  std::vector<Vec3f> midpoints(topology.num_edges());
  Predict<Vec3f>(topology, table, positions.data(), midpoints.data());
  return midpoints;
}

}  // namespace lacerta
