// Points for the loops in which most of decoding passes: all coordinates in one register where the machine has such, else Vec3f. The floats
// are the same either way.
#ifndef LACERTA_COMMON_FAST_POINT_H_
#define LACERTA_COMMON_FAST_POINT_H_

#include <cstring>
#include <type_traits>

#include "lacerta/vec3.h"

namespace lacerta {

#if defined(__GNUC__) && (defined(__SSE__) || defined(__ARM_NEON))
using FastPoint = float __attribute__((vector_size(16)));  // x, y, z and anything
#else
using FastPoint = Vec3f;
#endif

// The point as a Vec3f, or as a FastPoint: that reads the float behind it, too, so that there must be one.
template <typename Point>
Point LoadPoint(const Vec3f* point) {
  if constexpr (std::is_same_v<Point, Vec3f>) {
    return *point;
  } else {
    Point loaded;
    std::memcpy(&loaded, static_cast<const void*>(point), sizeof(loaded));
    return loaded;
  }
}

template <typename Point>
Vec3f ToVec3f(const Point& point) {
  return {point[0], point[1], point[2]};
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_FAST_POINT_H_
