// Any triangles as an oriented manifold with border, without moving or dropping anything.
//
// Faces are neighbors where they continue each other across an edge; everything else is cut, and vertices become one
// copy for every fan of neighbors [Gueziec, Taubin, Lazarus, Horn 2001, "Cutting and Stitching"]. Copies have equal
// positions, so the surface stays watertight in place, and BaseTags::joined can tie the borders together again.
#ifndef LACERTA_REMESH_MANIFOLD_H_
#define LACERTA_REMESH_MANIFOLD_H_

#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

struct ManifoldReport {
  uint64_t flipped_triangles = 0;  // turned over to agree with their neighbors
  uint64_t cut_edges = 0;          // edges of the input that are several edges now
  uint64_t split_vertices = 0;     // vertices of the input that are several vertices now
  uint64_t components = 0;         // parts connected over edges
  uint64_t borders = 0;            // closed polygons of border edges
};

// Of one component, a surface with border: its genus is (2 - euler - borders) / 2.
struct ComponentTopology {
  uint32_t faces = 0, vertices = 0;
  uint32_t borders = 0;  // closed polygons of border edges
  int64_t euler = 0;     // vertices - edges + faces
};

struct ManifoldMesh {
  TriangleMesh mesh;                          // BuildTopology accepts it. Triangles in the order of the input
  std::vector<uint32_t> source_vertex;        // #V, the vertex of the input: itself for those, then of the added copies
  std::vector<uint32_t> component;            // #F, numbered in order of their first faces
  std::vector<ComponentTopology> components;  // #C
  ManifoldReport report;
};

enum class Orientation {
  kMadeToAgree,  // triangles that disagree with their neighbors are turned over
  kKept,         // no triangle is turned over; those that disagree are no neighbors
};

// cleaned: what Clean returns (no repeated vertex in a triangle, indices in range); double sheets may be in it.
//   Orientation: faces are turned to agree with their neighbors so that the lesser area of a component is turned. First
//     those neighbors are joined that agree already, so where no orientation suits all (Moebius band), the edges that
//     are cut are ones that disagreed in the input.
//   More than two faces at an edge: PairAroundEdge (remesh/edge_pairing.h); faces that find no partner get a border. Where three
//     or more of large sheets meet and one is left alone, all get one, so that the borders are one curve and no sheet moves away from the others.
//   The two sides of a double sheet are never neighbors, so its rim is cut.
//   Vertices of more than 65,534 faces, which no Topology holds, are cut into parts.
// Which faces are neighbors does not depend on anything but the mesh. O(n log n).
ManifoldMesh MakeManifold(const TriangleMesh& cleaned, Orientation orientation = Orientation::kMadeToAgree);

}  // namespace lacerta

#endif  // LACERTA_REMESH_MANIFOLD_H_
