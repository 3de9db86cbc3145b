#include "remesh/deviation_bound.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/closest_on_triangle.h"

namespace lacerta {
namespace {

TriangleMesh ToMesh(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles) {
  TriangleMesh mesh;
  mesh.triangles = triangles;
  mesh.positions.reserve(positions.size());
  for (const Vec3d& p : positions) mesh.positions.push_back(Vec3Cast<float>(p));
  return mesh;
}

// Calls visit(point) for points of a triangle that divide each side into `steps`, its corners left out.
template <typename Visit>
void ForEachPoint(const std::array<Vec3d, 3>& t, uint32_t steps, const Visit& visit) {
  const Vec3d ab = (t[1] - t[0]) * (1.0 / steps), ac = (t[2] - t[0]) * (1.0 / steps);
  for (uint32_t i = 0; i <= steps; ++i) {
    for (uint32_t j = 0; i + j <= steps; ++j) {
      const bool is_corner = i == steps || j == steps || i + j == 0;
      if (!is_corner) visit(t[0] + ab * i + ac * j);
    }
  }
}

}  // namespace

DeviationBound::DeviationBound(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles, std::vector<uint32_t> groups, double farthest)
    : groups_(std::move(groups)), farthest_(farthest), original_(ToMesh(positions, triangles)), first_(triangles.size(), kNone) {
  std::vector<uint32_t> last_group(positions.size(), kNone);
  for (uint32_t f = 0; f < triangles.size(); ++f) {
    const Triangle& t = triangles[f];
    for (const uint32_t v : t) {
      if (last_group[v] != groups_[f]) Add(positions[v], f);
      last_group[v] = groups_[f];
    }
    const std::array<Vec3d, 3> corners = {positions[t[0]], positions[t[1]], positions[t[2]]};
    ForEachPoint(corners, StepsAlong(corners), [&](const Vec3d& p) { Add(p, f); });
  }
}

// Steps from sample to sample along a side.
uint32_t DeviationBound::StepsAlong(const std::array<Vec3d, 3>& t) const {
  constexpr double kApart = 4, kMost = 4;  // bounds, between samples; steps, however large the triangle
  const double longest = std::max({Norm(t[1] - t[0]), Norm(t[2] - t[1]), Norm(t[0] - t[2])});
  return static_cast<uint32_t>(std::clamp(std::ceil(longest / (kApart * farthest_)), 1.0, kMost));
}

void DeviationBound::Add(const Vec3d& sample, uint32_t triangle) {
  next_.push_back(first_[triangle]);
  first_[triangle] = static_cast<uint32_t>(samples_.size());
  samples_.push_back(sample);
}

uint32_t DeviationBound::NearestOf(const Vec3d& to, const std::vector<Face>& faces, uint32_t own, const Vec3d& sample) const {
  constexpr double kUpon = 0.1;  // of the squared bound: no need to look for a nearer one
  const double upon = kUpon * farthest_ * farthest_;
  uint32_t nearest = kNone;
  double least = farthest_ * farthest_;
  for (const Face& face : faces) {
    if (!face.remains || groups_[face.triangle] != groups_[own]) continue;
    ClosestWeights closest;
    if (!ClosestOnTriangle(sample, to, face.a, face.b, least, &closest) || closest.squared_distance > least) continue;
    least = closest.squared_distance;
    nearest = face.triangle;
    if (least < upon) break;
  }
  return nearest;
}

bool DeviationBound::IsNearOriginal(const Vec3d& point) const {
  return original_.IsNear(Vec3Cast<float>(point), static_cast<float>(farthest_ * farthest_));
}

// Small triangles are as near as their corners.
bool DeviationBound::AreNearOriginal(const Vec3d& to, const std::vector<Face>& faces) const {
  bool is_near = true, any_large = false;
  for (const Face& face : faces) {
    const std::array<Vec3d, 3> corners = {to, face.a, face.b};
    if (!face.remains || StepsAlong(corners) == 1) continue;
    any_large = true;
    ForEachPoint(corners, 2, [&](const Vec3d& p) { is_near = is_near && IsNearOriginal(p); });
  }
  return is_near && (!any_large || IsNearOriginal(to));
}

bool DeviationBound::Allows(const Vec3d& to, const std::vector<Face>& faces) {
  changed_.clear();
  places_.clear();
  for (const Face& face : faces) {
    changed_.push_back(face.triangle);
    for (uint32_t s = first_[face.triangle]; s != kNone; s = next_[s]) {
      const uint32_t nearest = NearestOf(to, faces, face.triangle, samples_[s]);
      if (nearest == kNone) return false;
      places_.push_back({s, nearest});
    }
  }
  return AreNearOriginal(to, faces);
}

void DeviationBound::Accept() {
  for (const uint32_t triangle : changed_) first_[triangle] = kNone;
  for (const Place& place : places_) {
    next_[place.sample] = first_[place.triangle];
    first_[place.triangle] = place.sample;
  }
}

}  // namespace lacerta
