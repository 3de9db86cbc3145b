#include "draco/attributed_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "draco/for_each_candidate.h"
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

// A ladder of base sizes, from the coarsest that seams allow.
class BaseWalk {
 public:
  BaseWalk(const AttributedSurface& input, const ErrorTargets& targets, const AttributedSearchOptions& options)
      : input_(input), targets_(targets), options_(options), tries_(TriesOf(options.effort)) {
    coarsest_ = std::max(NumVertices() - static_cast<double>(input.history.num_collapses()), 4.0);
    constexpr double kLargestBase = 1.0 / 8;  // of the input's vertices
    last_ = std::max(0, RungOf(kLargestBase * NumVertices()));
  }

  // Downhill on either side of where streams of that quality usually have their base, or of the next size that leads to the targets.
  StatusOr<AttributedTrial> Smallest() const {
    const int usual = std::clamp(RungOf(TypicalBase(Psnr(targets_.distance, input_.meter.diagonal()))), 0, last_);
    int first = usual;
    Visited start = Visit(first, options_.most_bytes);
    while (start.is_too_far && start.may_get_nearer && first < last_) start = Visit(++first, options_.most_bytes);
    constexpr double kHopeless = 1.2;  // times too large: neighboring bases do not save so much
    if (!start.trial && !(start.least_bytes < kHopeless * static_cast<double>(options_.most_bytes))) return start.reason;
    const size_t most_bytes = start.trial ? start.trial->stream.size() : options_.most_bytes;
    std::array<Visited, 2> sides;
    const size_t num_sides = first == usual ? 2 : 1;  // smaller bases are known to be too far else
    ForEachCandidate(NumVertices(), num_sides, [&](size_t side) { sides[side] = Downhill(first, side == 0 ? 1 : -1, most_bytes); });
    Visited* best = &start;
    for (Visited& side : sides) {
      if (side.trial && (!best->trial || side.trial->stream.size() < best->trial->stream.size())) best = &side;
    }
    if (!best->trial) return start.reason;
    return std::move(*best->trial);
  }

 private:
  struct Visited {
    std::optional<AttributedTrial> trial;  // of fewer bytes than was asked for, where the targets are met
    Status reason;                         // else
    bool is_too_far = false, may_get_nearer = true;  // with larger bases
    double least_bytes = std::numeric_limits<double>::infinity();  // of a stream that was too large
  };

  double NumVertices() const { return static_cast<double>(input_.parts.refined.surface.positions.size()); }

  int RungOf(double size) const { return static_cast<int>(std::lround(std::log(std::max(size, 1.0) / coarsest_) / std::log(tries_.size_ratio))); }

  uint32_t RungSize(int rung) const { return static_cast<uint32_t>(std::lround(coarsest_ * std::pow(tries_.size_ratio, rung))); }

  // The smallest of the rungs on that side of `first`, up to the first that is not smaller than all before.
  Visited Downhill(int first, int side, size_t most_bytes) const {
    Visited best;
    for (int rung = first + side; rung >= 0 && rung <= last_; rung += side) {
      Visited next = Visit(rung, most_bytes);
      if (!next.trial) break;
      most_bytes = next.trial->stream.size();
      best = std::move(next);
    }
    return best;
  }

  // A stream of fewer than `most_bytes` bytes with the base of that rung.
  Visited Visit(int rung, size_t most_bytes) const {
    Visited result;
    StatusOr<AttributedTrial> trial = Meet(RungSize(rung), most_bytes, &result.may_get_nearer);
    if (!trial.ok()) {
      result.reason = trial.status();
      result.is_too_far = true;
      return result;
    }
    const double bytes = std::max(trial.value().least_bytes, trial.value().ratio <= 1 ? static_cast<double>(trial.value().stream.size()) : 0.0);
    if (bytes >= static_cast<double>(most_bytes)) {
      result.least_bytes = bytes;
      result.reason = Unsupported("about " + std::to_string(std::lround(bytes)) + " bytes would be needed");
    } else if (trial.value().ratio > 1) {
      result.reason = Unsupported("no precision leads to the targets");
      result.is_too_far = true;
    } else {
      result.trial = std::move(trial).value();
    }
    return result;
  }

  // The smallest stream with a base of that size, and as few levels as lead to the targets.
  StatusOr<AttributedTrial> Meet(uint32_t num_base_vertices, size_t most_bytes, bool* may_get_nearer) const {
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
        meet.most_bytes = most_bytes;
        return candidate.Meet(targets_, meet);
      }
      constexpr double kStuck = 0.9;  // of the error before: more levels do not help
      constexpr double kMostGain = 4;  // of a level: what is linear on triangles is off by squares of their edges
      const double levels_left = std::floor(std::log(most_faces / finest) / std::log(4.0));
      if (ratio > kStuck * before || ratio > std::pow(kMostGain, levels_left)) break;
    }
    // Larger bases change what vertices stand for, but not by orders of magnitude.
    constexpr double kFar = 3;
    *may_get_nearer = WorstRatio(*nearest, targets_) < kFar;
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
