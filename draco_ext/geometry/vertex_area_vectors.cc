#include "geometry/vertex_area_vectors.h"

namespace lacerta {

std::vector<Vec3d> VertexAreaVectors(const TriangleMesh& mesh) {
  std::vector<Vec3d> vectors(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = Vec3Cast<double>(mesh.positions[t[0]]);
    const Vec3d vector = Cross(Vec3Cast<double>(mesh.positions[t[1]]) - a, Vec3Cast<double>(mesh.positions[t[2]]) - a);
    for (const uint32_t v : t) vectors[v] += vector;
  }
  return vectors;
}

}  // namespace lacerta
