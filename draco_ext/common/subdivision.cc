#include "common/subdivision.h"

namespace lacerta {
namespace {

// The four triangles that one is split into; the midpoint of edge e is the vertex num_vertices + e.
void Split(const Triangle& tri, const std::array<uint32_t, 3>& edges, uint32_t num_vertices, Triangle* split) {
  const Triangle mid = {num_vertices + edges[0], num_vertices + edges[1], num_vertices + edges[2]};
  for (size_t k = 0; k < 3; ++k) split[k] = {tri[k], mid[(k + 2) % 3], mid[(k + 1) % 3]};
  split[3] = mid;
}

}  // namespace

Topology Refine(const Topology& c) {
  const uint32_t V = c.num_vertices, E = c.num_edges(), F = c.num_faces();
  Topology t;
  t.num_vertices = V + E;
  t.triangles = RefineTriangles(c);
  t.face_edges.resize(size_t{4} * F);
  t.edges.resize(size_t{2} * E + size_t{3} * F);
  t.edge_faces.resize(t.edges.size());
  t.valence = c.valence;
  t.valence.resize(t.num_vertices);
  t.on_curve.assign(t.edges.size(), 0);
  t.role = c.role;
  t.role.resize(t.num_vertices);
  if (!c.master.empty()) t.master.assign(t.edges.size(), kNone);
  for (uint32_t e = 0; e < E; ++e) {
    t.valence[V + e] = c.is_border(e) ? 4 : 6;
    t.role[V + e] = c.on_curve[e] ? CurveRole::kCurve : CurveRole::kSmooth;
    for (uint32_t end = 0; end < 2; ++end) {
      t.on_curve[2 * e + end] = c.on_curve[e];
      if (c.is_copy(e)) t.master[2 * e + end] = 2 * c.master[e] + end;
      t.edges[2 * e + end] = {c.edges[e][end], V + e};
      for (int side = 0; side < 2; ++side) {
        const uint32_t f = c.edge_faces[e][side];
        if (f == kNone) {
          t.edge_faces[2 * e + end][side] = kNone;
          continue;
        }
        const uint32_t v = c.edges[e][end];
        const uint32_t corner = c.triangles[f][0] == v ? 0 : c.triangles[f][1] == v ? 1 : 2;
        t.edge_faces[2 * e + end][side] = 4 * f + corner;
      }
    }
  }
  for (uint32_t f = 0; f < F; ++f) {
    const Triangle& tri = c.triangles[f];
    const auto& fe = c.face_edges[f];
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      const uint32_t inner = 2 * E + 3 * f + k;
      t.face_edges[4 * f + k] = {inner, HalfAt(c, fe[k1], tri[k]), HalfAt(c, fe[k2], tri[k])};
      t.edges[inner] = {V + fe[k2], V + fe[k1]};
      t.edge_faces[inner] = {4 * f + k, 4 * f + 3};
      t.face_edges[4 * f + 3][k] = inner;
    }
  }
  return t;
}

std::vector<Triangle> RefineTriangles(const Topology& c) {
  std::vector<Triangle> triangles(size_t{4} * c.num_faces());
  for (uint32_t f = 0; f < c.num_faces(); ++f) Split(c.triangles[f], c.face_edges[f], c.num_vertices, &triangles[size_t{4} * f]);
  return triangles;
}

std::vector<Triangle> RefineTrianglesTwice(const Topology& c) {
  const uint32_t V = c.num_vertices, E = c.num_edges();
  std::vector<Triangle> triangles(size_t{16} * c.num_faces());
  for (uint32_t f = 0; f < c.num_faces(); ++f) {
    const Triangle& tri = c.triangles[f];
    const auto& fe = c.face_edges[f];
    const Triangle mid = {V + fe[0], V + fe[1], V + fe[2]};
    const uint32_t inner = 2 * E + 3 * f;
    Triangle* split = &triangles[size_t{16} * f];
    for (uint32_t k = 0; k < 3; ++k, split += 4) {
      const uint32_t k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      Split({tri[k], mid[k2], mid[k1]}, {inner + k, HalfAt(c, fe[k1], tri[k]), HalfAt(c, fe[k2], tri[k])}, V + E, split);
    }
    Split(mid, {inner, inner + 1, inner + 2}, V + E, split);
  }
  return triangles;
}

Topology RefineWithoutEdges(const Topology& c) {
  Topology t;
  t.num_vertices = c.num_vertices + c.num_edges();
  t.triangles = RefineTriangles(c);
  t.role = c.role;
  t.role.resize(t.num_vertices, CurveRole::kSmooth);
  for (uint32_t e = 0; e < c.num_edges(); ++e) {
    if (c.on_curve[e]) t.role[c.num_vertices + e] = CurveRole::kCurve;
  }
  return t;
}

std::vector<uint32_t> OppositePairs(const Topology& t) {
  std::vector<uint32_t> pairs(t.num_edges());
  for (uint32_t f = 0; f < t.num_faces(); ++f) {
    for (size_t k = 0; k < 3; ++k) pairs[t.face_edges[f][k]] ^= t.triangles[f][k];
  }
  return pairs;
}

LevelCounts SubdividedCounts(LevelCounts counts, int levels) {
  constexpr uint64_t kMaxFaces = uint64_t{1} << 58;
  for (int level = 0; level < levels && counts.faces > 0 && counts.faces < kMaxFaces; ++level) {
    counts = {counts.vertices + counts.edges, 2 * counts.edges + 3 * counts.faces, 4 * counts.faces};
  }
  return counts;
}

}  // namespace lacerta
