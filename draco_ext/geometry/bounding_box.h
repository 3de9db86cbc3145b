// The axis-aligned box around points.
#ifndef LACERTA_GEOMETRY_BOUNDING_BOX_H_
#define LACERTA_GEOMETRY_BOUNDING_BOX_H_

#include <algorithm>
#include <cfloat>
#include <vector>

#include "lacerta/vec3.h"

namespace lacerta {

struct BoundingBox {  // empty at first
  Vec3f low{FLT_MAX, FLT_MAX, FLT_MAX}, high{-FLT_MAX, -FLT_MAX, -FLT_MAX};
};

// Makes the box hold another one, or a point, as well.
inline void Extend(const BoundingBox& other, BoundingBox* box) {
  for (int c = 0; c < 3; ++c) {
    box->low[c] = std::min(box->low[c], other.low[c]);
    box->high[c] = std::max(box->high[c], other.high[c]);
  }
}
inline void Extend(const Vec3f& p, BoundingBox* box) { Extend(BoundingBox{p, p}, box); }

inline bool IsEmpty(const BoundingBox& box) { return box.low.x > box.high.x; }

// points: finite.
inline BoundingBox BoundsOf(const std::vector<Vec3f>& points) {
  BoundingBox box;
  for (const Vec3f& p : points) Extend(p, &box);
  return box;
}

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_BOUNDING_BOX_H_
