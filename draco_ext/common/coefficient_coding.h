// Coding of the two coefficient sets of one level: one piece of code for encoder, decoder and size measurement, so that
// they cannot drift apart. What is done to a single decision comes from the Coder: RangeEncoder, RangeDecoder, or any other
// class with Code(BitModel&, bool) and CodeEven(bool).
//
// Contexts come from integers only: connectivity tables and coefficients coded before. [Lavu, Choi, Baraniuk 2003] estimate
// a local variance from neighbors and parent in the same spirit; classes and weights are our own (docs/format.md, "Contexts").
#ifndef LACERTA_COMMON_COEFFICIENT_CODING_H_
#define LACERTA_COMMON_COEFFICIENT_CODING_H_

#include <cstdint>
#include <utility>
#include <vector>

#include "common/coefficient_models.h"
#include "common/coefficient_sets.h"
#include "common/subdivision.h"

namespace lacerta {

// What was coded before the level at hand: the models, and what the coarser level lets expect. Empty at the first level.
struct CodingState {
  SetModels normal, tangential1, tangential2;
  // Expected magnitudes in 1/16 of the steps of the coarser level, one per edge of the level to come; empty: nothing known.
  std::vector<uint32_t> normal_forecast, tangential_forecast;
  LevelSteps coarser_steps;
};

// Sums of the coded magnitudes of one set, kept where the next edges look for them. Edges are added in order: 0, 1, ...
class NeighborSums {
 public:
  explicit NeighborSums(const Topology& t)
      : topology_(t), magnitude_(t.num_edges()), vertex_sum_(t.num_vertices), vertex_count_(t.num_vertices) {}

  void Add(uint32_t edge, uint32_t magnitude);
  // Context of `edge`, the next one to be added. forecast: expected magnitude in 1/16.
  CoefficientContext Context(uint32_t edge, uint32_t forecast, bool has_forecast) const;
  const std::vector<uint32_t>& magnitudes() const { return magnitude_; }

 private:
  const Topology& topology_;
  std::vector<uint32_t> magnitude_;     // #E, limited to kMaxCountedMagnitude
  std::vector<uint32_t> vertex_sum_;    // #V, of the magnitudes of the coded edges at a vertex
  std::vector<uint32_t> vertex_count_;  // #V, of those edges
};

// forecast * from / to, where both are steps as RoundStep returns them and > 0; integers only.
uint32_t RescaleForecast(uint32_t forecast, float from, float to);

// What the magnitudes of one level (#E) let expect at each edge of the next finer level (2 #E + 3 #F), in 1/16.
std::vector<uint32_t> ForecastFiner(const Topology& t, const std::vector<uint32_t>& magnitudes);

enum class CoefficientKind { kNormal, kTangential1, kTangential2 };

// Leaves every coefficient as it is.
struct KeepCoefficients {
  void operator()(CoefficientKind, uint32_t, SetModels&, const CoefficientContext&, int32_t*) const {}
};

// Codes one level. t: the level whose edges get new midpoints. quantized: shapes as in QuantizedLevel; an encoding coder
// leaves the coefficients as they are, a decoding coder writes them (all zero on entry). choose(kind, edge, models, context,
// &value) is called right before each coefficient is coded and may change it: an encoder sees there what each value costs.
template <typename Coder, typename Choose = KeepCoefficients>
void CodeLevel(const Topology& t, const LevelSteps& steps, CodingState* state, QuantizedLevel* quantized, Coder* coder,
               const Choose& choose = {}) {
  const uint32_t num_edges = t.num_edges();
  const auto forecast_at = [](const std::vector<uint32_t>& forecast, uint32_t edge, float from, float to) {
    return forecast.empty() ? 0 : RescaleForecast(forecast[edge], from, to);
  };
  std::vector<uint32_t> normal_forecast, tangential_forecast;
  NeighborSums normal_sums(t);
  if (steps.normal_step > 0) {
    for (uint32_t e = 0; e < num_edges; ++e) {
      const uint32_t forecast =
          forecast_at(state->normal_forecast, e, state->coarser_steps.normal_step, steps.normal_step);
      int32_t& q = quantized->normal[e];
      const CoefficientContext context = normal_sums.Context(e, forecast, !state->normal_forecast.empty());
      choose(CoefficientKind::kNormal, e, state->normal, context, &q);
      q = CodeCoefficient(*coder, state->normal, context, q);
      normal_sums.Add(e, Magnitude(q));
    }
    normal_forecast = ForecastFiner(t, normal_sums.magnitudes());
  }
  if (steps.tangential_step > 0) {
    NeighborSums sums(t);
    for (uint32_t e = 0; e < num_edges; ++e) {
      const uint32_t forecast =
          forecast_at(state->tangential_forecast, e, state->coarser_steps.tangential_step, steps.tangential_step);
      CoefficientContext context = sums.Context(e, forecast, !state->tangential_forecast.empty());
      const uint32_t normal = Magnitude(quantized->normal[e]);
      context.companion = normal == 0 ? 0 : normal < 3 ? 1 : 2;
      int32_t& q1 = quantized->tangential[size_t{2} * e];
      int32_t& q2 = quantized->tangential[size_t{2} * e + 1];
      choose(CoefficientKind::kTangential1, e, state->tangential1, context, &q1);
      q1 = CodeCoefficient(*coder, state->tangential1, context, q1);
      const uint32_t m1 = Magnitude(q1);
      context.companion = m1 == 0 ? (normal == 0 ? 0 : 1) : 2;
      choose(CoefficientKind::kTangential2, e, state->tangential2, context, &q2);
      q2 = CodeCoefficient(*coder, state->tangential2, context, q2);
      sums.Add(e, m1 + Magnitude(q2));
    }
    tangential_forecast = ForecastFiner(t, sums.magnitudes());
  }
  state->normal_forecast = std::move(normal_forecast);
  state->tangential_forecast = std::move(tangential_forecast);
  state->coarser_steps = steps;
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_COEFFICIENT_CODING_H_
