#include "draco/base_shape.h"

#include <tbb/parallel_for.h>

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
#include "remesh/base_domain.h"
#include "remesh/decimate.h"
#include "remesh/piercing.h"

namespace lacerta {
namespace {

// DecimateOptions::aspect_power of the simplifications that are compared.
constexpr std::array<double, 2> kAspectPowers = {1.0, 2.0};
// Sizes of the bases that are looked at, as shares of the typical one: a single size may be a fluke.
constexpr std::array<double, 3> kSizes = {0.6, 1.0, 1.6};
constexpr int kMostLevels = 3;  // finer details hardly depend on the base

double LogDetailBits(const InputSurface& surface, const CollapseHistory& history, double num_base_vertices, double lambda) {
  const double num_vertices = static_cast<double>(surface.mesh().positions.size());
  const double time = std::min<double>(history.num_collapses(), num_vertices - std::min(num_vertices, num_base_vertices));
  const BaseDomain domain(history, static_cast<uint32_t>(time));
  PiercingOptions options;
  const double refinement = std::log(num_vertices / domain.num_vertices()) / std::log(4.0);
  options.num_levels = static_cast<int>(std::clamp<double>(std::floor(refinement), 1, kMostLevels));
  const SurfaceTarget target = MakeSurfaceTarget(Pierce(surface, domain, domain.PositionsOn(surface.mesh()), options));
  return std::log(EstimateDetailBits(target, StepsForSlope(target, DetailScales(target), lambda)) + 1);
}

}  // namespace

CollapseHistory BestShapedHistory(const InputSurface& surface, const Topology& topology, double typical_base, double lambda) {
  std::array<std::optional<CollapseHistory>, kAspectPowers.size()> histories;
  tbb::parallel_for(size_t{0}, histories.size(), [&](size_t h) {
    DecimateOptions options;
    options.aspect_power = kAspectPowers[h];
    histories[h].emplace(Decimate(surface.mesh(), topology, options));
  });
  std::array<double, kAspectPowers.size() * kSizes.size()> bits;
  tbb::parallel_for(size_t{0}, bits.size(), [&](size_t i) {
    bits[i] = LogDetailBits(surface, *histories[i / kSizes.size()], typical_base * kSizes[i % kSizes.size()], lambda);
  });
  size_t best = 0;
  double fewest = std::numeric_limits<double>::infinity();
  for (size_t h = 0; h < histories.size(); ++h) {
    const double sum = std::accumulate(bits.begin() + h * kSizes.size(), bits.begin() + (h + 1) * kSizes.size(), 0.0);
    if (!(sum < fewest)) continue;
    best = h;
    fewest = sum;
  }
  return std::move(*histories[best]);
}

}  // namespace lacerta
