// Quadric error metric [Garland, Heckbert 1997]: the area-weighted sum of squared distances to planes, as a symmetric form.
#ifndef LACERTA_REMESH_QUADRIC_H_
#define LACERTA_REMESH_QUADRIC_H_

#include <Eigen/Core>

#include "lacerta/vec3.h"

namespace lacerta {

// p -> p' quadratic p + 2 linear' p + constant.
struct Quadric {
  Eigen::Matrix3d quadratic = Eigen::Matrix3d::Zero();
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  double constant = 0;

  // The plane of a triangle, weighted by its area; zero for a triangle without area.
  static Quadric OfTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d cross = Cross(b - a, c - a);
    const double norm = Norm(cross);
    if (!(norm > 0)) return {};
    const Eigen::Vector3d n = AsEigen(cross) / norm;
    const double d = -n.dot(AsEigen(a)), area = norm / 2;
    return {area * n * n.transpose(), area * d * n, area * d * d};
  }

  // The plane through the edge from a to b, upright on its triangle, whose third corner is c, weighted by `weight` times the squared length.
  static Quadric OfBorder(const Vec3d& a, const Vec3d& b, const Vec3d& c, double weight) {
    const Vec3d normal = Normalized(Cross(b - a, c - a));
    return OfTriangle(a, b, a + normal * (2 * weight * Norm(b - a)));
  }

  Quadric& operator+=(const Quadric& b) {
    quadratic += b.quadratic;
    linear += b.linear;
    constant += b.constant;
    return *this;
  }

  Quadric& operator*=(double factor) {
    quadratic *= factor;
    linear *= factor;
    constant *= factor;
    return *this;
  }

  // Weighted squared distance of p; not below zero, whatever the rounding.
  double Evaluate(const Vec3d& p) const {
    const auto x = AsEigen(p);
    const double value = x.dot(quadratic * x) + 2 * linear.dot(x) + constant;
    return value > 0 ? value : 0;
  }

 private:
  static Eigen::Map<const Eigen::Vector3d> AsEigen(const Vec3d& p) { return Eigen::Map<const Eigen::Vector3d>(&p.x); }
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_QUADRIC_H_
