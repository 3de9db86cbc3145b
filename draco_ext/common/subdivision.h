// Connectivity of a triangle mesh and of its 1-to-4 subdivisions, as integer tables.
//
// Both sides of the codec number vertices, edges and faces the same way (docs/format.md, "Subdivision"):
//   level 0     edges in order of first appearance over faces, then corners; edge k of a face lies opposite its corner k
//   refinement  vertices: the old ones, then the midpoint of edge e as V + e
//               edges:    the halves of e at its first and second end as 2e, 2e + 1; then the inner edge of face f that cuts
//                         off corner k as 2E + 3f + k
//               faces:    the corner faces of f as 4f + k (first vertex: corner k), the middle face as 4f + 3
#ifndef LACERTA_COMMON_SUBDIVISION_H_
#define LACERTA_COMMON_SUBDIVISION_H_

#include <array>
#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

inline constexpr uint32_t kNone = 0xffffffffu;

// How curves (border edges and creases) meet at a vertex.
enum class CurveRole : uint8_t {
  kSmooth,  // no curve
  kCurve,   // two curve edges, which continue each other
  kCorner,  // one, three or more curve edges, or two that do not continue each other
};

// Tables of one level. An orientable edge-manifold mesh, with or without border.
struct Topology {
  uint32_t num_vertices = 0;
  std::vector<Triangle> triangles;                     // #F x 3 vertices
  std::vector<std::array<uint32_t, 2>> edges;          // #E x 2 vertices
  std::vector<std::array<uint32_t, 3>> face_edges;     // #F x 3 edges; edge k is opposite corner k
  std::vector<std::array<uint32_t, 2>> edge_faces;     // #E x 2 faces; the second is kNone on the border
  std::vector<uint16_t> valence;                       // #V incident edges
  std::vector<uint8_t> on_curve;                       // #E, 1 for border edges and creases
  std::vector<CurveRole> role;                         // #V
  // #E, or empty where no borders are joined: the edge whose midpoint this one shares, or kNone. A master has no master.
  std::vector<uint32_t> master;

  uint32_t num_faces() const { return static_cast<uint32_t>(triangles.size()); }
  uint32_t num_edges() const { return static_cast<uint32_t>(edges.size()); }
  bool is_border(uint32_t edge) const { return edge_faces[edge][1] == kNone; }
  // Whether the midpoint of an edge is that of another edge, and so has no coefficients.
  bool is_copy(uint32_t edge) const { return !master.empty() && master[edge] != kNone; }
};

// Tables of a base mesh: of the triangles that are split, with its curves. Vertices of no such triangle are isolated. Fails with
// kInvalidData where an index is out of range, a triangle to be split is degenerate, an edge has more than two faces or two faces that
// disagree in orientation, a vertex has more than one fan of faces or more than 65,535 edges, or the tags do not have the
// shapes that BaseTags tells.
StatusOr<Topology> BuildTopology(uint32_t num_vertices, const std::vector<Triangle>& triangles, const BaseTags& tags = {});

// Gives the topology of a base mesh the creases, corners and joined borders of `tags`, whose still triangles it was built
// with, in place of those that it has. Fails as BuildTopology does.
Status SetTags(const BaseTags& tags, Topology* topology);

// Tables of the next finer level. Counts must fit: 4 #F < 2^32 (SubdividedCounts checks it for decoders).
Topology Refine(const Topology& coarse);
// The triangles of that level alone: 4 #F.
std::vector<Triangle> RefineTriangles(const Topology& coarse);
// The triangles of the level after that: 16 #F.
std::vector<Triangle> RefineTrianglesTwice(const Topology& coarse);
// The vertices with their roles and the triangles of that level: of a finest level, whose edges, the largest tables of all, nobody asks for.
Topology RefineWithoutEdges(const Topology& coarse);

// Numbers of vertices, edges and faces after `levels` >= 0 refinements, in 64 bits. Growth stops once there are 2^58 faces
// or more, so that no number of levels in a damaged header overflows into a small count. base: each below 2^33.
struct LevelCounts {
  uint64_t vertices = 0, edges = 0, faces = 0;
};
LevelCounts SubdividedCounts(LevelCounts base, int levels);

// Index (0..2) of `edge` within face_edges[face]; the edge must belong to the face.
inline int EdgeCorner(const Topology& t, uint32_t face, uint32_t edge) {
  const auto& fe = t.face_edges[face];
  return fe[0] == edge ? 0 : fe[1] == edge ? 1 : 2;
}

// The face across `edge` from `face`, or kNone.
inline uint32_t FaceAcross(const Topology& t, uint32_t face, uint32_t edge) {
  const auto& ef = t.edge_faces[edge];
  return ef[0] == face ? ef[1] : ef[0];
}

// The half of `edge` at its end `vertex`, as the next finer level numbers it.
inline uint32_t HalfAt(const Topology& t, uint32_t edge, uint32_t vertex) { return 2 * edge + (t.edges[edge][0] == vertex ? 0u : 1u); }

// The vertex of `face` opposite to `edge`.
inline uint32_t OppositeVertex(const Topology& t, uint32_t face, uint32_t edge) {
  return t.triangles[face][EdgeCorner(t, face, edge)];
}

// Of every edge both vertices opposite to it, by exclusive or, so that one of them gives the other: #E. Of a border edge, the one.
std::vector<uint32_t> OppositePairs(const Topology& topology);

}  // namespace lacerta

#endif  // LACERTA_COMMON_SUBDIVISION_H_
