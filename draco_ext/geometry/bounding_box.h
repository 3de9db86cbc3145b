// The axis-aligned box around points.
#ifndef LACERTA_GEOMETRY_BOUNDING_BOX_H_
#define LACERTA_GEOMETRY_BOUNDING_BOX_H_

#include <algorithm>
#include <vector>

#include "lacerta/vec3.h"

namespace lacerta {

struct BoundingBox {
  Vec3f low, high;
};

// Makes the box hold p as well.
inline void Extend(const Vec3f& p, BoundingBox* box) {
  for (int c = 0; c < 3; ++c) {
    box->low[c] = std::min(box->low[c], p[c]);
    box->high[c] = std::max(box->high[c], p[c]);
  }
}

// points: at least one, finite.
inline BoundingBox BoundsOf(const std::vector<Vec3f>& points) {
  BoundingBox box{points[0], points[0]};
  for (const Vec3f& p : points) Extend(p, &box);
  return box;
}

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_BOUNDING_BOX_H_
