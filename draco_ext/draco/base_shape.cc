#include "draco/base_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "encoder/step_law.h"
#include "encoder/surface_target.h"
#include "geometry/for_each_branch.h"
#include "remesh/base_domain.h"
#include "remesh/decimate.h"
#include "remesh/piercing.h"

namespace lacerta {
namespace {

// DecimateOptions::aspect_power of the simplifications that are compared.
constexpr std::array<double, 2> kAspectPowers = {1.0, 2.0};
constexpr int kMostLevels = 3;  // finer details hardly depend on the base

double LogDetailBits(const InputSurface& surface, const CollapseHistory& history, double num_base_vertices, double lambda,
                     EncodeMode mode) {
  const double num_vertices = static_cast<double>(surface.mesh().positions.size());
  const double time = std::min<double>(history.num_collapses(), num_vertices - std::min(num_vertices, num_base_vertices));
  const BaseDomain domain(history, static_cast<uint32_t>(time));
  PiercingOptions options;
  const double refinement = std::log(num_vertices / domain.num_vertices()) / std::log(4.0);
  options.num_levels = static_cast<int>(std::clamp<double>(std::floor(refinement), 1, kMostLevels));
  const SurfaceTarget target = MakeSurfaceTarget(Pierce(surface, domain, domain.PositionsOn(surface.mesh()), options));
  std::vector<LevelSteps> steps = StepsForSlope(target, DetailScales(target), lambda);
  for (LevelSteps& s : steps) s.is_curved = s.is_curved && mode == EncodeMode::kDefault;
  return std::log(EstimateDetailBits(target, steps) + 1);
}

}  // namespace

std::vector<CollapseHistory> ShapedHistories(const InputSurface& surface, const Topology& topology) {
  std::array<std::optional<CollapseHistory>, kAspectPowers.size()> made;
  ForEachBranch(made.size(), [&](size_t h) {
    DecimateOptions options;
    options.aspect_power = kAspectPowers[h];
    made[h].emplace(Decimate(surface.mesh(), topology, options));
  });
  std::vector<CollapseHistory> histories;
  histories.reserve(made.size());
  for (std::optional<CollapseHistory>& history : made) histories.push_back(*std::move(history));
  return histories;
}

CollapseHistory BestShapedHistory(const InputSurface& surface, const Topology& topology, double typical_base, double lambda,
                                  EncodeMode mode, const std::vector<double>& sizes) {
  if (sizes.empty()) {
    DecimateOptions options;
    options.aspect_power = kAspectPowers[0];
    return Decimate(surface.mesh(), topology, options);
  }
  std::vector<CollapseHistory> histories = ShapedHistories(surface, topology);
  std::vector<double> bits(histories.size() * sizes.size());
  ForEachBranch(bits.size(), [&](size_t i) {
    bits[i] = LogDetailBits(surface, histories[i / sizes.size()], typical_base * sizes[i % sizes.size()], lambda, mode);
  });
  size_t best = 0;
  double fewest = std::numeric_limits<double>::infinity();
  for (size_t h = 0; h < histories.size(); ++h) {
    const auto first = bits.begin() + static_cast<std::ptrdiff_t>(h * sizes.size());
    const double sum = std::accumulate(first, first + static_cast<std::ptrdiff_t>(sizes.size()), 0.0);
    if (!(sum < fewest)) continue;
    best = h;
    fewest = sum;
  }
  return std::move(histories[best]);
}

}  // namespace lacerta
