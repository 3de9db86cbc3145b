// Tables of a base mesh, which is checked; subdivision.cc makes those of finer levels, which is where the time goes.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "common/keyed_sort.h"
#include "common/subdivision.h"

namespace lacerta {
namespace {

// For every corner 3f + k the first corner that lies opposite the same vertex pair. Sorting the pairs of each lower vertex
// bounds the work on any input, a fan of a million faces around one vertex included.
std::vector<uint32_t> FirstCornerOfEdge(const std::vector<Triangle>& triangles, uint32_t num_vertices) {
  const auto num_corners = static_cast<uint32_t>(3 * triangles.size());
  // Calls visit(corner, lower vertex, higher vertex) for all of them.
  const auto for_each_pair = [&](const auto& visit) {
    uint32_t corner = 0;
    for (const Triangle& tri : triangles) {
      for (const auto& [a, b] : {std::pair(tri[1], tri[2]), std::pair(tri[2], tri[0]), std::pair(tri[0], tri[1])}) {
        visit(corner++, std::min(a, b), std::max(a, b));
      }
    }
  };
  std::vector<uint32_t> end(num_vertices, 0);  // of the pairs of a lower vertex; first their number, then their beginning
  for_each_pair([&](uint32_t, uint32_t lower, uint32_t) { ++end[lower]; });
  for (uint32_t v = 0, begin = 0; v < num_vertices; ++v) begin += std::exchange(end[v], begin);
  std::vector<KeyedIndex> keyed(num_corners);  // the higher vertex, the corner
  for_each_pair([&](uint32_t corner, uint32_t lower, uint32_t higher) { keyed[end[lower]++] = {higher, corner}; });
  std::vector<uint32_t> first(num_corners);
  for (uint32_t v = 0, begin = 0; v < num_vertices; begin = end[v++]) FindFirstEqual(&keyed, begin, end[v], &first);
  return first;
}

Status NotTwoManifold(const char* what, uint32_t a, uint32_t b) {
  return InvalidData(std::string(what) + " at edge (" + std::to_string(a) + ", " + std::to_string(b) + ")");
}

// Every vertex must have exactly one fan: the number of its faces, walked from any of them, is all of them.
Status CheckVertexFans(const Topology& t) {
  std::vector<uint32_t> num_faces(t.num_vertices, 0), one_face(t.num_vertices, kNone);
  for (uint32_t f = 0; f < t.num_faces(); ++f) {
    for (const uint32_t v : t.triangles[f]) {
      ++num_faces[v];
      one_face[v] = f;
    }
  }
  for (uint32_t v = 0; v < t.num_vertices; ++v) {
    if (one_face[v] == kNone) continue;
    uint32_t count = 0;
    bool closed = false;
    // Both ways round from the first face, unless the first way closes the ring.
    for (const auto& side : {std::array<uint8_t, 3>{1, 2, 0}, std::array<uint8_t, 3>{2, 0, 1}}) {
      uint32_t face = one_face[v];
      while (!closed) {
        count += side[0] == 1 || face != one_face[v];
        const int corner = t.triangles[face][0] == v ? 0 : t.triangles[face][1] == v ? 1 : 2;
        const uint32_t next = FaceAcross(t, face, t.face_edges[face][side[corner]]);
        if (next == kNone) break;
        if (next == one_face[v]) closed = true;
        face = next;
      }
    }
    if (count != num_faces[v]) return InvalidData("vertex " + std::to_string(v) + " joins several fans of faces");
  }
  return Status();
}

StatusOr<std::vector<Triangle>> SplitTriangles(const std::vector<Triangle>& all, const std::vector<uint8_t>& still, uint32_t num_vertices) {
  for (size_t f = 0; f < all.size(); ++f) {
    for (const uint32_t v : all[f]) {
      if (v < num_vertices) continue;
      return InvalidData("triangle " + std::to_string(f) + " refers to vertex " + std::to_string(v) + " of " + std::to_string(num_vertices));
    }
  }
  if (still.empty()) return all;
  if (still.size() != all.size()) return InvalidData("the tags of still triangles are not as many as the triangles");
  std::vector<Triangle> split;
  for (size_t f = 0; f < all.size(); ++f) {
    if (still[f] == 0) split.push_back(all[f]);
  }
  return split;
}

// Sets on_curve and role from the border and the tags.
Status SetCurves(const BaseTags& tags, Topology* t) {
  if (!tags.crease.empty() && tags.crease.size() != t->num_edges()) {
    return InvalidData("the tags of creases are not as many as the edges");
  }
  if (!tags.corner.empty() && tags.corner.size() != t->num_vertices) {
    return InvalidData("the tags of corners are not as many as the vertices");
  }
  t->on_curve.assign(t->num_edges(), 0);
  std::vector<uint32_t> num_curve_edges(t->num_vertices, 0);
  for (uint32_t e = 0; e < t->num_edges(); ++e) {
    t->on_curve[e] = t->is_border(e) || (!tags.crease.empty() && tags.crease[e] != 0);
    for (const uint32_t v : t->edges[e]) num_curve_edges[v] += t->on_curve[e];
  }
  t->role.resize(t->num_vertices);
  for (uint32_t v = 0; v < t->num_vertices; ++v) {
    const bool bends = !tags.corner.empty() && tags.corner[v] != 0;
    t->role[v] = num_curve_edges[v] == 0                ? CurveRole::kSmooth
                 : num_curve_edges[v] == 2 && !bends ? CurveRole::kCurve
                                                        : CurveRole::kCorner;
  }
  return Status();
}

// Sets the masters of border edges that join the same two positions.
Status JoinBorders(const std::vector<uint32_t>& joined, Topology* t) {
  t->master.clear();
  if (joined.empty()) return Status();
  if (joined.size() != t->num_vertices) return InvalidData("the joined vertices are not as many as the vertices");
  std::vector<KeyedIndex> keyed;
  for (uint32_t e = 0; e < t->num_edges(); ++e) {
    if (!t->is_border(e)) continue;
    const uint64_t a = joined[t->edges[e][0]], b = joined[t->edges[e][1]];
    if (a != b) keyed.push_back({std::min(a, b) << 32 | std::max(a, b), e});
  }
  SortKeyed(&keyed, 0, keyed.size());
  t->master.assign(t->num_edges(), kNone);
  uint32_t first = 0;
  for (size_t i = 0; i < keyed.size(); ++i) {
    if (i > 0 && keyed[i - 1].key == keyed[i].key) {
      t->master[keyed[i].index] = first;
    } else {
      first = keyed[i].index;
    }
  }
  // A copy runs as its master does, so that Refine gives both the same halves.
  for (const auto& [key, e] : keyed) {
    const uint32_t m = t->master[e];
    if (m != kNone && joined[t->edges[e][0]] != joined[t->edges[m][0]]) std::swap(t->edges[e][0], t->edges[e][1]);
  }
  return Status();
}

}  // namespace

StatusOr<Topology> BuildTopology(uint32_t num_vertices, const std::vector<Triangle>& all_triangles, const BaseTags& tags) {
  Topology t;
  t.num_vertices = num_vertices;
  LACERTA_ASSIGN_OR_RETURN(t.triangles, SplitTriangles(all_triangles, tags.still, num_vertices));
  const std::vector<Triangle>& triangles = t.triangles;
  t.face_edges.resize(triangles.size());
  for (uint32_t f = 0; f < t.num_faces(); ++f) {
    const Triangle& tri = triangles[f];
    if (tri[0] == tri[1] || tri[1] == tri[2] || tri[2] == tri[0]) {
      return InvalidData("triangle " + std::to_string(f) + " is degenerate");
    }
  }
  t.edges.reserve(triangles.size() * 3 / 2 + 3);
  t.edge_faces.reserve(triangles.size() * 3 / 2 + 3);
  const std::vector<uint32_t> first_corner = FirstCornerOfEdge(triangles, num_vertices);
  for (uint32_t corner = 0, f = 0; f < t.num_faces(); ++f) {
    for (uint32_t k = 0; k < 3; ++k, ++corner) {
      const uint32_t first = first_corner[corner];
      const uint32_t a = triangles[f][k == 2 ? 0 : k + 1], b = triangles[f][k == 0 ? 2 : k - 1];
      if (first == corner) {
        t.face_edges[f][k] = t.num_edges();
        t.edges.push_back({a, b});
        t.edge_faces.push_back({f, kNone});
        continue;
      }
      const uint32_t e = t.face_edges[first / 3][first % 3];
      if (t.edge_faces[e][1] != kNone) return NotTwoManifold("more than two faces meet", a, b);
      if (t.edges[e][0] == a) return NotTwoManifold("two faces of opposite orientation meet", a, b);
      t.edge_faces[e][1] = f;
      t.face_edges[f][k] = e;
    }
  }
  t.valence.assign(num_vertices, 0);
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    for (const uint32_t v : t.edges[e]) {
      if (t.valence[v] == 0xffff) return InvalidData("vertex " + std::to_string(v) + " has more than 65,535 edges");
      ++t.valence[v];
    }
  }
  LACERTA_RETURN_IF_ERROR(CheckVertexFans(t));
  LACERTA_RETURN_IF_ERROR(SetTags(tags, &t));
  return t;
}

Status SetTags(const BaseTags& tags, Topology* topology) {
  LACERTA_RETURN_IF_ERROR(SetCurves(tags, topology));
  return JoinBorders(tags.joined, topology);
}

}  // namespace lacerta
