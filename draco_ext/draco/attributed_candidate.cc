#include "draco/attributed_candidate.h"

#include <utility>

#include "draco/precision_search.h"
#include "remesh/level_wedges.h"

namespace lacerta {
namespace {

constexpr uint64_t kRoughSamples = 20'000;

}  // namespace

StatusOr<SurfaceErrors> AttributedSurface::Measure(const AttributedMesh& mesh, uint64_t num_samples) const {
  LACERTA_ASSIGN_OR_RETURN(SurfaceErrors errors, meter.Measure(mesh, num_samples));
  if (meaning.correct) LACERTA_RETURN_IF_ERROR(meaning.correct(mesh, num_samples, &errors));
  return errors;
}

StatusOr<AttributedCandidate> AttributedCandidate::Create(const AttributedSurface& input, uint32_t num_base_vertices, int num_levels) {
  AttributedRemeshOptions options;
  options.num_base_vertices = num_base_vertices;
  options.num_levels = num_levels;
  LACERTA_ASSIGN_OR_RETURN(AttributedNormalMesh mesh, RemeshAttributed(input.parts, input.surface, input.history, options));
  AttributedSemiRegularMesh levels = mesh.Semiregular();
  FitLevelAttributes(input.original, &levels);
  LACERTA_ASSIGN_OR_RETURN(SurfaceErrors errors, input.Measure(FinestLevel(levels), kRoughSamples));
  mesh.attributes = std::move(levels.attributes);
  return AttributedCandidate(input, std::move(mesh), std::move(errors));
}

bool AttributedCandidate::CanMeet(const ErrorTargets& targets) const {
  constexpr double kLeastLeft = 0.93;  // of a target: the rest would cost more than a finer remesh
  return WorstRatio(errors_, targets) < kLeastLeft;
}

StatusOr<AttributedTrial> AttributedCandidate::Meet(const ErrorTargets& targets, const MeetOptions& options) const {
  return SearchPrecisions(mesh_, errors_, input_, targets, options);
}

}  // namespace lacerta
