// A base mesh whose borders are closed by dummy vertices, as half-edges: what the coding of its connectivity walks over.
#ifndef LACERTA_ENCODER_CLOSED_MESH_H_
#define LACERTA_ENCODER_CLOSED_MESH_H_

#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// Half-edge 3t + k lies opposite corner k of triangle t and runs from its corner k + 1 to its corner k + 2 (mod 3).
struct ClosedMesh {
  uint32_t num_vertices = 0;        // without dummies
  uint32_t num_dummies = 0;         // numbered after the vertices, one for each border polygon
  uint32_t num_real_triangles = 0;  // come first, as in the base mesh
  std::vector<Triangle> triangles;  // with those that close the borders
  std::vector<uint32_t> twin;       // #T x 3, the half-edge on the other side
  std::vector<uint32_t> valence;    // #V with dummies
};

// t: of a mesh in which every vertex has a triangle.
ClosedMesh CloseBorders(const Topology& t);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_CLOSED_MESH_H_
