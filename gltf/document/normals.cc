#include "document/normals.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lacerta {
namespace {

bool Less(const Vec3f& a, const Vec3f& b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z < b.z;
}

// For every vertex the first one, in sorted order, at the same position.
std::vector<uint32_t> Representatives(const std::vector<Vec3f>& positions) {
  std::vector<uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    if (positions[a] == positions[b]) return a < b;
    return Less(positions[a], positions[b]);
  });
  std::vector<uint32_t> representative(positions.size());
  for (size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
    representative[order[i]] = same ? representative[order[i - 1]] : order[i];
  }
  return representative;
}

double Angle(const Vec3d& a, const Vec3d& b) { return std::atan2(Norm(Cross(a, b)), Dot(a, b)); }

}  // namespace

std::vector<Vec3f> DeriveNormals(const TriangleMesh& mesh) {
  const std::vector<uint32_t> representative = Representatives(mesh.positions);
  std::vector<Vec3d> sums(mesh.positions.size());
  for (const Triangle& triangle : mesh.triangles) {
    Vec3d p[3];
    for (int i = 0; i < 3; ++i) p[i] = Vec3Cast<double>(mesh.positions[triangle[static_cast<size_t>(i)]]);
    const Vec3d normal = Normalized(Cross(p[1] - p[0], p[2] - p[0]));
    for (int i = 0; i < 3; ++i) {
      const double angle = Angle(p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
      sums[representative[triangle[static_cast<size_t>(i)]]] += normal * angle;
    }
  }
  std::vector<Vec3f> normals(mesh.positions.size());
  for (size_t v = 0; v < normals.size(); ++v) {
    const Vec3d normal = Normalized(sums[representative[v]]);
    normals[v] = normal == Vec3d{} ? Vec3f{0.0f, 0.0f, 1.0f} : Vec3Cast<float>(normal);
  }
  return normals;
}

bool NormalsAreDerivable(const TriangleMesh& mesh, const std::vector<Vec3f>& normals) {
  constexpr float kLeastCosine = 0.9397f;  // 20 degrees
  const std::vector<Vec3f> derived = DeriveNormals(mesh);
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
