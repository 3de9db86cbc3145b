#include "encoder/layer_split.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/layer_coding.h"
#include "common/stream_layout.h"
#include "encoder/step_law.h"

namespace lacerta {
namespace {

constexpr double kLambdaRatio = 10.0;     // between the slopes of two layers: 6 to 7 dB
constexpr double kRefinementWeight = 3.0;  // of the bits of the refinement: a few percent fewer bytes for some tenths of a dB

// Shifts of a layer at slope `lambda` before one that has the shifts `finer`.
std::vector<std::optional<int>> ShiftsAt(const SurfaceTarget& target, const std::vector<double>& detail_scales, const CodedSurface& coded,
                                         double lambda, std::vector<std::optional<int>> finer) {
  const int last_detailed = LastDetailedLevel(target, detail_scales, lambda);  // later levels have not begun
  const std::vector<LevelSteps> law = StepsForSlope(target, last_detailed, lambda);
  for (size_t i = 0; i < law.size(); ++i) {
    if (!finer[i]) continue;
    if (i >= static_cast<size_t>(last_detailed)) {
      finer[i].reset();
      continue;
    }
    const LevelSteps& last = coded.steps[i];
    const double ratio = last.normal_step > 0 ? law[i].normal_step / last.normal_step : law[i].tangential_step / last.tangential_step;
    int shift = std::clamp(static_cast<int>(std::lround(std::log2(ratio))), *finer[i], kMaxLayerShift);
    while (shift > *finer[i] && !CanShift(last, shift)) --shift;
    finer[i] = shift;
  }
  return finer;
}

// Values on steps 2^drop times larger, halves toward zero.
void Coarsen(int drop, std::vector<int32_t>* values) {
  const int32_t half = drop > 0 ? (1 << (drop - 1)) - 1 : 0;
  for (int32_t& q : *values) q = q < 0 ? -((-q + half) >> drop) : (q + half) >> drop;
}

// The layer with these shifts before `finer`.
QualityLayer LayerBefore(const SurfaceTarget& target, const CodedSurface& coded, const QualityLayer& finer, std::vector<std::optional<int>> shifts,
                         double lambda, int passes) {
  QualityLayer layer{std::move(shifts), finer.surface};
  FinerLayer next{&finer.surface.levels, {}, kRefinementWeight};
  for (size_t i = 0; i < layer.shifts.size(); ++i) {
    QuantizedLevel& level = layer.surface.levels[i];
    LevelSteps& steps = layer.surface.steps[i];
    if (!layer.shifts[i]) {
      std::fill(level.normal.begin(), level.normal.end(), 0);
      std::fill(level.tangential.begin(), level.tangential.end(), 0);
      steps = steps.Silent();
      next.drops.push_back(0);
      continue;
    }
    const int drop = *layer.shifts[i] - *finer.shifts[i];
    Coarsen(drop, &level.normal);
    Coarsen(drop, &level.tangential);
    steps = ShiftedSteps(coded.steps[i], *layer.shifts[i]);
    next.drops.push_back(drop);
  }
  DescentOptions options;
  options.lambda = lambda;
  options.passes = passes;
  options.move_base = false;
  options.finer = &next;
  layer.surface = Descend(target, std::move(layer.surface), options);
  return layer;
}

}  // namespace

std::vector<QualityLayer> SplitIntoLayers(const SurfaceTarget& target, const std::vector<double>& detail_scales, const CodedSurface& coded,
                                          double lambda, int num_layers, int passes) {
  std::vector<QualityLayer> layers = {{{}, coded}};
  for (const LevelSteps& steps : coded.steps) layers[0].shifts.push_back(steps.is_silent() ? std::nullopt : std::optional<int>(0));
  double slope = lambda;
  for (int k = 1; k < num_layers; ++k) {
    slope *= kLambdaRatio;
    std::vector<std::optional<int>> shifts = ShiftsAt(target, detail_scales, coded, slope, layers.back().shifts);
    const bool has_level = std::any_of(shifts.begin(), shifts.end(), [](const std::optional<int>& s) { return s.has_value(); });
    if (!has_level) break;
    if (shifts == layers.back().shifts) continue;
    layers.push_back(LayerBefore(target, coded, layers.back(), std::move(shifts), slope, passes));
  }
  std::reverse(layers.begin(), layers.end());
  return layers;
}

}  // namespace lacerta
