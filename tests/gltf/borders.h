// Where surfaces end, and whether one ends where another does not.
#ifndef LACERTA_TESTS_GLTF_BORDERS_H_
#define LACERTA_TESTS_GLTF_BORDERS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta::testing {

using Segment = std::pair<Vec3f, Vec3f>;

// Edges of one triangle, after vertices at equal positions have become one and triangles with two equal corners are
// gone.
inline std::vector<Segment> BorderEdges(const TriangleMesh& mesh) {
  const auto less = [](const Vec3f& a, const Vec3f& b) {
    return std::make_tuple(a.x, a.y, a.z) < std::make_tuple(b.x, b.y, b.z);
  };
  std::vector<Vec3f> unique = mesh.positions;
  std::sort(unique.begin(), unique.end(), less);
  unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
  const auto welded = [&](uint32_t v) {
    return static_cast<size_t>(std::lower_bound(unique.begin(), unique.end(), mesh.positions[v], less) - unique.begin());
  };
  std::map<std::pair<size_t, size_t>, int> edges;
  for (const Triangle& t : mesh.triangles) {
    const size_t corners[3] = {welded(t[0]), welded(t[1]), welded(t[2])};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    for (int i = 0; i < 3; ++i) ++edges[std::minmax(corners[i], corners[(i + 1) % 3])];
  }
  std::vector<Segment> border;
  for (const auto& [edge, count] : edges) {
    if (count == 1) border.emplace_back(unique[edge.first], unique[edge.second]);
  }
  return border;
}

inline double LengthOf(const std::vector<Segment>& segments) {
  double length = 0.0;
  for (const auto& [a, b] : segments) length += static_cast<double>(Norm(b - a));
  return length;
}

// Length of the parts of `segments` that are farther than about `tolerance` (up to twice that) from all of `others`.
inline double LengthFarFrom(const std::vector<Segment>& segments, const std::vector<Segment>& others, double tolerance) {
  using Cell = std::tuple<int64_t, int64_t, int64_t>;
  const auto cell_of = [&](const Vec3f& p) {
    const auto axis = [&](float x) { return static_cast<int64_t>(std::floor(x / tolerance)); };
    return Cell(axis(p.x), axis(p.y), axis(p.z));
  };
  const auto for_samples = [&](const Segment& segment, const auto& use) {
    const double length = static_cast<double>(Norm(segment.second - segment.first));
    const int count = static_cast<int>(std::min(2.0 * length / tolerance, 1e4)) + 1;
    for (int i = 0; i < count; ++i) {
      const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
      use(segment.first * (1.0f - t) + segment.second * t, length / count);
    }
  };
  std::set<Cell> near;
  for (const Segment& segment : others) {
    for_samples(segment, [&](const Vec3f& p, double) {
      const auto [x, y, z] = cell_of(p);
      for (int64_t dx = -1; dx <= 1; ++dx) {
        for (int64_t dy = -1; dy <= 1; ++dy) {
          for (int64_t dz = -1; dz <= 1; ++dz) near.insert({x + dx, y + dy, z + dz});
        }
      }
    });
  }
  double far = 0.0;
  for (const Segment& segment : segments) {
    for_samples(segment, [&](const Vec3f& p, double length) { far += near.count(cell_of(p)) == 0 ? length : 0.0; });
  }
  return far;
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_GLTF_BORDERS_H_
