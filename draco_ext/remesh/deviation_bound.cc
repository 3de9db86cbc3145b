#include "remesh/deviation_bound.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "geometry/closest_on_triangle.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

}  // namespace

DeviationBound::DeviationBound(std::shared_ptr<const DeviationSamples> original, size_t num_triangles)
    : original_(std::move(original)),
      most_squared_(original_->size(), original_->farthest() * original_->farthest()),
      first_(num_triangles, kNone),
      next_(original_->size(), kNone) {}

DeviationBound::DeviationBound(std::shared_ptr<const DeviationSamples> original, size_t num_triangles, std::vector<uint32_t> groups)
    : DeviationBound(std::move(original), num_triangles) {
  groups_ = std::move(groups);
  for (uint32_t s = 0; s < original_->size(); ++s) Put({s, original_->triangle(s)});
}

DeviationBound::DeviationBound(std::shared_ptr<const DeviationSamples> original, const TriangleMesh& surface)
    : DeviationBound(std::move(original), surface.triangles.size()) {
  const TriangleTree tree(surface);
  std::vector<uint32_t> nearest(original_->size());
  constexpr uint32_t kGrain = 1024;
  tbb::parallel_for(tbb::blocked_range<uint32_t>(0, original_->size(), kGrain), [&](const tbb::blocked_range<uint32_t>& range) {
    uint32_t hint = SurfacePoint::kNone;
    for (uint32_t s = range.begin(); s != range.end(); ++s) {
      const ClosestPointResult closest = tree.ClosestPointNear(Vec3Cast<float>(original_->position(s)), hint);
      hint = nearest[s] = closest.point.face;
      if (hint != SurfacePoint::kNone) most_squared_[s] = std::max(most_squared_[s], static_cast<double>(closest.squared_distance));
    }
  });
  for (uint32_t s = 0; s < original_->size(); ++s) {
    if (nearest[s] != SurfacePoint::kNone) Put({s, nearest[s]});
  }
}

void DeviationBound::Put(const Place& place) {
  next_[place.sample] = first_[place.triangle];
  first_[place.triangle] = place.sample;
}

uint32_t DeviationBound::NearestOf(const Vec3d& to, const std::vector<Face>& faces, uint32_t own, uint32_t sample) const {
  constexpr double kUpon = 0.1;  // of the squared bound: no need to look for a nearer one
  const Vec3d& position = original_->position(sample);
  uint32_t nearest = kNone;
  double least = most_squared_[sample];
  const double upon = kUpon * least;
  for (const Face& face : faces) {
    if (!face.remains || (!groups_.empty() && groups_[face.triangle] != groups_[own])) continue;
    ClosestWeights closest;
    if (!ClosestOnTriangle(position, to, face.a, face.b, least, &closest) || closest.squared_distance > least) continue;
    least = closest.squared_distance;
    nearest = face.triangle;
    if (least < upon) break;
  }
  return nearest;
}

// Small triangles are as near as their corners.
bool DeviationBound::AreNearOriginal(const Vec3d& to, const std::vector<Face>& faces) const {
  constexpr uint32_t kSteps = 2;
  bool is_near = true, any_large = false;
  for (const Face& face : faces) {
    const std::array<Vec3d, 3> corners = {to, face.a, face.b};
    if (!face.remains || !original_->IsLarge(corners)) continue;
    any_large = true;
    ForEachPointWithin(corners, kSteps, [&](const Vec3d& p) { is_near = is_near && original_->IsNear(p); });
  }
  return is_near && (!any_large || original_->IsNear(to));
}

bool DeviationBound::Allows(const Vec3d& to, const std::vector<Face>& faces) {
  changed_.clear();
  places_.clear();
  for (const Face& face : faces) {
    changed_.push_back(face.triangle);
    for (uint32_t s = first_[face.triangle]; s != kNone; s = next_[s]) {
      const uint32_t nearest = NearestOf(to, faces, face.triangle, s);
      if (nearest == kNone) return false;
      places_.push_back({s, nearest});
    }
  }
  return AreNearOriginal(to, faces);
}

void DeviationBound::Accept() {
  for (const uint32_t triangle : changed_) first_[triangle] = kNone;
  for (const Place& place : places_) Put(place);
}

void DeviationBound::Give(uint32_t triangle, uint32_t to) {
  uint32_t sample = std::exchange(first_[triangle], kNone);
  while (sample != kNone) {
    const uint32_t next = next_[sample];
    Put({sample, to});
    sample = next;
  }
}

}  // namespace lacerta
