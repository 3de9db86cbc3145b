// Who is next to whom in any triangles, for solvers over vertex positions.
#ifndef LACERTA_REMESH_MESH_NEIGHBORS_H_
#define LACERTA_REMESH_MESH_NEIGHBORS_H_

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/by_vertex.h"
#include "lacerta/mesh.h"

namespace lacerta {

struct MeshNeighbors {
  // mesh: no triangle with a repeated vertex; else anything.
  explicit MeshNeighbors(const TriangleMesh& mesh);

  std::vector<std::array<uint32_t, 2>> edges;       // #E, smaller vertex first
  std::vector<std::array<uint32_t, 3>> face_edges;  // #F; edge k is across corner k
  // The edges of exactly two triangles: both ends, then both corners across. The parallelogram rule predicts one across from the
  // other three.
  std::vector<std::array<uint32_t, 4>> flaps;
  ByVertex vertex_faces, vertex_edges, vertex_flaps;
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_MESH_NEIGHBORS_H_
