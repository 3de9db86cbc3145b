#include "draco/attributed_candidate.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "draco/candidate_search.h"
#include "remesh/level_attributes.h"

namespace lacerta {
namespace {

constexpr uint64_t kRoughSamples = 20'000;

// Ratios to aim at: a hair inside of the targets, and what of that is close enough.
constexpr double kAim = 0.985, kNear = 0.95;

}  // namespace

StatusOr<AttributedCandidate> AttributedCandidate::Create(const AttributedSurface& input, uint32_t num_base_vertices, int num_levels) {
  AttributedRemeshOptions options;
  options.num_base_vertices = num_base_vertices;
  options.num_levels = num_levels;
  LACERTA_ASSIGN_OR_RETURN(AttributedNormalMesh mesh, RemeshAttributed(input.parts, input.surface, input.history, options));
  AttributedSemiRegularMesh levels = mesh.Semiregular();
  FitLevelAttributes(input.original, &levels);
  mesh.attributes = std::move(levels.attributes);
  return AttributedCandidate(input, std::move(mesh));
}

StatusOr<bool> AttributedCandidate::CanMeet(const ErrorTargets& targets) const {
  LACERTA_ASSIGN_OR_RETURN(const SurfaceErrors errors, input_.meter.Measure(FinestLevel(mesh_.Semiregular()), kRoughSamples));
  constexpr double kLeastLeft = 0.93;  // of a target: the rest would cost more than a finer remesh
  return WorstRatio(errors, targets) < kLeastLeft;
}

StatusOr<AttributedTrial> AttributedCandidate::Meet(const ErrorTargets& targets, int tries, uint64_t num_samples) const {
  LACERTA_ASSIGN_OR_RETURN(const SurfaceErrors exact, input_.meter.Measure(FinestLevel(mesh_.Semiregular()), kRoughSamples));
  AttributedStreamOptions options;
  options.lambda = UsualLambda(Psnr(targets.distance, input_.meter.diagonal()), input_.meter.diagonal());
  const size_t num_attributes = mesh_.attributes.size();
  for (size_t a = 0; a < num_attributes; ++a) {
    const double left = std::sqrt(std::max(0.05, 1 - std::pow(exact.attributes[a].rms_99 / targets.attributes[a], 2)));
    const bool is_texture = mesh_.attributes[a].kind == AttributeKind::kTextureCoordinates;
    options.errors.push_back(left * targets.attributes[a] / (is_texture ? input_.meter.texture_size() : 1.0));
  }
  std::optional<AttributedTrial> best;
  for (int i = 0; i < tries; ++i) {
    AttributedTrial trial;
    LACERTA_ASSIGN_OR_RETURN(trial.stream, EncodeAttributedStream(mesh_, options));
    LACERTA_ASSIGN_OR_RETURN(trial.errors, input_.meter.Measure(FinestLevel(trial.stream.decoded), num_samples));
    trial.ratio = WorstRatio(trial.errors, targets);
    const SurfaceErrors errors = trial.errors;
    bool is_near = trial.ratio <= 1;
    // What quantization adds goes with the step; what the remesh has stays.
    const auto change = [&](double found, double remesh, double target) {
      is_near = is_near && found > kNear * target;
      const double fixed = std::min(remesh, 0.9 * target);
      const double added = std::max(found * found - fixed * fixed, 0.01 * target * target);
      return std::clamp((kAim * kAim * target * target - fixed * fixed) / added, 0.05, 20.0);  // of squares
    };
    const double lambda = options.lambda;
    options.lambda *= change(errors.distance, exact.distance, targets.distance);
    for (size_t a = 0; a < num_attributes; ++a) {
      options.errors[a] *= std::sqrt(change(errors.attributes[a].rms_99, exact.attributes[a].rms_99, targets.attributes[a]));
    }
    if (trial.ratio > 1 && 2 * i >= tries) {  // the errors depend on each other: all finer, then
      constexpr double kFiner = 0.6;
      options.lambda = std::min(options.lambda, lambda) * kFiner * kFiner;
      for (double& error : options.errors) error *= kFiner;
    }
    const auto is_better = [&](const AttributedTrial& other) {
      if (trial.ratio <= 1 && other.ratio <= 1) return trial.stream.size() < other.stream.size();
      return trial.ratio < other.ratio;
    };
    if (!best || is_better(*best)) best = std::move(trial);
    if (is_near) break;
  }
  if (!best) return InvalidArgument("no attempt was allowed");
  return std::move(*best);
}

}  // namespace lacerta
