// Recognition of meshes that are semi-regular already: undoes 1-to-4 subdivision by connectivity alone [Taubin 2002,
// "Detecting and reconstructing subdivision connectivity"]. Departs from the paper: the walk goes over faces, of which each
// fixes what its neighbors are, so no covering mesh is needed.
#ifndef LACERTA_REMESH_UNSUBDIVIDE_H_
#define LACERTA_REMESH_UNSUBDIVIDE_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "common/stream_layout.h"
#include "lacerta/mesh.h"

namespace lacerta {

// A mesh as a base mesh and the number of its 1-to-4 subdivisions.
struct Unsubdivided {
  std::vector<Triangle> base_triangles;  // #F0
  uint32_t num_base_vertices = 0;        // #V0
  int num_levels = 0;                    // >= 1
  std::vector<uint32_t> input_vertex;    // #V, by vertex of the SemiRegularMesh: the vertex of the input
};

// Undoes as many subdivisions as all components of `mesh` allow, `max_levels` at most; none where there is not one of them,
// or where `mesh` is no oriented manifold or has isolated vertices. The subdivided base has the very triangles of the input.
// Time O(n log n) in the size of the mesh, on any input.
std::optional<Unsubdivided> UndoSubdivision(const TriangleMesh& mesh, int max_levels = kMaxLevels);

// The same mesh over a renumbered base: vertex_map[v] is the present number of the base vertex that will be v, and
// `base_triangles` (in new numbers) are the same triangles in any order and rotation. The vertices of all levels follow.
Unsubdivided Reorder(const Unsubdivided& mesh, const std::vector<uint32_t>& vertex_map,
                     const std::vector<Triangle>& base_triangles);

}  // namespace lacerta

#endif  // LACERTA_REMESH_UNSUBDIVIDE_H_
