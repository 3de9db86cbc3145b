// Low-discrepancy points of a triangle.
#ifndef LACERTA_GEOMETRY_TRIANGLE_POINTS_H_
#define LACERTA_GEOMETRY_TRIANGLE_POINTS_H_

#include <cmath>
#include <cstdint>

#include "lacerta/vec3.h"

namespace lacerta {

// Barycentric weights of point i of the R2 sequence [Roberts 2018], folded into a triangle. offset: where the sequence begins,
// 0 <= offset < 1.
inline Vec3d TrianglePoint(uint64_t i, double offset) {
  const auto n = static_cast<double>(i);
  double u = offset + n * 0.7548776662466927, v = offset + n * 0.5698402909980532;
  u -= std::floor(u);
  v -= std::floor(v);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return {1 - u - v, u, v};
}

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_TRIANGLE_POINTS_H_
