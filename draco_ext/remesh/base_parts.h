// Base meshes of surfaces that come in parts: those that stay as they are beside those that are refined, and sheets that were cut apart.
#ifndef LACERTA_REMESH_BASE_PARTS_H_
#define LACERTA_REMESH_BASE_PARTS_H_

#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// Both meshes in one without a common vertex: first the vertices and triangles of a.
TriangleMesh Together(TriangleMesh a, const TriangleMesh& b);

// For each of #V positions the first vertex that lies there, where a surface was cut; empty where no two lie together.
std::vector<uint32_t> JoinedVertices(const std::vector<Vec3f>& positions);

}  // namespace lacerta

#endif  // LACERTA_REMESH_BASE_PARTS_H_
