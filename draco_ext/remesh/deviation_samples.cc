#include "remesh/deviation_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacerta {
namespace {

TriangleMesh ToMesh(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles) {
  TriangleMesh mesh;
  mesh.triangles = triangles;
  mesh.positions.reserve(positions.size());
  for (const Vec3d& p : positions) mesh.positions.push_back(Vec3Cast<float>(p));
  return mesh;
}

}  // namespace

DeviationSamples::DeviationSamples(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles, const std::vector<uint32_t>& groups,
                                   double farthest)
    : farthest_(farthest), tree_(ToMesh(positions, triangles)) {
  Take(positions, triangles, groups);
}

DeviationSamples::DeviationSamples(const TriangleMesh& surface, double farthest) : farthest_(farthest), tree_(surface) {
  std::vector<Vec3d> positions;
  positions.reserve(surface.positions.size());
  for (const Vec3f& p : surface.positions) positions.push_back(Vec3Cast<double>(p));
  Take(positions, surface.triangles, {});
}

void DeviationSamples::Take(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles, const std::vector<uint32_t>& groups) {
  constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t> last_group(positions.size(), kNone);
  for (uint32_t f = 0; f < triangles.size(); ++f) {
    const Triangle& t = triangles[f];
    const uint32_t group = groups.empty() ? 0 : groups[f];
    for (const uint32_t v : t) {
      if (last_group[v] != group) Add(positions[v], f);
      last_group[v] = group;
    }
    const std::array<Vec3d, 3> corners = {positions[t[0]], positions[t[1]], positions[t[2]]};
    ForEachPointWithin(corners, StepsAlong(corners), [&](const Vec3d& p) { Add(p, f); });
  }
}

bool DeviationSamples::IsNear(const Vec3d& point) const { return tree_.IsNear(Vec3Cast<float>(point), static_cast<float>(farthest_ * farthest_)); }

// From sample to sample along a side.
uint32_t DeviationSamples::StepsAlong(const std::array<Vec3d, 3>& t) const {
  constexpr double kApart = 4, kMost = 4;  // bounds, between samples; steps, however large the triangle
  const double longest = std::max({Norm(t[1] - t[0]), Norm(t[2] - t[1]), Norm(t[0] - t[2])});
  return longest <= kApart * farthest_ ? 1 : static_cast<uint32_t>(std::min(std::ceil(longest / (kApart * farthest_)), kMost));
}

void DeviationSamples::Add(const Vec3d& position, uint32_t triangle) {
  positions_.push_back(position);
  triangles_.push_back(triangle);
}

}  // namespace lacerta
