// Where the triangles of a surface look, and it at its vertices.
#ifndef LACERTA_GEOMETRY_VERTEX_AREA_VECTORS_H_
#define LACERTA_GEOMETRY_VERTEX_AREA_VECTORS_H_

#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// The normal of a triangle, as long as twice its area.
inline Vec3d AreaVector(const std::vector<Vec3f>& positions, const Triangle& t) {
  const Vec3d a = Vec3Cast<double>(positions[t[0]]);
  return Cross(Vec3Cast<double>(positions[t[1]]) - a, Vec3Cast<double>(positions[t[2]]) - a);
}

// #V: of each vertex the sum over its triangles of their AreaVector. Zero where there is no area.
std::vector<Vec3d> VertexAreaVectors(const TriangleMesh& mesh);

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_VERTEX_AREA_VECTORS_H_
