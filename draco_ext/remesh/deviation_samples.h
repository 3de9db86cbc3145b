// A surface that others have to stay near.
#ifndef LACERTA_REMESH_DEVIATION_SAMPLES_H_
#define LACERTA_REMESH_DEVIATION_SAMPLES_H_

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/triangle_tree.h"
#include "lacerta/mesh.h"
#include "lacerta/vec3.h"

namespace lacerta {

// How far any point may be, over what is allowed in the mean. Ten times as far would be out of shape.
constexpr double kFarthestOverMean = 10;

// Its vertices and points of its large triangles, each once for each group, and which points are near it.
class DeviationSamples {
 public:
  // positions: #V, within TriangleTree::kMaxCoordinate. groups: #F, of the triangles; empty: they are in one. farthest: how far any point may be, units of
  // the positions, > 0.
  DeviationSamples(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles, const std::vector<uint32_t>& groups, double farthest);
  // Of a surface in one group.
  DeviationSamples(const TriangleMesh& surface, double farthest);

  double farthest() const { return farthest_; }
  uint32_t size() const { return static_cast<uint32_t>(positions_.size()); }
  const Vec3d& position(uint32_t sample) const { return positions_[sample]; }
  uint32_t triangle(uint32_t sample) const { return triangles_[sample]; }  // that it was taken from

  bool IsNear(const Vec3d& point) const;
  // Whether so large a triangle may be far off where its corners are near.
  bool IsLarge(const std::array<Vec3d, 3>& corners) const { return StepsAlong(corners) > 1; }

 private:
  void Take(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles, const std::vector<uint32_t>& groups);
  uint32_t StepsAlong(const std::array<Vec3d, 3>& corners) const;
  void Add(const Vec3d& position, uint32_t triangle);

  double farthest_;
  TriangleTree tree_;
  std::vector<Vec3d> positions_;
  std::vector<uint32_t> triangles_;
};

// Calls visit(point) for points of a triangle that divide each side into `steps`, its corners left out.
template <typename Visit>
void ForEachPointWithin(const std::array<Vec3d, 3>& t, uint32_t steps, const Visit& visit) {
  const Vec3d ab = (t[1] - t[0]) * (1.0 / steps), ac = (t[2] - t[0]) * (1.0 / steps);
  for (uint32_t i = 0; i <= steps; ++i) {
    for (uint32_t j = 0; i + j <= steps; ++j) {
      const bool is_corner = i == steps || j == steps || i + j == 0;
      if (!is_corner) visit(t[0] + ab * i + ac * j);
    }
  }
}

}  // namespace lacerta

#endif  // LACERTA_REMESH_DEVIATION_SAMPLES_H_
