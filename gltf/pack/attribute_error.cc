#include "pack/attribute_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace lacerta {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

using Vec4d = std::array<double, 4>;

double Dot(const Vec4d& a, const Vec4d& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }

Vec3d AreaVector(const TriangleMesh& surface, const std::vector<Vec3f>& positions, size_t triangle) {
  const Triangle& t = surface.triangles[triangle];
  const Vec3d a = Vec3Cast<double>(positions[t[0]]);
  return Cross(Vec3Cast<double>(positions[t[1]]) - a, Vec3Cast<double>(positions[t[2]]) - a) * 0.5;
}

// sqrt of the mean of |e|^2 with e linear on every triangle: (|a|^2 + |b|^2 + |c|^2 + ab + bc + ca) / 6 on each.
double RmsOf(const TriangleMesh& surface, const std::vector<Vec4d>& errors) {
  double sum = 0.0;
  double area_sum = 0.0;
  double corners = 0.0;
  for (size_t f = 0; f < surface.triangles.size(); ++f) {
    const Triangle& t = surface.triangles[f];
    const Vec4d &a = errors[t[0]], &b = errors[t[1]], &c = errors[t[2]];
    const double squares = Dot(a, a) + Dot(b, b) + Dot(c, c);
    const double area = Norm(AreaVector(surface, surface.positions, f));
    sum += area * (squares + Dot(a, b) + Dot(b, c) + Dot(c, a)) / 6.0;
    area_sum += area;
    corners += squares;
  }
  if (area_sum > 0.0) return std::sqrt(std::max(sum / area_sum, 0.0));
  return surface.triangles.empty() ? 0.0 : std::sqrt(corners / (3.0 * static_cast<double>(surface.triangles.size())));
}

Vec3d Direction(const AccessorData& data, uint64_t i) {
  return Normalized(Vec3d{data.Float(i, 0), data.Float(i, 1), data.Float(i, 2)});
}

}  // namespace

double SurfaceRms(const TriangleMesh& surface, const AccessorData& before, const AccessorData& after) {
  std::vector<Vec4d> errors(static_cast<size_t>(before.count), Vec4d{});
  for (uint64_t i = 0; i < before.count; ++i) {
    for (uint32_t c = 0; c < before.components; ++c) {
      errors[static_cast<size_t>(i)][c] = static_cast<double>(after.Float(i, c)) - before.Float(i, c);
    }
  }
  return RmsOf(surface, errors);
}

double DirectionRms(const TriangleMesh& surface, const AccessorData& before, const AccessorData& after) {
  std::vector<Vec4d> errors(static_cast<size_t>(before.count), Vec4d{});
  for (uint64_t i = 0; i < before.count; ++i) {
    const Vec3d from = Direction(before, i);
    if (from == Vec3d{}) continue;
    const Vec3d chord = Direction(after, i) - from;
    errors[static_cast<size_t>(i)] = {chord.x, chord.y, chord.z, 0.0};
  }
  return 2.0 * std::asin(std::min(RmsOf(surface, errors) / 2.0, 1.0)) * kDegrees;
}

double FlippedShare(const TriangleMesh& surface, const std::vector<Vec3f>& moved) {
  double flipped = 0.0;
  double area_sum = 0.0;
  for (size_t f = 0; f < surface.triangles.size(); ++f) {
    const Vec3d before = AreaVector(surface, surface.positions, f);
    const Vec3d after = AreaVector(surface, moved, f);
    const double area = Norm(before);
    area_sum += area;
    if (before.x * after.x + before.y * after.y + before.z * after.z < 0.0) flipped += area;
  }
  return area_sum > 0.0 ? flipped / area_sum : 0.0;
}

}  // namespace lacerta
