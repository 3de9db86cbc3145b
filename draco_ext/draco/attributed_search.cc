#include "draco/attributed_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "draco/rate_control.h"
#include "remesh/agreeing_faces.h"
#include "remesh/attributed_still.h"

namespace lacerta {
namespace {

struct SearchTries {
  double size_ratio;  // between neighboring bases
  int first, finer;   // as in MeetOptions
};

SearchTries TriesOf(Effort effort) {
  switch (effort) {
    case Effort::kFast: return {2.25, 4, 1};
    case Effort::kNormal: return {1.6, 6, 3};
    case Effort::kBest: return {1.3, 8, 6};
  }
  return {1.6, 6, 3};
}

enum class Found { kSmaller, kTooLarge, kTooFar };

// A ladder of base sizes, from the coarsest that seams allow.
class BaseWalk {
 public:
  BaseWalk(const AttributedSurface& input, const ErrorTargets& targets, const AttributedSearchOptions& options)
      : input_(input), targets_(targets), options_(options), tries_(TriesOf(options.effort)) {
    const double num_vertices = static_cast<double>(input.parts.refined.surface.positions.size());
    coarsest_ = std::max(num_vertices - static_cast<double>(input.history.num_collapses()), 4.0);
    constexpr double kLargestBase = 1.0 / 8;  // of the input's vertices
    last_ = std::max(0, RungOf(kLargestBase * num_vertices));
  }

  StatusOr<AttributedTrial> Smallest() {
    int first = std::clamp(RungOf(TypicalBase(Psnr(targets_.distance, input_.meter.diagonal()))), 0, last_);
    while (Visit(first) == Found::kTooFar && first < last_ && may_get_nearer_) ++first;
    const bool is_near = best_ || least_bytes_ < kHopeless * static_cast<double>(options_.most_bytes);
    if (is_near) {
      for (int r = first + 1; r <= last_ && Visit(r) == Found::kSmaller; ++r) {
      }
      for (int r = first - 1; r >= 0 && visited_.count(r) == 0 && Visit(r) == Found::kSmaller; --r) {
      }
    }
    if (!best_) return reason_;
    return std::move(*best_);
  }

 private:
  static constexpr double kHopeless = 1.2;  // times too large: neighboring bases do not save so much

  int RungOf(double size) const { return static_cast<int>(std::lround(std::log(std::max(size, 1.0) / coarsest_) / std::log(tries_.size_ratio))); }

  // Whether the smallest stream so far has the base of this rung.
  Found Visit(int rung) {
    visited_.insert(rung);
    StatusOr<AttributedTrial> trial = Meet(static_cast<uint32_t>(std::lround(coarsest_ * std::pow(tries_.size_ratio, rung))));
    if (!trial.ok()) {
      reason_ = trial.status();
      return Found::kTooFar;
    }
    const double bytes = std::max(trial.value().least_bytes, trial.value().ratio <= 1 ? static_cast<double>(trial.value().stream.size()) : 0.0);
    if (bytes >= static_cast<double>(MostBytes())) {
      least_bytes_ = std::min(least_bytes_, bytes);
      reason_ = Unsupported("about " + std::to_string(std::lround(bytes)) + " bytes would be needed");
      return Found::kTooLarge;
    }
    if (trial.value().ratio > 1) {
      reason_ = Unsupported("no precision leads to the targets");
      return Found::kTooFar;
    }
    best_ = std::move(trial).value();
    return Found::kSmaller;
  }

  size_t MostBytes() const { return best_ ? std::min(options_.most_bytes, best_->stream.size()) : options_.most_bytes; }

  // The smallest stream with a base of that size, and as few levels as lead to the targets.
  StatusOr<AttributedTrial> Meet(uint32_t num_base_vertices) {
    const double num_faces = static_cast<double>(input_.parts.refined.surface.triangles.size());
    // Of the finest level, as multiples of the input's; small inputs may need rounder surfaces, large ones would fill the memory for nothing.
    constexpr double kFewestFaces = 0.4, kLeastMost = 2, kMostFaces = 8, kMany = 2e6;
    const double most_faces = std::max(kLeastMost * num_faces, std::min(kMostFaces * num_faces, kMany));
    int levels = 1;
    double finest = 8.0 * num_base_vertices;
    for (; finest < kFewestFaces * num_faces; finest *= 4) ++levels;
    std::optional<SurfaceErrors> nearest;
    for (; !nearest || finest <= most_faces; ++levels, finest *= 4) {
      LACERTA_ASSIGN_OR_RETURN(const AttributedCandidate candidate, AttributedCandidate::Create(input_, num_base_vertices, levels));
      const double before = nearest ? WorstRatio(*nearest, targets_) : std::numeric_limits<double>::infinity();
      nearest = candidate.errors();
      const double ratio = WorstRatio(*nearest, targets_);
      if (candidate.CanMeet(targets_)) {
        MeetOptions meet;
        meet.first_tries = tries_.first;
        meet.finer_tries = tries_.finer;
        meet.num_samples = options_.num_samples;
        meet.most_bytes = MostBytes();
        return candidate.Meet(targets_, meet);
      }
      constexpr double kStuck = 0.9;  // of the error before: more levels do not help
      if (ratio > kStuck * before) break;
    }
    // Larger bases change what vertices stand for, but not by orders of magnitude.
    constexpr double kFar = 3;
    may_get_nearer_ = WorstRatio(*nearest, targets_) < kFar;
    return Unsupported(WhatIsFar(*nearest));
  }

  std::string WhatIsFar(const SurfaceErrors& errors) const {
    double worst = errors.distance / targets_.distance;
    std::string what = "positions";
    const auto consider = [&](double ratio, const std::string& name) {
      if (ratio <= worst) return;
      worst = ratio;
      what = name;
    };
    consider(errors.MostTurned() / targets_.turned, "turned triangles");
    for (size_t a = 0; a < errors.attributes.size(); ++a) {
      consider(errors.attributes[a].rms_99 / targets_.attributes[a], input_.original.mesh().attributes[a].name);
    }
    const std::string times = std::to_string(worst);
    return "no base leads to the targets: the last remesh has " + times.substr(0, times.find('.') + 3) + " times the error of " + what + " allowed";
  }

  const AttributedSurface& input_;
  const ErrorTargets& targets_;
  const AttributedSearchOptions& options_;
  const SearchTries tries_;
  double coarsest_;
  int last_;
  std::set<int> visited_;
  Status reason_;  // why the last rung gave nothing
  bool may_get_nearer_ = true;  // where the last rung was too far
  double least_bytes_ = std::numeric_limits<double>::infinity();  // of streams that were too large
  std::optional<AttributedTrial> best_;
};

// Stock Draco takes more for a triangle at any precision worth naming: its corners' integers, half a vertex each, and the connectivity.
size_t LeastBytesOfBase(size_t num_triangles, const AttributedMesh& mesh) { return num_triangles * (1 + mesh.attributes.size()); }

}  // namespace

StatusOr<AttributedTrial> SmallestAttributedStream(const AttributedMesh& mesh, const SurfaceErrorMeter& meter, const ErrorTargets& targets,
                                                   const AttributedSearchOptions& options) {
  if (targets.attributes.size() != mesh.attributes.size()) return InvalidArgument("there is not one target for each attribute");
  constexpr double kTurnedShare = 0.5;  // of the area that may look the other way: the rest is for levels
  const std::optional<AgreeingSurface> agreeing = TurnToAgree(mesh);
  const bool is_turned = agreeing && agreeing->turned_share <= kTurnedShare * targets.turned;
  const AttributedMesh& input = is_turned ? agreeing->mesh : mesh;
  LACERTA_ASSIGN_OR_RETURN(AttributedParts parts, SplitAttributedSurface(input));
  LACERTA_ASSIGN_OR_RETURN(const CollapseHistory history, DecimateAttributed(parts));
  const size_t coarsest = history.FacesAt(history.num_collapses()).size();
  if (LeastBytesOfBase(coarsest, input) >= options.most_bytes) return Unsupported("its seams and creases leave no coarse base");
  LACERTA_RETURN_IF_ERROR(SimplifyStill(targets, meter.texture_size(), &parts));
  if (LeastBytesOfBase(coarsest + parts.still.surface.triangles.size(), input) >= options.most_bytes) return Unsupported("most of it are small parts");
  const InputSurface surface(parts.refined.surface, parts.topology);
  const GroupSurface original(input);
  const AttributedSurface whole{original, meter, parts, surface, history, options.meaning};
  return BaseWalk(whole, targets, options).Smallest();
}

}  // namespace lacerta
