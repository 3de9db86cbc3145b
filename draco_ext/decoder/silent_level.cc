#include "decoder/silent_level.h"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "common/fast_point.h"

namespace lacerta {
namespace {

// Of every half both edges next to it around its end, one in either face, by exclusive or, so that one of them gives the other: 2 #E.
std::vector<uint32_t> NextSpokes(const Topology& t) {
  std::vector<uint32_t> spokes(size_t{2} * t.num_edges());
  for (uint32_t f = 0; f < t.num_faces(); ++f) {
    const auto& sides = t.face_edges[f];
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = t.triangles[f][k], x = sides[(k + 1) % 3], y = sides[(k + 2) % 3];
      spokes[HalfAt(t, x, v)] ^= y;
      spokes[HalfAt(t, y, v)] ^= x;
    }
  }
  return spokes;
}

// Adds up the stencils of the finer edges, in the order of VisitStencil. Vertices of the finer level are those of t and the midpoints of its edges.
class RefinedStencils {
 public:
  RefinedStencils(const Topology& t, const StencilTable& table, const Vec3f* positions)
      : t_(t), table_(table), positions_(positions), next_spokes_(NextSpokes(t)) {}

  // Of the half of `edge` at its end v.
  Vec3f AtHalf(uint32_t edge, uint32_t v) const {
    if (t_.on_curve[edge] != 0) return OnCurve(edge, v);
    if (t_.role[v] == CurveRole::kSmooth && IsExtraordinary(t_, v)) return AroundExtraordinary(edge, v);
    FastPoint sum = FastPoint{} + At(v) * 0.5f + At(Midpoint(edge)) * 0.5f;
    for (const uint32_t face : t_.edge_faces[edge]) {
      const auto& sides = t_.face_edges[face];
      const size_t opposite = static_cast<size_t>(EdgeCorner(t_, face, edge)), next = kNext[opposite], previous = kPrevious[opposite];
      const bool is_next = t_.triangles[face][next] == v;
      const uint32_t spoke = sides[is_next ? previous : next], across = sides[is_next ? next : previous];
      sum += At(Midpoint(spoke)) * 0.125f;
      // The wings of the small face at v: beyond the half of `spoke`, which may be a curve that reflects the face, and across the inner edge.
      const bool reflects = t_.on_curve[spoke] != 0;
      const uint32_t inner = Midpoint(across);
      if (is_next) sum += At(inner) * -0.0625f;
      if (reflects) sum += At(v) * -0.0625f;
      sum += At(reflects ? Midpoint(spoke) : Beyond(spoke, v, edge)) * -0.0625f;
      if (reflects) sum += At(Midpoint(edge)) * 0.0625f;
      if (!is_next) sum += At(inner) * -0.0625f;
    }
    return ToVec3f(sum);
  }

  // Of the inner edge that cuts off corner k of a face.
  Vec3f AtInner(uint32_t face, size_t k) const {
    const auto& sides = t_.face_edges[face];
    const Triangle& corners = t_.triangles[face];
    const size_t next = kNext[k], previous = kPrevious[k];
    FastPoint sum = FastPoint{} + At(Midpoint(sides[previous])) * 0.5f + At(Midpoint(sides[next])) * 0.5f + At(corners[k]) * 0.125f;
    uint32_t spoke = sides[next], other = sides[previous];
    for (int wing = 0; wing < 2; ++wing) {
      const bool reflects = t_.on_curve[spoke] != 0;
      if (reflects) sum += At(Midpoint(spoke)) * -0.0625f;
      sum += At(reflects ? corners[k] : Beyond(spoke, corners[k], other)) * -0.0625f;
      if (reflects) sum += At(Midpoint(other)) * 0.0625f;
      std::swap(spoke, other);
    }
    sum += At(Midpoint(sides[k])) * 0.125f;
    sum += At(corners[next]) * -0.0625f;
    sum += At(corners[previous]) * -0.0625f;
    return ToVec3f(sum);
  }

 private:
  static constexpr size_t kNext[3] = {1, 2, 0}, kPrevious[3] = {2, 0, 1};

  FastPoint At(uint32_t vertex) const { return LoadPoint<FastPoint>(positions_ + vertex); }
  uint32_t Midpoint(uint32_t edge) const { return t_.num_vertices + edge; }
  // Across the half of `spoke` at v from the face that it shares with `edge`, which has the end v, too.
  uint32_t Beyond(uint32_t spoke, uint32_t v, uint32_t edge) const { return Midpoint(next_spokes_[HalfAt(t_, spoke, v)] ^ edge); }

  Vec3f OnCurve(uint32_t edge, uint32_t v) const {
    const uint32_t far = t_.edges[edge][0] ^ t_.edges[edge][1] ^ v;
    if (t_.role[v] != CurveRole::kCurve) return ToVec3f(FastPoint{} + At(v) * 0.375f + At(Midpoint(edge)) * 0.75f + At(far) * -0.125f);
    const uint32_t before = Midpoint(butterfly_internal::NextCurveEdge(t_, edge, v));
    return ToVec3f(FastPoint{} + At(v) * 0.5625f + At(before) * -0.0625f + At(Midpoint(edge)) * 0.5625f + At(far) * -0.0625f);
  }

  // VisitExtraordinary, with midpoints of spokes for their ends.
  Vec3f AroundExtraordinary(uint32_t edge, uint32_t v) const {
    FastPoint sum = FastPoint{} + At(v) * 0.75f;
    const Triangle& corners = t_.triangles[t_.edge_faces[edge][0]];
    const auto& sides = t_.face_edges[t_.edge_faces[edge][0]];
    uint32_t spoke = edge, next = kNone;
    for (size_t k = 0; k < 3; ++k) next = corners[k] == v ? sides[kNext[k]] ^ sides[kPrevious[k]] ^ edge : next;
    for (const float weight : table_.ForValence(t_.valence[v])) {
      sum += At(Midpoint(spoke)) * weight;
      const uint32_t after = next_spokes_[HalfAt(t_, next, v)] ^ spoke;
      spoke = next;
      next = after;
    }
    return ToVec3f(sum);
  }

  const Topology& t_;
  const StencilTable& table_;
  const Vec3f* const positions_;
  const std::vector<uint32_t> next_spokes_;
};

}  // namespace

void PredictRefinedMidpoints(const Topology& t, const StencilTable& table, std::vector<Vec3f>* positions) {
  const size_t first = positions->size();
  positions->resize(first + size_t{2} * t.num_edges() + size_t{3} * t.num_faces());
  const RefinedStencils stencils(t, table, positions->data());
  Vec3f* next = positions->data() + first;
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    for (const uint32_t v : t.edges[e]) *next++ = stencils.AtHalf(e, v);
  }
  for (uint32_t f = 0; f < t.num_faces(); ++f) {
    for (size_t k = 0; k < 3; ++k) *next++ = stencils.AtInner(f, k);
  }
}

}  // namespace lacerta
