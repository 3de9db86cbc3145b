// Raw scans have stray triangles and folds at which more than two faces share an edge. There the surface is cut (remesh/manifold.h), and what
// remains of a handful of triangles is a hole of no width or one that something else lies in. Every hole has vertices of the base mesh and
// corners to itself, so hundreds of them cost more than all else. Here they are closed.
#ifndef LACERTA_REMESH_MEND_TEARS_H_
#define LACERTA_REMESH_MEND_TEARS_H_

#include <cstdint>
#include <optional>

#include "lacerta/mesh.h"

namespace lacerta {

struct MendOptions {
  uint32_t fewest_faces = 500;      // of a component whose tears are mended
  uint32_t most_border_edges = 40;  // of a hole that is filled
  uint32_t most_stray_faces = 12;   // of a component that may be left out
  double share = 0.03;              // of the squared distance, that all of it may add to that of the surface
};

struct MendedMesh {
  TriangleMesh mesh;
  uint64_t closed_tears = 0, stray_components = 0;  // left out
};

// The mesh with closed tears, or none where there is nothing to mend. A tear is a border of a component that cuts have opened, in part at least.
//   Zipped: neighboring border edges that lie on each other become one.
//   Filled: what then remains, with triangles between its vertices, which are nowhere farther than twice `distance` from the mesh.
//   Left out: handfuls of triangles that cuts have torn off, those first that matter least.
// There is a vertex for every fan of faces that the cuts leave (ManifoldMesh), but on borders that stay open one for all of a point. Vertices at
// one point are moved apart, by a tenth of `distance` at most; no other vertex moves.
//   cleaned   what Clean returned
//   distance  that the surface may be off, d_S in model units
std::optional<MendedMesh> MendTears(const TriangleMesh& cleaned, double distance, const MendOptions& options = {});

}  // namespace lacerta

#endif  // LACERTA_REMESH_MEND_TEARS_H_
