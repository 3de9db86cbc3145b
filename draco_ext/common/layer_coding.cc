#include "common/layer_coding.h"

#include <algorithm>

#include "common/step_forecast.h"

namespace lacerta {
namespace {

constexpr int kOctave = 128;  // between the codes of a step and of its double

float Shifted(float step, int shift) {
  return step > 0 ? StepFromBits(static_cast<uint16_t>(StepToBits(step) + kOctave * shift)) : 0.0f;
}

}  // namespace

LevelSteps ShiftedSteps(const LevelSteps& steps, int shift) {
  LevelSteps result = steps;
  result.normal_step = Shifted(steps.normal_step, shift);
  result.tangential_step = Shifted(steps.tangential_step, shift);
  return result;
}

bool CanShift(const LevelSteps& steps, int shift) {
  return IsStepBits(StepToBits(std::max(steps.normal_step, steps.tangential_step)) + kOctave * shift);
}

std::vector<Forecast> NormalForecasts(const Topology& t, const LayeredLevel& level) {
  if (!(level.steps.normal_step > 0)) return {};
  CodedNeighbors neighbors(t);
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    if (!t.is_copy(e)) neighbors.Add(e, level.values.normal[e]);
  }
  return neighbors.ForecastFiner();
}

std::vector<Forecast> TangentialForecasts(const Topology& t, const LayeredLevel& level) {
  if (!(level.steps.tangential_step > 0)) return {};
  CodedNeighbors neighbors(t);
  const std::vector<int32_t>& values = level.values.tangential;
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    if (!t.is_copy(e)) neighbors.Add(e, static_cast<int32_t>(Magnitude(values[size_t{2} * e]) + Magnitude(values[size_t{2} * e + 1])));
  }
  return neighbors.ForecastFiner();
}

}  // namespace lacerta
