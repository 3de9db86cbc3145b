#include "decoder/smooth_normals.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace lacerta {
namespace {

constexpr uint32_t kEmpty = UINT32_MAX;

uint32_t Hash(const Vec3f& p) {
  uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float value = p[axis] + 0.0f;  // -0 is 0
    uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    hash = (hash ^ bits) * 0x9E3779B97F4A7C15u;
    hash ^= hash >> 29;
  }
  return static_cast<uint32_t>(hash >> 16);
}

// For every vertex one of those at the same position.
std::vector<uint32_t> Representatives(Span<const Vec3f> positions) {
  size_t size = 16;
  while (size < positions.size() * 2) size *= 2;
  // A hostile mesh may put many positions into one place of the table: each of them is looked for so far and no further.
  constexpr int kMaxProbes = 64;
  std::vector<uint32_t> table(size, kEmpty), representative(positions.size());
  for (uint32_t v = 0; v < positions.size(); ++v) {
    representative[v] = v;
    size_t slot = Hash(positions[v]) & (size - 1);
    for (int probe = 0; probe < kMaxProbes; ++probe, slot = (slot + 1) & (size - 1)) {
      if (table[slot] == kEmpty) table[slot] = v;
      if (positions[table[slot]] != positions[v]) continue;
      representative[v] = table[slot];
      break;
    }
  }
  return representative;
}

// atan(x) for 0 <= x <= 1 to 2e-6 rad [Abramowitz, Stegun 1964, 4.4.49].
double ArcTangent(double x) {
  const double s = x * x;
  return x * (0.9998660 + s * (-0.3302995 + s * (0.1801410 + s * (-0.0851330 + s * 0.0208351))));
}

// The angle with this sine and cosine, both times the same positive factor: 0..pi.
double Angle(double sine, double cosine) {
  constexpr double kPi = 3.14159265358979323846;
  const double c = std::fabs(cosine);
  if (sine == 0 && c == 0) return 0;
  const double acute = sine <= c ? ArcTangent(sine / c) : kPi / 2 - ArcTangent(c / sine);
  return cosine < 0 ? kPi - acute : acute;
}

}  // namespace

std::vector<Vec3f> SmoothNormals(Span<const Vec3f> positions, Span<const Triangle> triangles) {
  const std::vector<uint32_t> representative = Representatives(positions);
  std::vector<Vec3d> sums(positions.size());
  for (const Triangle& triangle : triangles) {
    const Vec3d p[3] = {Vec3Cast<double>(positions[triangle[0]]), Vec3Cast<double>(positions[triangle[1]]),
                        Vec3Cast<double>(positions[triangle[2]])};
    const Vec3d side[3] = {p[1] - p[0], p[2] - p[1], p[0] - p[2]};
    const Vec3d area = Cross(side[0], side[1]);
    const double twice_area = Norm(area);
    if (!(twice_area > 0) || !std::isfinite(twice_area)) continue;
    const Vec3d normal = area * (1.0 / twice_area);
    for (int i = 0; i < 3; ++i) {
      const double angle = Angle(twice_area, -Dot(side[i], side[(i + 2) % 3]));
      sums[representative[triangle[static_cast<size_t>(i)]]] += normal * angle;
    }
  }
  std::vector<Vec3f> normals(positions.size());
  for (size_t v = 0; v < normals.size(); ++v) {
    const Vec3d normal = Normalized(sums[representative[v]]);
    normals[v] = normal == Vec3d{} ? Vec3f{0.0f, 0.0f, 1.0f} : Vec3Cast<float>(normal);
  }
  return normals;
}

}  // namespace lacerta
