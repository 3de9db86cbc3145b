// Midpoints of levels over a base mesh, as the butterfly predicts them and as the input has them: what these levels have left to code.
#ifndef LACERTA_REMESH_BASE_MIDPOINTS_H_
#define LACERTA_REMESH_BASE_MIDPOINTS_H_

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"
#include "remesh/base_domain.h"
#include "remesh/input_surface.h"

namespace lacerta {

// Base vertices and the midpoints of some levels, numbered as in the finest of these, and what is predicted from what.
struct MidpointsOver {
  struct Midpoint {
    std::array<uint32_t, 2> ends{};   // of its edge
    std::array<uint32_t, 2> faces{};  // of the base, that it lies on
    size_t first = 0;                 // of its stencil, up to the first of the next midpoint
    double weight = 0.0;              // of what it takes; 0 on curves, which are coded otherwise
  };
  struct Entry {
    uint32_t point;
    double weight;
  };

  // As many levels as have more than `enough` points, at least one.
  MidpointsOver(const Topology& base, uint32_t enough);

  uint32_t num_base() const { return level_ends.front(); }
  uint32_t num_points() const { return level_ends.back(); }
  const Midpoint& midpoint(uint32_t point) const { return midpoints[point - num_base()]; }
  Vec3d Predicted(uint32_t point, const std::vector<Vec3d>& at) const {
    Vec3d sum;
    ForStencil(point, [&](const Entry& entry) { sum += at[entry.point] * entry.weight; });
    return sum;
  }
  template <typename Visit>
  void ForStencil(uint32_t point, const Visit& visit) const {
    for (size_t k = midpoint(point).first; k < midpoint(point + 1).first; ++k) visit(stencils[k]);
  }
  // visit(point) for all midpoints, a level after the other, on all cores.
  template <typename Visit>
  void ForLevels(const Visit& visit) const {
    for (size_t level = 1; level < level_ends.size(); ++level) tbb::parallel_for(level_ends[level - 1], level_ends[level], visit);
  }

  std::vector<uint32_t> level_ends;  // numbers of points up to each level, the base first
  std::vector<Midpoint> midpoints;   // and one more that ends the last stencil
  std::vector<Entry> stencils;
};

// The corners opposite to an edge of the base, then its ends. All that have two faces.
using Flap = std::array<uint32_t, 4>;
std::vector<Flap> FlapsOf(const Topology& base);
inline Vec3d OffParallelogram(const Flap& flap, const std::vector<Vec3d>& at) { return at[flap[0]] + at[flap[1]] - at[flap[2]] - at[flap[3]]; }

// Where the points of MidpointsOver are on the input.
struct PointsOnInput {
  std::vector<Vec3d> at;          // of each point
  std::vector<Vec3d> normals;     // of the input there
  std::vector<uint32_t> faces;    // of the input there; none of base vertices that have not slid
  std::vector<double> distances;  // of midpoints as predicted, with the sign of their side

  void Resize(uint32_t num_points);
};

// The base vertices of a domain at `positions`, #V, which are on the input, and room for `num_points`.
PointsOnInput BaseOnInput(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& positions, uint32_t num_points);

// Predicts a midpoint from what is before it, and finds the closest point of the input. Returns whether that is on the sheet of the base's edge.
bool FindMidpoint(const InputSurface& surface, const MidpointsOver& midpoints, uint32_t point, PointsOnInput* points);

// What is taken for the bits of a difference, the sum of log2(1 + (d / r)^2) / 2. r, half the mean distance of the first level's midpoints, is far above a quantization step: squares
// count, so that what is worst is mended first.
class CodingBits {
 public:
  // The first level of `midpoints` has to be found.
  CodingBits(const MidpointsOver& midpoints, const PointsOnInput& points);

  bool is_nothing() const { return !(squared_resolution_ > 0.0); }  // there is nothing to code but what rounding makes
  double Of(double square) const { return 0.5 * std::log2(1.0 + square / squared_resolution_); }
  double Slope(double square) const { return 1.0 / (squared_resolution_ + square); }  // over the square; but for a factor
  // A base vertex has three flaps, each with three coordinates: a third of them counts.
  double OfFlap(const Flap& flap, const std::vector<Vec3d>& at) const { return Of(SquaredNorm(OffParallelogram(flap, at)) / 3.0); }

 private:
  double squared_resolution_ = 0.0;
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_BASE_MIDPOINTS_H_
