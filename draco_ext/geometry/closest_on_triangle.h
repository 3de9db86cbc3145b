// The point of one triangle closest to a point.
#ifndef LACERTA_GEOMETRY_CLOSEST_ON_TRIANGLE_H_
#define LACERTA_GEOMETRY_CLOSEST_ON_TRIANGLE_H_

#include <limits>
#include <utility>

#include "lacerta/vec3.h"

namespace lacerta {

// The point of a triangle closest to some p, as weights of the corners b and c.
struct ClosestWeights {
  double b = 0.0, c = 0.0;
  double squared_distance = 0.0;
};

// Closest to p on the segment from `start` to start + d, all relative to p: parameter in [0, 1] and squared distance.
inline std::pair<double, double> ClosestOnSegment(const Vec3d& start, const Vec3d& d) {
  const double length2 = SquaredNorm(d);
  const double along = -Dot(start, d);
  const double t = along <= 0.0 || length2 <= 0.0 ? 0.0 : along >= length2 ? 1.0 : along / length2;
  return {t, SquaredNorm(start + d * t)};
}

// False where the triangle is certainly not closer than sqrt(bound2). Differences of float coordinates are exact in
// double and so are, all but the last bit, the products in `normal`: thin triangles and small distances to large
// triangles stay accurate. A projection outside the triangle is closest to one of the edges that it is outside of.
inline bool ClosestOnTriangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c, double bound2,
                              ClosestWeights* out) {
  const Vec3d pa = a - p, pb = b - p, pc = c - p;
  const Vec3d ab = b - a, ac = c - a, bc = c - b;
  const Vec3d normal = Cross(ab, ac);
  const double area2 = SquaredNorm(normal);
  const double height = Dot(pa, normal);
  if (height * height > bound2 * area2) return false;
  const double side_ab = Dot(Cross(pa, pb), normal);
  const double side_bc = Dot(Cross(pb, pc), normal);
  const double side_ca = Dot(Cross(pc, pa), normal);
  const bool degenerate = !(area2 > 0.0);
  if (!degenerate && side_ab >= 0.0 && side_bc >= 0.0 && side_ca >= 0.0) {
    *out = {side_ca / area2, side_ab / area2, height * height / area2};
    return true;
  }
  out->squared_distance = std::numeric_limits<double>::infinity();
  if (degenerate || side_ab < 0.0) {
    const auto [t, d2] = ClosestOnSegment(pa, ab);
    if (d2 < out->squared_distance) *out = {t, 0.0, d2};
  }
  if (degenerate || side_bc < 0.0) {
    const auto [t, d2] = ClosestOnSegment(pb, bc);
    if (d2 < out->squared_distance) *out = {1.0 - t, t, d2};
  }
  if (degenerate || side_ca < 0.0) {
    const auto [t, d2] = ClosestOnSegment(pa, ac);
    if (d2 < out->squared_distance) *out = {0.0, t, d2};
  }
  return true;
}

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_CLOSEST_ON_TRIANGLE_H_
