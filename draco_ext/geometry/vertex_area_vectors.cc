#include "geometry/vertex_area_vectors.h"

namespace lacerta {

std::vector<Vec3d> VertexAreaVectors(const TriangleMesh& mesh) {
  std::vector<Vec3d> vectors(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d vector = AreaVector(mesh.positions, t);
    for (const uint32_t v : t) vectors[v] += vector;
  }
  return vectors;
}

}  // namespace lacerta
