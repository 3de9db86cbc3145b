// Quadric error metric [Garland, Heckbert 1997]: the area-weighted sum of squared distances to planes, as a symmetric form.
#ifndef LACERTA_REMESH_QUADRIC_H_
#define LACERTA_REMESH_QUADRIC_H_

#include "lacerta/vec3.h"

namespace lacerta {

struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  // quadratic part
  Vec3d linear;
  double constant = 0;

  // The plane of a triangle, weighted by its area; zero for a triangle without area.
  static Quadric OfTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d cross = Cross(b - a, c - a);
    const double norm = Norm(cross);
    if (!(norm > 0)) return {};
    const Vec3d n = cross * (1 / norm);
    const double d = -Dot(n, a), w = norm / 2;
    return {w * n.x * n.x, w * n.x * n.y, w * n.x * n.z, w * n.y * n.y, w * n.y * n.z, w * n.z * n.z, n * (w * d), w * d * d};
  }

  Quadric& operator+=(const Quadric& b) {
    xx += b.xx, xy += b.xy, xz += b.xz, yy += b.yy, yz += b.yz, zz += b.zz;
    linear += b.linear;
    constant += b.constant;
    return *this;
  }

  // Weighted squared distance of p; not below zero, whatever the rounding.
  double Evaluate(const Vec3d& p) const {
    const double value = xx * p.x * p.x + yy * p.y * p.y + zz * p.z * p.z +
                         2 * (xy * p.x * p.y + xz * p.x * p.z + yz * p.y * p.z + Dot(linear, p)) + constant;
    return value > 0 ? value : 0;
  }
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_QUADRIC_H_
