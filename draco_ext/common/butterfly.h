// Butterfly prediction of edge midpoints with Zorin's stencils at extraordinary vertices
// [Dyn, Levin, Gregory 1990], [Zorin, Schroeder, Sweldens 1996].
//
// Departures, so that the stencil exists for every edge of a mesh with curves, which are border edges and creases:
//   curve edge            the 4-point rule (-1/16, 9/16, 9/16, -1/16) along the curve alone; 3/8, 3/4, -1/8 where the first end is a
//                         corner, 1/2, 1/2 where both are
//   an end on a curve     the regular 8-point rule, where a face beyond a curve is replaced by the reflection of its triangle
//   valence 2             3/4, 3/8, -1/8: Zorin's rule for valence 4 with each of its two spokes of no weight left out
//   a copy                what its master has
//   valence over 256      counts as regular, so that the work per edge is bounded on hostile connectivity
#ifndef LACERTA_COMMON_BUTTERFLY_H_
#define LACERTA_COMMON_BUTTERFLY_H_

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"

namespace lacerta {

// Vertices of more edges get the regular stencil (part of the format).
inline constexpr int kMaxStencilValence = 256;

// Weights of the ring of an extraordinary vertex of valence K >= 2; entry j belongs to the j-th neighbor counted from the
// other end of the edge. They sum to 1/4; the vertex itself has weight 3/4.
std::vector<float> ExtraordinaryStencil(int valence);

// Whether edges at an interior vertex are predicted by its extraordinary stencil.
inline bool IsExtraordinary(const Topology& t, uint32_t vertex) {
  return t.valence[vertex] != 6 && t.valence[vertex] <= kMaxStencilValence;
}

// Extraordinary stencils of the valences of one mesh, made once.
class StencilTable {
 public:
  explicit StencilTable(const Topology& topology);
  const std::vector<float>& ForValence(int valence) const { return weights_[valence]; }

 private:
  std::vector<std::vector<float>> weights_;  // by valence; empty where no vertex has it
};

// Calls visit(vertex, weight) for each vertex of the stencil of `edge`; the weights sum to one and a vertex may be visited twice.
template <typename Visitor>
void VisitStencil(const Topology& t, const StencilTable& table, uint32_t edge, const Visitor& visit);

// Predicted position of the midpoint of every edge: #E.
std::vector<Vec3f> PredictMidpoints(const Topology& topology, const StencilTable& table, const std::vector<Vec3f>& positions);
// The same, bit by bit, appended to the #V positions: #V + #E.
void PredictMidpoints(const Topology& topology, const StencilTable& table, std::vector<Vec3f>* positions);

// --- implementation of the template ---

namespace butterfly_internal {

// The other curve edge at `vertex`, where `edge` is one and the vertex has the role kCurve.
uint32_t NextCurveEdge(const Topology& t, uint32_t edge, uint32_t vertex);

template <typename Visitor>
void VisitRegular(const Topology& t, uint32_t edge, float scale, const Visitor& visit) {
  const auto& [a0, a1] = t.edges[edge];
  visit(a0, 0.5f * scale);
  visit(a1, 0.5f * scale);
  for (const uint32_t face : t.edge_faces[edge]) {
    const int corner = EdgeCorner(t, face, edge);
    const uint32_t b = t.triangles[face][corner];
    visit(b, 0.125f * scale);
    for (const int step : {1, 2}) {
      const uint32_t wing = t.face_edges[face][(corner + step) % 3];
      if (!t.on_curve[wing]) {
        visit(OppositeVertex(t, FaceAcross(t, face, wing), wing), -0.0625f * scale);
      } else {  // reflect the third vertex of `face` across the curve
        const uint32_t far = t.triangles[face][(corner + step) % 3];
        const uint32_t near = far == a0 ? a1 : a0;
        visit(near, -0.0625f * scale);
        visit(b, -0.0625f * scale);
        visit(far, 0.0625f * scale);
      }
    }
  }
}

template <typename Visitor>
void VisitExtraordinary(const Topology& t, const StencilTable& table, uint32_t edge, uint32_t vertex, float scale, const Visitor& visit) {
  const std::vector<float>& weights = table.ForValence(t.valence[vertex]);
  visit(vertex, 0.75f * scale);
  uint32_t spoke = edge;
  uint32_t face = t.edge_faces[edge][0];
  for (const float weight : weights) {
    const auto& ends = t.edges[spoke];
    visit(ends[0] == vertex ? ends[1] : ends[0], weight * scale);
    // The next spoke: the other edge of `face` at `vertex`.
    const auto& tri = t.triangles[face];
    const int corner = tri[0] == vertex ? 0 : tri[1] == vertex ? 1 : 2;
    const uint32_t e1 = t.face_edges[face][(corner + 1) % 3], e2 = t.face_edges[face][(corner + 2) % 3];
    spoke = e1 == spoke ? e2 : e1;
    face = FaceAcross(t, face, spoke);
  }
}

template <typename Visitor>
void VisitCurve(const Topology& t, uint32_t edge, const Visitor& visit) {
  const auto far_end = [&](uint32_t vertex) {
    const auto& ends = t.edges[NextCurveEdge(t, edge, vertex)];
    return ends[0] == vertex ? ends[1] : ends[0];
  };
  const auto& [a, b] = t.edges[edge];
  const bool a_continues = t.role[a] == CurveRole::kCurve, b_continues = t.role[b] == CurveRole::kCurve;
  if (a_continues && b_continues) {
    visit(a, 0.5625f);
    visit(far_end(a), -0.0625f);
    visit(b, 0.5625f);
    visit(far_end(b), -0.0625f);
  } else if (a_continues || b_continues) {
    const uint32_t corner = a_continues ? b : a, other = a_continues ? a : b;
    visit(corner, 0.375f);
    visit(other, 0.75f);
    visit(far_end(other), -0.125f);
  } else {
    visit(a, 0.5f);
    visit(b, 0.5f);
  }
}

}  // namespace butterfly_internal

template <typename Visitor>
void VisitStencil(const Topology& t, const StencilTable& table, uint32_t edge, const Visitor& visit) {
  using namespace butterfly_internal;
  if (t.is_copy(edge)) edge = t.master[edge];
  if (t.on_curve[edge]) return VisitCurve(t, edge, visit);
  const auto& [a, b] = t.edges[edge];
  if (t.role[a] != CurveRole::kSmooth || t.role[b] != CurveRole::kSmooth) return VisitRegular(t, edge, 1.0f, visit);
  const bool a_extraordinary = IsExtraordinary(t, a), b_extraordinary = IsExtraordinary(t, b);
  if (!a_extraordinary && !b_extraordinary) return VisitRegular(t, edge, 1.0f, visit);
  const float scale = a_extraordinary && b_extraordinary ? 0.5f : 1.0f;
  if (a_extraordinary) VisitExtraordinary(t, table, edge, a, scale, visit);
  if (b_extraordinary) VisitExtraordinary(t, table, edge, b, scale, visit);
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_BUTTERFLY_H_
