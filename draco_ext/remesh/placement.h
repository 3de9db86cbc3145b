// Where the vertex that an edge collapses to is best.
#ifndef LACERTA_REMESH_PLACEMENT_H_
#define LACERTA_REMESH_PLACEMENT_H_

#include <Eigen/LU>

#include "remesh/quadric.h"

namespace lacerta {

struct Placement {
  double cost = 0;
  Vec3d position;
};

// Least value of the quadric near the edge from a to b, in its middle where the quadric does not tell, as along a flat region or a crease.
// farthest: from the middle, in lengths of the edge; at least a half.
inline Placement PlaceBetween(const Quadric& q, const Vec3d& a, const Vec3d& b, double farthest = 2) {
  const Vec3d middle = (a + b) * 0.5;
  const Eigen::Map<const Eigen::Vector3d> m(&middle.x);
  const double trace = q.quadratic.trace();
  Placement best;
  best.position = middle;
  best.cost = q.Evaluate(middle);
  if (trace > 0) {
    const Eigen::Matrix3d damped = q.quadratic + Eigen::Matrix3d::Identity() * (1e-3 * trace);
    const Eigen::Vector3d gradient = q.quadratic * m + q.linear;
    const Eigen::Vector3d x = m - damped.inverse() * gradient;
    const Vec3d optimum{x[0], x[1], x[2]};
    const double cost = q.Evaluate(optimum);
    if (cost < best.cost && SquaredNorm(optimum - middle) < farthest * farthest * SquaredNorm(a - b)) best = {cost, optimum};
  }
  for (const Vec3d& end : {a, b}) {
    const double cost = q.Evaluate(end);
    if (cost < best.cost) best = {cost, end};
  }
  return best;
}

}  // namespace lacerta

#endif  // LACERTA_REMESH_PLACEMENT_H_
