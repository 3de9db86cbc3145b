#include "document/normals.h"

#include "decoder/smooth_normals.h"

namespace lacerta {

bool NormalsAreDerivable(const TriangleMesh& mesh, const std::vector<Vec3f>& normals) {
  constexpr float kLeastCosine = 0.9397f;  // 20 degrees
  const std::vector<Vec3f> derived = SmoothNormals(mesh.positions, mesh.triangles);
  std::vector<bool> used(mesh.positions.size(), false);
  for (const Triangle& triangle : mesh.triangles) {
    for (const uint32_t v : triangle) used[v] = true;
  }
  size_t num_used = 0;
  size_t num_off = 0;
  for (size_t v = 0; v < derived.size(); ++v) {
    if (!used[v]) continue;
    ++num_used;
    if (!(Dot(derived[v], Normalized(normals[v])) >= kLeastCosine)) ++num_off;
  }
  return num_off * 100 <= num_used;
}

bool NormalsAreFlat(const std::vector<Triangle>& triangles, const std::function<Vec3f(uint32_t)>& position_at, const std::vector<Triangle>& corners,
                    const std::function<Vec3f(uint32_t)>& normal_at) {
  constexpr double kLeastCosine = 0.9994;  // 2 degrees
  size_t num_off = 0;
  for (size_t f = 0; f < corners.size(); ++f) {
    const auto [a, b, c] = corners[f];
    if (a == MeshAttribute::kNoValue) continue;
    const Vec3f given = normal_at(a);
    if (normal_at(b) != given || normal_at(c) != given) return false;
    const auto at = [&](int k) { return Vec3Cast<double>(position_at(triangles[f][k])); };
    const Vec3d area = Cross(at(1) - at(0), at(2) - at(0)), normal = Vec3Cast<double>(given);
    const double length = Norm(area) * Norm(normal);
    if (length > 0 && !(Dot(area, normal) >= kLeastCosine * length)) ++num_off;
  }
  return num_off * 100 <= corners.size();
}

}  // namespace lacerta
