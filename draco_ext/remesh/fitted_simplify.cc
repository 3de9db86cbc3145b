#include "remesh/fitted_simplify.h"

#include <algorithm>

#include "remesh/edge_flips.h"
#include "remesh/mesh_fit.h"
#include "remesh/mesh_neighbors.h"

namespace lacerta {
namespace {

// Of the size of one step to that before. Smaller ones gain as much, and take longer.
constexpr double kStepRatio = 1 / 1.1;

uint32_t NextStep(uint32_t num_triangles) { return static_cast<uint32_t>(kStepRatio * num_triangles); }

}  // namespace

FittedSimplification::FittedSimplification(const SimplificationSequence& sequence, const Options& options, FitTarget* target)
    : sequence_(sequence), options_(options), target_(target) {}

FittedSimplification::Step FittedSimplification::Fitted(TriangleMesh mesh, uint32_t num_triangles) const {
  constexpr size_t kSamplesPerTriangle = 4;
  constexpr int kRounds = 1;
  target_->Resample(std::clamp(kSamplesPerTriangle * mesh.triangles.size(), options_.fewest_samples, options_.most_samples));
  FitToSurface(*target_, MeshNeighbors(mesh), RateModel(), kRounds, &mesh);
  constexpr double kLatticeShare = 0.28;  // of what the fit is off by: what streams at a target mostly come to
  EdgeFlipper flipper(*target_, &mesh);
  flipper.Flip(RateModel::For(kLatticeShare * flipper.Distortion(), mesh.positions.size()));
  return {num_triangles, SimplificationSequence(mesh, {{}, sequence_.original(), NextStep(num_triangles)})};
}

TriangleMesh FittedSimplification::MeshWith(uint32_t num_triangles) {
  if (!IsOfStep(num_triangles)) return sequence_.MeshWith(num_triangles);
  if (steps_.empty()) steps_.push_back(Fitted(sequence_.MeshWith(options_.largest), options_.largest));
  for (;;) {
    const uint32_t next = NextStep(steps_.back().num_triangles);
    if (next < num_triangles || next == steps_.back().num_triangles) break;
    steps_.push_back(Fitted(steps_.back().sequence.MeshWith(next), next));
  }
  const auto is_large_enough = [&](const Step& step) { return step.num_triangles >= num_triangles; };
  return std::find_if(steps_.rbegin(), steps_.rend(), is_large_enough)->sequence.MeshWith(num_triangles);
}

}  // namespace lacerta
