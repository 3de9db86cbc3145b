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

}  // namespace lacerta
