// Coding of the two coefficient sets of one level: one piece of code for encoder, decoder and size measurement, so that
// they cannot drift apart. What is done to a single decision comes from the Coder: RangeEncoder, RangeDecoder, or any
// other class with Code(BitModel&, bool) and CodeEven(bool).
//
// Contexts come from integers only: connectivity tables and coefficients coded before. [Lavu, Choi, Baraniuk 2003]
// estimate a local variance from neighbors and parent in the same spirit; classes and weights are our own
// (docs/format.md, "Contexts").
#ifndef LACERTA_COMMON_COEFFICIENT_CODING_H_
#define LACERTA_COMMON_COEFFICIENT_CODING_H_

#include <cstdint>
#include <utility>
#include <vector>

#include "common/coefficient_models.h"
#include "common/coefficient_sets.h"
#include "common/subdivision.h"

namespace lacerta {

// What the coarser level lets expect at an edge.
struct Forecast {
  uint32_t magnitude = 0;  // in 1/16 of the coarser level's step
  int32_t sign = 0;        // of the parent coefficient: -1, 0, 1
};

// What was coded before the level at hand: models, and forecasts for its edges (empty: nothing was coded one level up).
struct CodingState {
  SetModels normal{kNormalPriors}, tangential1{kTangentialPriors}, tangential2{kTangentialPriors};
  std::vector<Forecast> normal_forecasts, tangential_forecasts;  // #E each
  std::vector<uint8_t> length_classes;  // #E, of LengthClasses for the base, handed on with normal forecasts; empty: all usual
  LevelSteps coarser_steps;
  bool normal_continues = true, tangential_continues = true;  // false: no finer level wants forecasts
};

// What edges hand on to those of the next finer level (2 #E + 3 #F): to their halves, and to the inner edges parallel to them.
template <typename T>
std::vector<T> HandDown(const Topology& t, const std::vector<T>& parents) {
  std::vector<T> finer(2 * parents.size() + size_t{3} * t.num_faces());
  auto next = finer.begin();
  for (const T& parent : parents) {
    *next++ = parent;
    *next++ = parent;
  }
  // An inner edge cuts off corner k and runs parallel to the edge opposite to it.
  for (const auto& edges : t.face_edges) {
    for (const uint32_t e : edges) *next++ = parents[e];
  }
  return finer;
}

// The coded coefficients of one set, summed where the next edges look for them. Edges are added in order: 0, 1, ... but for
// copies, which have none.
class CodedNeighbors {
 public:
  explicit CodedNeighbors(const Topology& t)
      : topology_(t), has_copies_(!t.master.empty()), values_(t.num_edges()), around_(t.num_vertices) {}

  // Adds a coefficient; magnitudes over 4,096 count as 4,096.
  void Add(uint32_t edge, int32_t value) {
    const auto& [a, b] = topology_.edges[edge];
    ++around_[a].count;
    ++around_[b].count;
    if (value != 0) AddNonzero(edge, value);
  }
  // Context of `edge`, the next one to be added. forecast: null where nothing is known; its magnitude in 1/16 of the
  // step of this level.
  CoefficientContext ContextOf(uint32_t edge, const Forecast* forecast) const {
    // Most of a fine level: nothing but zeros around both ends, where the other edges of both faces are, too.
    const auto& [a, b] = topology_.edges[edge];
    if ((around_[a].sum | around_[b].sum) != 0 || (forecast != nullptr && forecast->magnitude != 0)) {
      return ContextAmongNonzero(edge, forecast);
    }
    return MakeContext(0, forecast != nullptr ? forecast->sign : 0);
  }
  // For every edge of the next finer level (2 #E + 3 #F) what these coefficients (all added) let expect.
  std::vector<Forecast> ForecastFiner() const;

 private:
  // The coded edges at a vertex: their magnitudes summed, and how many they are.
  struct Around {
    uint32_t sum = 0, count = 0;
  };

  void AddNonzero(uint32_t edge, int32_t value);
  CoefficientContext ContextAmongNonzero(uint32_t edge, const Forecast* forecast) const;
  // sign: what is expected, negative or positive, and how strongly.
  static CoefficientContext MakeContext(int activity, int32_t sign) {
    CoefficientContext context;
    context.activity = activity;
    context.sign_class = static_cast<int>(Magnitude(sign));
    context.expect_negative = sign < 0;
    return context;
  }

  const Topology& topology_;
  const bool has_copies_;
  std::vector<int32_t> values_;  // #E
  std::vector<Around> around_;   // #V
};

// Turns forecasts of the coarser level, in steps `from`, into forecasts in steps `to`: integers only. Both steps are > 0
// and as RoundStep returns them.
class ForecastScale {
 public:
  ForecastScale(float from, float to);
  Forecast operator()(const Forecast& forecast) const {
    return forecast.magnitude == 0 ? forecast : Scaled(forecast);  // zero: most of a fine level
  }

 private:
  Forecast Scaled(const Forecast& forecast) const;

  uint32_t from_significand_, to_significand_;
  int up_;  // the quotient of the powers of two, as an exponent
};

enum class CoefficientKind { kNormal, kTangential1, kTangential2 };

// Leaves every coefficient as it is.
struct KeepCoefficients {
  void operator()(CoefficientKind, uint32_t, SetModels&, const CoefficientContext&, int32_t*) const {}
};

// Codes the normal set of one level; see CodeLevel.
template <typename Coder, typename Choose>
void CodeNormalSet(const Topology& t, float step, CodingState* state, std::vector<int32_t>* set, Coder* coder,
                   const Choose& choose) {
  const std::vector<Forecast> forecasts = std::move(state->normal_forecasts);
  const std::vector<uint8_t> length_classes = std::move(state->length_classes);
  state->normal_forecasts.clear();
  state->length_classes.clear();
  if (!(step > 0)) return;
  const ForecastScale scale(state->coarser_steps.normal_step, step);
  CodedNeighbors neighbors(t);
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    if (t.is_copy(e)) continue;
    const Forecast forecast = forecasts.empty() ? Forecast() : scale(forecasts[e]);
    CoefficientContext context = neighbors.ContextOf(e, forecasts.empty() ? nullptr : &forecast);
    context.companion = (length_classes.empty() ? 0 : length_classes[e]) + (t.on_curve[e] != 0 ? kCurveCompanion : 0);
    int32_t& q = (*set)[e];
    choose(CoefficientKind::kNormal, e, state->normal, context, &q);
    q = CodeCoefficient(*coder, state->normal, context, q);
    neighbors.Add(e, q);
  }
  if (!state->normal_continues) return;
  state->normal_forecasts = neighbors.ForecastFiner();
  if (!length_classes.empty()) state->length_classes = HandDown(t, length_classes);
}

// Codes the tangential set of one level after the normal one; see CodeLevel. For the neighbors an edge counts with the
// sum of its two magnitudes. Signs have no context.
template <typename Coder, typename Choose>
void CodeTangentialSet(const Topology& t, float step, const std::vector<int32_t>& normal, CodingState* state,
                       std::vector<int32_t>* set, Coder* coder, const Choose& choose) {
  const std::vector<Forecast> forecasts = std::move(state->tangential_forecasts);
  state->tangential_forecasts.clear();
  if (!(step > 0)) return;
  const ForecastScale scale(state->coarser_steps.tangential_step, step);
  CodedNeighbors neighbors(t);
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    if (t.is_copy(e)) continue;
    const Forecast forecast = forecasts.empty() ? Forecast() : scale(forecasts[e]);
    CoefficientContext context = neighbors.ContextOf(e, forecasts.empty() ? nullptr : &forecast);
    context.sign_class = 0;
    context.expect_negative = false;
    int32_t& q1 = (*set)[size_t{2} * e];
    int32_t& q2 = (*set)[size_t{2} * e + 1];
    const uint32_t normal_magnitude = Magnitude(normal[e]);
    const int curve = t.on_curve[e] != 0 ? kCurveCompanion : 0;
    context.companion = curve + (normal_magnitude == 0 ? 0 : normal_magnitude < 3 ? 1 : 2);
    choose(CoefficientKind::kTangential1, e, state->tangential1, context, &q1);
    q1 = CodeCoefficient(*coder, state->tangential1, context, q1);
    context.companion = curve + (q1 != 0 ? 2 : normal_magnitude != 0 ? 1 : 0);
    choose(CoefficientKind::kTangential2, e, state->tangential2, context, &q2);
    q2 = CodeCoefficient(*coder, state->tangential2, context, q2);
    neighbors.Add(e, static_cast<int32_t>(Magnitude(q1) + Magnitude(q2)));
  }
  if (state->tangential_continues) state->tangential_forecasts = neighbors.ForecastFiner();
}

// Codes one level. t: the level whose edges get new midpoints. quantized: shapes as in QuantizedLevel; an encoding
// coder leaves the coefficients as they are, a decoding coder writes them (all zero on entry); on a silent level it may be empty. choose(kind, edge,
// models, context, &value) is called right before each coefficient is coded and may change it: an encoder sees there
// what each value costs. Copies (Topology::is_copy) have no coefficients: theirs are left alone, and count as zero.
template <typename Coder, typename Choose = KeepCoefficients>
void CodeLevel(const Topology& t, const LevelSteps& steps, CodingState* state, QuantizedLevel* quantized, Coder* coder,
               const Choose& choose = {}) {
  CodeNormalSet(t, steps.normal_step, state, &quantized->normal, coder, choose);
  CodeTangentialSet(t, steps.tangential_step, quantized->normal, state, &quantized->tangential, coder, choose);
  state->coarser_steps = steps;
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_COEFFICIENT_CODING_H_
