// Where a surface looks at its vertices.
#ifndef LACERTA_GEOMETRY_VERTEX_AREA_VECTORS_H_
#define LACERTA_GEOMETRY_VERTEX_AREA_VECTORS_H_

#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// #V: of each vertex the sum over its triangles of their normals, each as long as twice the area. Zero where there is no area.
std::vector<Vec3d> VertexAreaVectors(const TriangleMesh& mesh);

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_VERTEX_AREA_VECTORS_H_
