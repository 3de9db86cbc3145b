// Points spread evenly over the area of a surface.
#ifndef LACERTA_GEOMETRY_SURFACE_SAMPLER_H_
#define LACERTA_GEOMETRY_SURFACE_SAMPLER_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/triangle_tree.h"

namespace lacerta {

inline double DoubledArea(const TriangleTree::Corners& corners) {
  const Vec3d a = Vec3Cast<double>(corners[0]);
  return Norm(Cross(Vec3Cast<double>(corners[1]) - a, Vec3Cast<double>(corners[2]) - a));
}

// Doubled area of the triangles up to and with each.
inline std::vector<double> CumulatedAreas(const std::vector<TriangleTree::Corners>& triangles) {
  std::vector<double> cumulated;
  cumulated.reserve(triangles.size());
  double area = 0.0;
  for (const TriangleTree::Corners& corners : triangles) {
    area += DoubledArea(corners);
    cumulated.push_back(area);
  }
  return cumulated;
}

// Where samples lie. One sample falls into each of num_samples equal parts of the area; its place in that part follows the golden ratio, so that
// no pattern of the triangles can keep step with the samples. Within its triangle it follows the R2 sequence [Roberts 2018], whose points stay
// well spread both over one large triangle that takes many samples in a row and over many small ones that take one sample each. The
// seed shifts all three.
class SampleSequence {
 public:
  SampleSequence(uint64_t num_samples, uint32_t seed) : num_samples_(static_cast<double>(num_samples)), seed_(seed) {}

  // Share of the area before sample i, at most 1.
  double ShareAt(uint64_t i) const {
    constexpr double kStep = 0.6180339887498949;  // 1 / (root of x^2 = x + 1)
    constexpr double kSeed = 0.4142135623730950;
    const double n = static_cast<double>(i);
    return std::min((n + Fraction(n * kStep + seed_ * kSeed)) / num_samples_, 1.0);
  }

  // Weights of the second and the third corner of the triangle of sample i.
  std::pair<double, double> WeightsAt(uint64_t i) const {
    constexpr double kStepU = 0.7548776662466927, kStepV = 0.5698402909980532;  // powers of 1 / (root of x^3 = x + 1)
    constexpr double kSeedU = 0.7320508075688772, kSeedV = 0.2360679774997897;
    const double n = static_cast<double>(i);
    const double u = Fraction(n * kStepU + seed_ * kSeedU + 0.5), v = Fraction(n * kStepV + seed_ * kSeedV + 0.5);
    if (u + v > 1.0) return {1.0 - u, 1.0 - v};
    return {u, v};
  }

 private:
  static double Fraction(double x) { return x - std::floor(x); }

  double num_samples_, seed_;
};

// The point of a triangle with these weights of its second and third corner.
inline Vec3f PointWithWeights(const TriangleTree::Corners& corners, double u, double v) {
  const Vec3d a = Vec3Cast<double>(corners[0]), b = Vec3Cast<double>(corners[1]), c = Vec3Cast<double>(corners[2]);
  return Vec3Cast<float>(a + (b - a) * u + (c - a) * v);
}

// Walks through the samples of a surface in order.
class SurfaceSampler {
 public:
  struct Point {
    size_t slot;  // of the triangle
    double u, v;  // weights of its second and third corner
    Vec3f position;
  };

  // cumulated_area: CumulatedAreas(corners), the last above 0. Keeps references to both.
  SurfaceSampler(const std::vector<TriangleTree::Corners>& corners, const std::vector<double>& cumulated_area, uint64_t num_samples, uint32_t seed)
      : corners_(corners), cumulated_area_(cumulated_area), sequence_(num_samples, seed) {}

  // i: never less than in the call before.
  Point Sample(uint64_t i) {
    const double target = sequence_.ShareAt(i) * cumulated_area_.back();
    while (slot_ + 1 < cumulated_area_.size() && !(target < cumulated_area_[slot_])) Advance(target);
    const auto [u, v] = sequence_.WeightsAt(i);
    return {slot_, u, v, PointWithWeights(corners_[slot_], u, v)};
  }

 private:
  // Moves on to the triangle that holds `target`: the next one mostly, else by bisection.
  void Advance(double target) {
    ++slot_;
    if (target < cumulated_area_[slot_]) return;
    const auto from = cumulated_area_.begin() + static_cast<std::ptrdiff_t>(slot_);
    slot_ = static_cast<size_t>(std::upper_bound(from, cumulated_area_.end(), target) - cumulated_area_.begin());
    slot_ = std::min(slot_, cumulated_area_.size() - 1);
  }

  const std::vector<TriangleTree::Corners>& corners_;
  const std::vector<double>& cumulated_area_;
  SampleSequence sequence_;
  size_t slot_ = 0;
};

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_SURFACE_SAMPLER_H_
