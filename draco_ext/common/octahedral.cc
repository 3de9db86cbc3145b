#include "common/octahedral.h"

#include <algorithm>
#include <cmath>

namespace lacerta {
namespace {

int32_t Largest(int bits) { return (1 << bits) - 2; }

}  // namespace

std::array<int32_t, 2> OctahedralFromNormal(const Vec3f& normal, int bits) {
  const double x = normal.x, y = normal.y, z = normal.z;
  const double sum = std::fabs(x) + std::fabs(y) + std::fabs(z);
  const int32_t largest = Largest(bits), center = largest / 2;
  if (!(sum > 0) || !std::isfinite(sum)) return {center, center};
  double s = y / sum, t = z / sum;
  if (x < 0) {  // the far half lies around the rim: reflected across the nearest side of the diamond
    const double folded = (1 - std::fabs(t)) * (y < 0 ? -1 : 1);
    t = (1 - std::fabs(s)) * (z < 0 ? -1 : 1);
    s = folded;
  }
  const auto round = [&](double value) {
    return std::clamp(static_cast<int32_t>(std::lround((value + 1) * center)), 0, largest);
  };
  std::array<int32_t, 2> point = {round(s), round(t)};
  if (point[0] == 0 || point[0] == largest) point[1] = std::min(point[1], largest - point[1]);
  if (point[1] == 0 || point[1] == largest) point[0] = std::min(point[0], largest - point[0]);
  return point;
}

Vec3f NormalFromOctahedral(const std::array<int32_t, 2>& point, int bits) {
  const double center = 0.5 * Largest(bits);
  const double s = point[0] / center - 1, t = point[1] / center - 1;
  const double x = 1 - std::fabs(s) - std::fabs(t), fold = std::max(-x, 0.0);
  // Rounded to float at the end alone: GCC 12 leaves out what is rounded on the way where it makes vectors of it.
  return Vec3Cast<float>(Normalized(Vec3d{x, s + (s < 0 ? fold : -fold), t + (t < 0 ? fold : -fold)}));
}

}  // namespace lacerta
