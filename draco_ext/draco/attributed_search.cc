#include "draco/attributed_search.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "draco/rate_control.h"
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
    const double psnr = Psnr(targets_.distance, input_.meter.diagonal());
    int first = std::clamp(RungOf(TypicalBase(psnr)), 0, last_);
    while (first <= last_ && !Visit(first)) ++first;
    for (int r = first + 1; r <= last_ && Visit(r); ++r) {
    }
    for (int r = first - 1; r >= 0 && visited_.count(r) == 0 && Visit(r); --r) {
    }
    if (!best_) return reason_.ok() ? Unsupported("no base leads to the targets") : reason_;
    return std::move(*best_);
  }

 private:
  int RungOf(double size) const { return static_cast<int>(std::lround(std::log(std::max(size, 1.0) / coarsest_) / std::log(tries_.size_ratio))); }

  // Whether the smallest stream so far has the base of this rung.
  bool Visit(int rung) {
    visited_[rung] = true;
    const StatusOr<AttributedTrial> trial = Meet(static_cast<uint32_t>(std::lround(coarsest_ * std::pow(tries_.size_ratio, rung))));
    if (!trial.ok()) {
      reason_ = trial.status();
      return false;
    }
    if (trial.value().ratio > 1) {
      reason_ = Unsupported("no precision leads to the targets");
      return false;
    }
    if (trial.value().stream.size() >= MostBytes()) {
      reason_ = Unsupported(std::to_string(trial.value().stream.size()) + " bytes would be needed");
      return false;
    }
    best_ = trial.value();
    return true;
  }

  size_t MostBytes() const { return best_ ? std::min(options_.most_bytes, best_->stream.size()) : options_.most_bytes; }

  // The smallest stream with a base of that size; as many levels as bring it to the size of the input, or one more.
  StatusOr<AttributedTrial> Meet(uint32_t num_base_vertices) const {
    const double num_faces = static_cast<double>(input_.parts.refined.surface.triangles.size());
    constexpr double kMostFaces = 8;  // as a multiple of the input's
    int levels = 1;
    double finest = 8.0 * num_base_vertices;
    for (; finest < num_faces; finest *= 4) ++levels;
    std::optional<SurfaceErrors> nearest;
    for (; levels == 1 || finest <= kMostFaces * num_faces; ++levels, finest *= 4) {
      LACERTA_ASSIGN_OR_RETURN(const AttributedCandidate candidate, AttributedCandidate::Create(input_, num_base_vertices, levels));
      nearest = candidate.errors();
      if (!candidate.CanMeet(targets_)) continue;
      MeetOptions meet;
      meet.first_tries = tries_.first;
      meet.finer_tries = tries_.finer;
      meet.num_samples = options_.num_samples;
      meet.most_bytes = MostBytes();
      return candidate.Meet(targets_, meet);
    }
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
    consider(errors.turned / targets_.turned, "turned triangles");
    for (size_t a = 0; a < errors.attributes.size(); ++a) {
      consider(errors.attributes[a].rms_99 / targets_.attributes[a], input_.original.attributes[a].name);
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
  std::map<int, bool> visited_;
  Status reason_;  // why the last rung gave nothing
  std::optional<AttributedTrial> best_;
};

}  // namespace

StatusOr<AttributedTrial> SmallestAttributedStream(const AttributedMesh& mesh, const SurfaceErrorMeter& meter, const ErrorTargets& targets,
                                                   const AttributedSearchOptions& options) {
  if (targets.attributes.size() != mesh.attributes.size()) return InvalidArgument("there is not one target for each attribute");
  LACERTA_ASSIGN_OR_RETURN(AttributedParts parts, SplitAttributedSurface(mesh));
  LACERTA_ASSIGN_OR_RETURN(const CollapseHistory history, DecimateAttributed(parts));
  LACERTA_RETURN_IF_ERROR(SimplifyStill(targets, meter.texture_size(), &parts));
  const InputSurface surface(parts.refined.surface, parts.topology);
  const AttributedSurface input{mesh, meter, parts, surface, history};
  return BaseWalk(input, targets, options).Smallest();
}

}  // namespace lacerta
