#include "remesh/surface_errors.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "geometry/facing.h"
#include "geometry/measured_surface.h"
#include "geometry/vertex_area_vectors.h"

namespace lacerta {
namespace {

bool HasSeveralGroups(const AttributedMesh& mesh) {
  return std::any_of(mesh.groups.begin(), mesh.groups.end(), [&](uint32_t group) { return group != mesh.groups.front(); });
}

}  // namespace

double RangeOf(const MeshAttribute& attribute) {
  double range = 0;
  for (uint32_t c = 0; c < attribute.components; ++c) {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (size_t i = c; i < attribute.values.size(); i += attribute.components) {
      low = std::min(low, attribute.values[i]);
      high = std::max(high, attribute.values[i]);
    }
    range = std::max(range, static_cast<double>(high) - static_cast<double>(low));
  }
  return range;
}

double AttributeRatio(const SurfaceErrors& errors, const ErrorTargets& targets, size_t attribute) {
  const double ratio = errors.attributes[attribute].rms_99 / targets.attributes[attribute];
  return targets.everywhere.empty() ? ratio : std::max(ratio, errors.attributes[attribute].rms / targets.everywhere[attribute]);
}

std::vector<double> AttributeShares(const AttributedMesh& mesh) {
  std::vector<double> areas(mesh.attributes.size(), 0.0);
  double all = 0;
  for (size_t f = 0; f < mesh.surface.triangles.size(); ++f) {
    const double area = Norm(AreaVector(mesh.surface.positions, mesh.surface.triangles[f]));
    all += area;
    for (size_t i = 0; i < areas.size(); ++i) areas[i] += mesh.attributes[i].corners[f][0] != MeshAttribute::kNoValue ? area : 0;
  }
  for (double& area : areas) area = all > 0 && area > 0 ? area / all : 1;
  return areas;
}

ErrorTargets TargetsFor(const AttributedMesh& mesh, double distance, double texels, double degrees) {
  ErrorTargets targets;
  targets.distance = distance;
  for (const MeshAttribute& attribute : mesh.attributes) {
    switch (attribute.kind) {
      case AttributeKind::kTextureCoordinates:
        targets.attributes.push_back(texels);
        break;
      case AttributeKind::kNormal:
      case AttributeKind::kTangent:
        targets.attributes.push_back(degrees);
        break;
      case AttributeKind::kColor:
      case AttributeKind::kWeights:
        targets.attributes.push_back(1.0 / 256);
        break;
      case AttributeKind::kGeneric:
        targets.attributes.push_back(std::max(1e-3 * RangeOf(attribute), 1e-12));
        break;
    }
  }
  return targets;
}

double WorstRatio(const SurfaceErrors& errors, const ErrorTargets& targets) {
  double worst = std::max(errors.distance / targets.distance, errors.MostTurned() / targets.turned);
  for (size_t a = 0; a < targets.attributes.size(); ++a) worst = std::max(worst, AttributeRatio(errors, targets, a));
  return worst;
}

StatusOr<SurfaceErrorMeter> SurfaceErrorMeter::Create(const AttributedMesh& original, double texture_size) {
  const double diagonal = BoundingBoxDiagonal(original.surface);
  LACERTA_RETURN_IF_ERROR(CheckDiagonal(diagonal).WithContext("original"));
  std::optional<SurfaceDistanceMeter> distance;
  if (HasSeveralGroups(original)) {
    LACERTA_ASSIGN_OR_RETURN(distance, SurfaceDistanceMeter::Create(original.surface));
  }
  LACERTA_ASSIGN_OR_RETURN(AttributeDistanceMeter attributes, AttributeDistanceMeter::Create(original));
  constexpr uint64_t kFewest = 10'000, kPerTriangle = 16;  // small parts have no more to tell
  const uint64_t most_samples = std::max(kFewest, kPerTriangle * original.surface.triangles.size());
  const std::vector<double> shares = AttributeShares(original);
  const double least_share = shares.empty() ? 1.0 : *std::min_element(shares.begin(), shares.end());
  return SurfaceErrorMeter(std::move(distance), std::move(attributes), diagonal, texture_size, most_samples,
                           ShareAgainstNormals(original), least_share);
}

SurfaceErrorMeter SurfaceErrorMeter::WithNames(std::vector<std::string> names) const {
  SurfaceErrorMeter renamed = *this;
  renamed.attributes_ = attributes_.WithNames(std::move(names));
  return renamed;
}

StatusOr<SurfaceErrors> SurfaceErrorMeter::Measure(const AttributedMesh& mesh, uint64_t num_samples) const {
  // What only a part of the surface has must not be told by a handful of samples.
  constexpr double kFewest = 3000, kMost = 50'000;
  num_samples = std::min(std::max(num_samples, static_cast<uint64_t>(std::min(kFewest / least_share_, kMost))), most_samples_);
  AttributeDistanceOptions options;
  options.num_samples = num_samples;
  options.texture_size = texture_size_;
  LACERTA_ASSIGN_OR_RETURN(const AttributeDistance attributes, attributes_.Measure(mesh, options));
  double distance = std::max(attributes.forward_distance, attributes.backward_distance);
  if (distance_) {
    LACERTA_ASSIGN_OR_RETURN(const SurfaceDistance across_groups, distance_->Measure(mesh.surface, SurfaceDistanceOptions::RmsOnly(num_samples)));
    distance = across_groups.Rms();
  }
  SurfaceErrors errors{distance, {}, attributes.backward_turned, std::max(ShareAgainstNormals(mesh) - against_normals_, 0.0), attributes.forward_swapped};
  for (size_t a = 0; a < attributes.forward.size(); ++a) errors.attributes.push_back(attributes.Worst(a));
  return errors;
}

}  // namespace lacerta
