#include "lacerta/attribute_distance.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "geometry/group_surface.h"
#include "geometry/surface_sampler.h"
#include "geometry/value_difference.h"
#include "lacerta/surface_distance.h"

namespace lacerta {

struct AttributeDistanceMeter::Original {
  explicit Original(AttributedMesh original) : mesh(std::move(original)), surface(mesh), diagonal(BoundingBoxDiagonal(mesh.surface)) {}

  const AttributedMesh mesh;
  const GroupSurface surface;
  const double diagonal;
};

namespace {

constexpr uint64_t kBlockSize = 2048;
constexpr double kBestShare = 0.99;
constexpr float kAbsent = -1;  // in place of an error: no attribute there

struct SampledErrors {
  std::vector<float> errors;    // of attribute a at a * num_samples
  std::vector<uint8_t> turned;  // 1: all faces near look away
  std::vector<uint8_t> swapped;  // 1: the back of a thin sheet has come upon its front or before it
  std::vector<double> squared_distances;  // sums over the blocks of samples
};

// Whether a thin sheet that `sample` is on one side of has lost its thickness in `nearness`, what is near on the other surface.
bool IsSwapped(const GroupSurface& from, uint32_t face, const Vec3f& sample, double beyond, double diagonal, const GroupSurface::Nearness& nearness) {
  constexpr double kThinnest = 1e-5, kLeft = 0.1;  // of the diagonal; of the thickness
  if (!nearness.height_of_back || *nearness.height_of_back < -kLeft * beyond) return false;
  uint32_t hint = face;
  std::vector<GroupSurface::Point> near;
  const std::optional<double> own = from.PointsNear(from.mesh().GroupOf(face), sample, from.NormalOf(face), beyond, &hint, &near).height_of_back;
  return own && *own < -kThinnest * diagonal && *nearness.height_of_back > kLeft * *own;
}

SampledErrors ErrorsAtSamples(const GroupSurface& from, const GroupSurface& to, double diagonal, const AttributeDistanceOptions& options) {
  const std::vector<MeshAttribute>&from_attributes = from.mesh().attributes, &to_attributes = to.mesh().attributes;
  const uint64_t num_blocks = (options.num_samples + kBlockSize - 1) / kBlockSize;
  SampledErrors result{std::vector<float>(from_attributes.size() * options.num_samples, kAbsent), std::vector<uint8_t>(options.num_samples, 0),
                       std::vector<uint8_t>(options.num_samples, 0),
                       std::vector<double>(num_blocks, 0.0)};
  const double beyond = options.seam_distance * diagonal;
  uint32_t most_components = 0;
  for (const MeshAttribute& attribute : from_attributes) most_components = std::max(most_components, attribute.components);
  const auto measure_block = [&](uint64_t block) {
    SurfaceSampler sampler(from.corners(), from.cumulated_area(), options.num_samples, options.seed);
    std::vector<double> value(most_components), other(most_components);
    std::vector<GroupSurface::Point> near, sides;
    uint32_t hint = SurfacePoint::kNone;
    const uint64_t last = std::min((block + 1) * kBlockSize, options.num_samples);
    for (uint64_t i = block * kBlockSize; i < last; ++i) {
      const SurfaceSampler::Point sample = sampler.Sample(i);
      const uint32_t face = from.face_of_slot(sample.slot);
      const GroupSurface::Point here{face, {static_cast<float>(1 - sample.u - sample.v), static_cast<float>(sample.u), static_cast<float>(sample.v)}, 0, sample.position};
      const GroupSurface::Nearness nearness = to.PointsNear(from.mesh().GroupOf(face), sample.position, from.NormalOf(face), beyond, &hint, &near);
      result.turned[i] = !nearness.agrees;
      result.swapped[i] = IsSwapped(from, face, sample.position, beyond, diagonal, nearness);
      result.squared_distances[block] += static_cast<double>(nearness.squared_distance);
      const bool same_sides = !to_attributes.empty() && to.AreSidesOfAllAttributes(near);
      if (same_sides) to.KeepOnePerSide(to_attributes[0], &near);
      for (size_t a = 0; a < from_attributes.size(); ++a) {
        if (from_attributes[a].corners[face][0] == MeshAttribute::kNoValue || near.empty()) continue;
        if (to_attributes[a].corners[near[0].face][0] == MeshAttribute::kNoValue) continue;
        InterpolateValue(from_attributes[a], here, value.data());
        sides = near;
        if (!same_sides) to.KeepOnePerSide(to_attributes[a], &sides);
        double least = std::numeric_limits<double>::infinity();
        for (const GroupSurface::Point& side : sides) {
          InterpolateValue(to_attributes[a], side, other.data());
          least = std::min(least, ErrorBetween(from_attributes[a], options.texture_size, value.data(), other.data()));
        }
        result.errors[a * options.num_samples + i] = static_cast<float>(least);
      }
    }
  };
  tbb::parallel_for(tbb::blocked_range<uint64_t>(0, num_blocks, 1), [&](const tbb::blocked_range<uint64_t>& range) {
    for (uint64_t block = range.begin(); block != range.end(); ++block) measure_block(block);
  });
  return result;
}

AttributeError Summarize(std::vector<float> errors) {
  const size_t num_samples = errors.size();
  errors.erase(std::remove(errors.begin(), errors.end(), kAbsent), errors.end());
  AttributeError result;
  if (errors.empty()) return result;
  const auto num_best = static_cast<size_t>(std::ceil(kBestShare * static_cast<double>(errors.size())));
  std::vector<float> parted = errors;
  const auto last_best = parted.begin() + static_cast<std::ptrdiff_t>(num_best) - 1;
  std::nth_element(parted.begin(), last_best, parted.end());
  // Sums in the order of the samples: any standard library gives the same.
  double sum = 0, best_sum = 0;
  size_t num_below = 0;
  for (const float error : errors) {
    const double square = static_cast<double>(error) * static_cast<double>(error);
    sum += square;
    if (!(error < *last_best)) continue;
    best_sum += square;
    ++num_below;
  }
  best_sum += static_cast<double>(num_best - num_below) * static_cast<double>(*last_best) * static_cast<double>(*last_best);
  result.rms_99 = std::sqrt(best_sum / static_cast<double>(num_best));
  result.rms = std::sqrt(sum / static_cast<double>(errors.size()));
  result.max = static_cast<double>(*std::max_element(errors.begin(), errors.end()));
  result.share = static_cast<double>(errors.size()) / static_cast<double>(num_samples);
  return result;
}

struct OneSide {
  std::vector<AttributeError> errors;
  double turned = 0, swapped = 0, distance = 0;
};

OneSide MeasureOneSide(const GroupSurface& from, const GroupSurface& to, double diagonal, const AttributeDistanceOptions& options) {
  const SampledErrors samples = ErrorsAtSamples(from, to, diagonal, options);
  const auto num_samples = static_cast<double>(options.num_samples);
  OneSide result;
  const auto share = [&](const std::vector<uint8_t>& flags) { return static_cast<double>(std::count(flags.begin(), flags.end(), 1)) / num_samples; };
  result.turned = share(samples.turned);
  result.swapped = share(samples.swapped);
  result.distance = std::sqrt(std::accumulate(samples.squared_distances.begin(), samples.squared_distances.end(), 0.0) / num_samples);
  for (size_t a = 0; a < from.mesh().attributes.size(); ++a) {
    const auto begin = samples.errors.begin() + static_cast<std::ptrdiff_t>(a * options.num_samples);
    result.errors.push_back(Summarize({begin, begin + static_cast<std::ptrdiff_t>(options.num_samples)}));
  }
  return result;
}

Status CheckArea(const AttributedMesh& mesh, const GroupSurface& surface) {
  for (const Vec3f& p : mesh.surface.positions) {
    for (int k = 0; k < 3; ++k) {
      if (std::fabs(p[k]) > TriangleTree::kMaxCoordinate) return InvalidData("a coordinate is beyond 1e18; rescale the mesh");
    }
  }
  if (surface.cumulated_area().empty() || !(surface.cumulated_area().back() > 0.0)) {
    return InvalidData("all triangles are degenerate, there is no area to sample");
  }
  return Status();
}

std::vector<std::string> NamesOf(const AttributedMesh& mesh) {
  std::vector<std::string> names;
  for (const MeshAttribute& attribute : mesh.attributes) names.push_back(attribute.name);
  return names;
}

// names: of the original's attributes.
Status CheckMatch(const GroupSurface& original, const std::vector<std::string>& names, const GroupSurface& other) {
  const std::vector<MeshAttribute>&a = original.mesh().attributes, &b = other.mesh().attributes;
  if (a.size() != b.size()) return InvalidArgument("the surfaces do not have the same number of attributes");
  for (size_t i = 0; i < a.size(); ++i) {
    if (names[i] == b[i].name && a[i].kind == b[i].kind && a[i].components == b[i].components) continue;
    return InvalidArgument("attribute " + std::to_string(i) + " is " + names[i] + " of the original but " + b[i].name + " of the other surface");
  }
  std::set<uint32_t> groups;
  for (const GroupSurface* surface : {&original, &other}) {
    for (size_t f = 0; f < surface->mesh().surface.triangles.size(); ++f) groups.insert(surface->mesh().GroupOf(f));
  }
  for (const uint32_t group : groups) {
    if (original.HasArea(group) == other.HasArea(group)) continue;
    return InvalidData("group " + std::to_string(group) + " has area on only one of the surfaces");
  }
  return Status();
}

}  // namespace

AttributeError AttributeDistance::Worst(size_t attribute) const {
  const AttributeError &a = forward[attribute], &b = backward[attribute];
  return {std::max(a.rms_99, b.rms_99), std::max(a.rms, b.rms), std::max(a.max, b.max), std::min(a.share, b.share)};
}

AttributeDistanceMeter::AttributeDistanceMeter(std::shared_ptr<const Original> original, std::vector<std::string> names)
    : original_(std::move(original)), names_(std::move(names)) {}

AttributeDistanceMeter AttributeDistanceMeter::WithNames(std::vector<std::string> names) const { return {original_, std::move(names)}; }

StatusOr<AttributeDistanceMeter> AttributeDistanceMeter::Create(AttributedMesh original) {
  LACERTA_RETURN_IF_ERROR(CheckAttributedMesh(original).WithContext("original"));
  auto prepared = std::make_shared<const Original>(std::move(original));
  LACERTA_RETURN_IF_ERROR(CheckArea(prepared->mesh, prepared->surface).WithContext("original"));
  std::vector<std::string> names = NamesOf(prepared->mesh);
  return AttributeDistanceMeter(std::move(prepared), std::move(names));
}

StatusOr<AttributeDistance> AttributeDistanceMeter::Measure(const AttributedMesh& mesh, const AttributeDistanceOptions& options) const {
  constexpr uint64_t kMaxSamples = 1'000'000'000;
  if (options.num_samples < 1 || options.num_samples > kMaxSamples) return InvalidArgument("num_samples must be from 1 to 1e9");
  if (!(options.texture_size > 0) || !(options.seam_distance >= 0)) return InvalidArgument("texture_size must be above 0, seam_distance not below");
  LACERTA_RETURN_IF_ERROR(CheckAttributedMesh(mesh).WithContext("measured mesh"));
  const GroupSurface other(mesh);
  LACERTA_RETURN_IF_ERROR(CheckArea(mesh, other).WithContext("measured mesh"));
  LACERTA_RETURN_IF_ERROR(CheckMatch(original_->surface, names_, other));
  OneSide forward = MeasureOneSide(original_->surface, other, original_->diagonal, options);
  OneSide backward = MeasureOneSide(other, original_->surface, original_->diagonal, options);
  return AttributeDistance{std::move(forward.errors), std::move(backward.errors), forward.turned, backward.turned, forward.swapped, backward.swapped, forward.distance, backward.distance};
}

}  // namespace lacerta
