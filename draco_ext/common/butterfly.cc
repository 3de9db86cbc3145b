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

std::vector<Vec3f> PredictMidpoints(const Topology& topology, const StencilTable& table, const std::vector<Vec3f>& positions) {
  std::vector<Vec3f> midpoints(topology.num_edges());
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    Vec3f sum;
    VisitStencil(topology, table, e, [&](uint32_t v, float weight) { sum += positions[v] * weight; });
    midpoints[e] = sum;
  }
  return midpoints;
}

}  // namespace lacerta
