#include "remesh/fan_chart.h"

#include <cmath>

namespace lacerta {
namespace {

constexpr double kPi = 3.14159265358979323846;
// Twice the area of a face in its chart, whose radius is 1: below, points would not come back where they were.
constexpr double kLeastChartArea = 1e-9;

}  // namespace

std::vector<Vec2d> FlattenFan(const Vec3d& center, const Fan& fan, const std::vector<Vec3d>& positions) {
  const int k = fan.size(), num_faces = static_cast<int>(fan.faces.size());
  std::vector<double> angle(k, 0.0), radius(k);
  double total = 0, scale = 0;
  for (int i = 0; i < k; ++i) {
    radius[i] = Norm(positions[fan.ring[i]] - center);
    scale = std::max(scale, radius[i]);
  }
  for (int i = 0; i < num_faces; ++i) {
    const Vec3d a = positions[fan.ring[i]] - center, b = positions[fan.ring[(i + 1) % k]] - center;  // NOLINT(clang-analyzer-core.DivideZero): fans have neighbors
    angle[i] = std::max(std::atan2(Norm(Cross(a, b)), Dot(a, b)), 1e-4);
    total += angle[i];
  }
  const double exponent = (fan.is_open() ? kPi : 2 * kPi) / total;
  if (fan.curve[0] >= 0 && !fan.is_open()) {  // each side of the crease for itself
    double side = 0;
    for (int i = fan.curve[0]; i < fan.curve[1]; ++i) side += angle[i];
    for (int i = 0; i < k; ++i) {
      const bool between = i >= fan.curve[0] && i < fan.curve[1];
      angle[i] *= kPi / ((between ? side : total - side) * exponent);
    }
  }
  std::vector<Vec2d> chart(k);
  double theta = 0;
  for (int i = 0; i < k; ++i) {
    const double r = std::pow(std::max(radius[i] / scale, 1e-6), exponent);
    chart[i] = {r * std::cos(theta), r * std::sin(theta)};
    theta += angle[i] * exponent;
  }
  return chart;
}

bool IsStarShaped(const std::vector<Vec2d>& chart, size_t num_faces) {
  for (size_t i = 0; i < num_faces; ++i) {
    if (!(DoubledArea(Vec2d{}, chart[i], chart[(i + 1) % chart.size()]) > kLeastChartArea)) return false;
  }
  return true;
}

}  // namespace lacerta
