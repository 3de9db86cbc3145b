// Coding of the residuals of one attribute on one level, with the contexts of normal coefficients (common/coefficient_coding.h) on its
// wedge mesh. One piece of code for encoder, decoder and size measurement. Specified in docs/format.md, "Residuals of attributes".
#ifndef LACERTA_COMMON_ATTRIBUTE_CODING_H_
#define LACERTA_COMMON_ATTRIBUTE_CODING_H_

#include <cstdint>
#include <utility>
#include <vector>

#include "common/coefficient_coding.h"
#include "common/coefficient_models.h"
#include "common/subdivision.h"

namespace lacerta {

// What was coded of an attribute before the level at hand.
struct AttributeCodingState {
  explicit AttributeCodingState(uint32_t coded_components) : models(coded_components, SetModels(kNormalPriors, Companions::kAlike)), forecasts(coded_components) {}

  std::vector<SetModels> models;                 // of each component
  std::vector<std::vector<Forecast>> forecasts;  // of each component, #E or empty
  float coarser_step = 0;
};

// Leaves every residual as it is.
struct KeepResiduals {
  void operator()(uint32_t, uint32_t, SetModels&, const CoefficientContext&, int32_t*) const {}
};

// Codes one level. step: > 0, or nothing is coded. residuals: as in AddResiduals; an encoding coder leaves them as they are, a decoding
// coder writes them (all zero on entry). continues: a finer level wants forecasts. choose(component, edge, models, context, &value) may change a
// residual right before it is coded.
template <typename Coder, typename Choose = KeepResiduals>
void CodeAttributeLevel(const Topology& t, float step, bool continues, AttributeCodingState* state, std::vector<int32_t>* residuals,
                        Coder* coder, const Choose& choose = {}) {
  const std::vector<std::vector<Forecast>> forecasts = std::exchange(state->forecasts, std::vector<std::vector<Forecast>>(state->models.size()));
  const float coarser_step = std::exchange(state->coarser_step, step);
  if (!(step > 0)) return;
  const ForecastScale scale(coarser_step, step);
  for (uint32_t c = 0; c < state->models.size(); ++c) {
    int32_t* const values = residuals->data() + size_t{c} * t.num_edges();
    CodedNeighbors neighbors(t);
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      const bool foretold = !forecasts[c].empty();
      const Forecast forecast = foretold ? scale(forecasts[c][e]) : Forecast();
      CoefficientContext context = neighbors.ContextOf(e, foretold ? &forecast : nullptr);
      const uint32_t before = c > 0 ? Magnitude((values - t.num_edges())[e]) : 0;  // of the component before
      context.companion = (t.is_border(e) ? kCurveCompanion : 0) + (before == 0 ? 0 : before < 3 ? 1 : 2);
      choose(c, e, state->models[c], context, &values[e]);
      values[e] = CodeCoefficient(*coder, state->models[c], context, values[e]);
      neighbors.Add(e, values[e]);
    }
    if (continues) state->forecasts[c] = neighbors.ForecastFiner();
  }
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_ATTRIBUTE_CODING_H_
