#include "remesh/input_surface.h"

#include <cmath>

namespace lacerta {

InputSurface::InputSurface(const TriangleMesh& mesh) : mesh_(mesh), tree_(mesh) {
  std::vector<Vec3d> sums(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    Vec3d p[3];
    for (int k = 0; k < 3; ++k) p[k] = Vec3Cast<double>(mesh.positions[t[k]]);
    const Vec3d normal = Normalized(Cross(p[1] - p[0], p[2] - p[0]));
    for (int k = 0; k < 3; ++k) {
      const Vec3d a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
      sums[t[k]] += normal * std::atan2(Norm(Cross(a, b)), Dot(a, b));
    }
  }
  vertex_normals_.reserve(sums.size());
  for (const Vec3d& sum : sums) vertex_normals_.push_back(Vec3Cast<float>(Normalized(sum)));
}

Vec3f InputSurface::NormalAt(uint32_t face, const Vec3d& w) const {
  const Triangle& t = mesh_.triangles[face];
  Vec3d sum;
  for (int k = 0; k < 3; ++k) sum += Vec3Cast<double>(vertex_normals_[t[k]]) * w[k];
  return Vec3Cast<float>(Normalized(sum));
}

Vec3f InputSurface::PositionAt(uint32_t face, const Vec3d& w) const {
  const Triangle& t = mesh_.triangles[face];
  Vec3d sum;
  for (int k = 0; k < 3; ++k) sum += Vec3Cast<double>(mesh_.positions[t[k]]) * w[k];
  return Vec3Cast<float>(sum);
}

}  // namespace lacerta
