// How many pieces a mesh is of.
#ifndef LACERTA_REMESH_COMPONENTS_H_
#define LACERTA_REMESH_COMPONENTS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// Sets of triangles that hang together by vertices. mesh: indices in range. Almost linear time.
size_t CountComponents(const TriangleMesh& mesh);

// For each triangle which of those sets it is in; they are numbered in the order of their first triangles.
std::vector<uint32_t> FindComponents(const TriangleMesh& mesh);

}  // namespace lacerta

#endif  // LACERTA_REMESH_COMPONENTS_H_
