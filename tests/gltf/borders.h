// Where surfaces end, and whether one ends where another does not.
#ifndef LACERTA_TESTS_GLTF_BORDERS_H_
#define LACERTA_TESTS_GLTF_BORDERS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
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

inline double DistanceTo(const Segment& segment, const Vec3f& p) {
  const Vec3f along = segment.second - segment.first, from = p - segment.first;
  const float length2 = Dot(along, along);
  const float t = length2 > 0.0f ? std::clamp(Dot(from, along) / length2, 0.0f, 1.0f) : 0.0f;
  return static_cast<double>(Norm(from - along * t));
}

// Length of the parts of `segments` that are farther than `tolerance` from all of `others`.
inline double LengthFarFrom(const std::vector<Segment>& segments, const std::vector<Segment>& others, double tolerance) {
  double far = 0.0;
  for (const auto& [a, b] : segments) {
    const double length = static_cast<double>(Norm(b - a));
    const int count = static_cast<int>(std::min(2.0 * length / tolerance, 1e4)) + 1;
    for (int i = 0; i < count; ++i) {
      const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
      const Vec3f p = a * (1.0f - t) + b * t;
      const bool is_near = std::any_of(others.begin(), others.end(), [&](const Segment& other) { return DistanceTo(other, p) <= tolerance; });
      far += is_near ? 0.0 : length / count;
    }
  }
  return far;
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_GLTF_BORDERS_H_
