// Coding of a stream with quality layers: the coefficients of a level come in several segments, each on steps that a power of two
// divides (nested quantizers). The first segment of a level is coded as in a stream of one layer (common/coefficient_coding.h);
// a later one turns values of larger steps into values of smaller ones. Specified in docs/format.md, "Layers".
#ifndef LACERTA_COMMON_LAYER_CODING_H_
#define LACERTA_COMMON_LAYER_CODING_H_

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/coefficient_coding.h"
#include "common/stream_layout.h"

namespace lacerta {

// Models of what refines one set: coefficients that are zero so far, and the others.
struct RefinementModels {
  explicit RefinementModels(const SetPriors& priors, Companions companions = Companions::kApart) : zero(priors, companions) {}
  SetModels zero, told;
};

// A level as far as it has come.
struct LayeredLevel {
  bool has_begun = false;
  int shift = 0;            // its steps are 2^shift times those of the header
  LevelSteps steps;         // in use now
  QuantizedLevel values;    // shapes as in QuantizedLevel
  RefinementModels normal{kNormalPriors, Companions::kAlike}, tangential1{kTangentialPriors}, tangential2{kTangentialPriors};
};

struct LayerState {
  CodingState first;                 // models of first segments; they live on from level to level
  std::vector<LayeredLevel> levels;  // of levels 1, 2, ...
};

// Steps times 2^shift, and whether these are steps that a stream can have.
LevelSteps ShiftedSteps(const LevelSteps& steps, int shift);
bool CanShift(const LevelSteps& steps, int shift);

// What the values of a level let expect of the edges of the next finer one: none where its set has no step.
std::vector<Forecast> NormalForecasts(const Topology& t, const LayeredLevel& level);
std::vector<Forecast> TangentialForecasts(const Topology& t, const LayeredLevel& level);

// Edges in the faces of `edge`, but itself, whose coefficient is not zero: 0, 1, or 2 for more.
inline int NonzeroAround(const Topology& t, const std::vector<int32_t>& values, uint32_t edge) {
  int count = 0;
  for (const uint32_t face : t.edge_faces[edge]) {
    if (face == kNone) continue;
    for (const uint32_t side : t.face_edges[face]) count += side != edge && values[side] != 0;
  }
  return count < 2 ? count : 2;
}

// Codes one coefficient that was `known` on steps 2^shift times larger; returns it. context: as if nothing were known.
template <typename Coder>
int32_t CodeRefined(Coder& coder, RefinementModels& models, CoefficientContext context, int32_t known, int shift, int32_t value) {
  if (known == 0) return CodeCoefficient(coder, models.zero, context, value);
  const uint32_t magnitude = Magnitude(known);
  context.activity = shift;
  context.companion = magnitude < 3 ? static_cast<int>(magnitude) - 1 : 2;
  context.sign_class = magnitude == 1 ? 1 : 2;
  context.expect_negative = known < 0;
  const int32_t expected = known * (1 << shift);
  return expected + CodeCoefficient(coder, models.told, context, value - expected);
}

// Codes a later segment of a level, by `drop` bits.
//   normal, tangential  forecasts of the coarser level (may be empty) in steps `coarser`
//   values              on return, or for an encoding coder on entry: on the new steps
template <typename Coder>
void CodeRefinement(const Topology& t, const LevelSteps& steps, int drop, const std::vector<Forecast>& normal, const std::vector<Forecast>& tangential,
                    const LevelSteps& coarser, LayeredLevel* level, QuantizedLevel* values, Coder* coder) {
  const QuantizedLevel& known = level->values;
  if (steps.normal_step > 0) {
    const ForecastScale scale(coarser.normal_step, steps.normal_step);
    CodedNeighbors neighbors(t);
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      if (t.is_copy(e)) continue;
      const Forecast forecast = normal.empty() ? Forecast() : scale(normal[e]);
      CoefficientContext context = neighbors.ContextOf(e, normal.empty() ? nullptr : &forecast);
      context.companion = NonzeroAround(t, known.normal, e) + (t.on_curve[e] != 0 ? kCurveCompanion : 0);
      int32_t& q = values->normal[e];
      q = CodeRefined(*coder, level->normal, context, known.normal[e], drop, q);
      neighbors.Add(e, q);
    }
  }
  if (!(steps.tangential_step > 0)) return;
  const ForecastScale scale(coarser.tangential_step, steps.tangential_step);
  CodedNeighbors neighbors(t);
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    if (t.is_copy(e)) continue;
    const Forecast forecast = tangential.empty() ? Forecast() : scale(tangential[e]);
    CoefficientContext context = neighbors.ContextOf(e, tangential.empty() ? nullptr : &forecast);
    context.sign_class = 0;
    context.expect_negative = false;
    const uint32_t normal_magnitude = Magnitude(values->normal[e]);
    const int curve = t.on_curve[e] != 0 ? kCurveCompanion : 0;
    int32_t* const q = &values->tangential[size_t{2} * e];
    const int32_t* const before = &known.tangential[size_t{2} * e];
    context.companion = curve + (normal_magnitude == 0 ? 0 : normal_magnitude < 3 ? 1 : 2);
    q[0] = CodeRefined(*coder, level->tangential1, context, before[0], drop, q[0]);
    context.companion = curve + (q[0] != 0 ? 2 : normal_magnitude != 0 ? 1 : 0);
    q[1] = CodeRefined(*coder, level->tangential2, context, before[1], drop, q[1]);
    neighbors.Add(e, static_cast<int32_t>(Magnitude(q[0]) + Magnitude(q[1])));
  }
}

// Codes a segment and takes its values into `state`.
//   coarse  level segment.level - 1; coarser: the level before that, null for the base
//   steps   of segment.level, as the header tells them
//   values  shapes as in QuantizedLevel: what is coded, or zeros where it is decoded
template <typename Coder>
void CodeLayerSegment(const Topology& coarse, const Topology* coarser, const LevelSteps& steps, const LayerSegment& segment, LayerState* state,
                      QuantizedLevel values, Coder* coder) {
  LayeredLevel& level = state->levels[static_cast<size_t>(segment.level) - 1];
  const LevelSteps shifted = ShiftedSteps(steps, segment.shift);
  std::vector<Forecast> normal, tangential;
  LevelSteps coarser_steps;
  if (coarser != nullptr) {
    const LayeredLevel& below = state->levels[static_cast<size_t>(segment.level) - 2];
    normal = NormalForecasts(*coarser, below);
    tangential = TangentialForecasts(*coarser, below);
    coarser_steps = below.steps;
  }
  if (level.has_begun) {
    CodeRefinement(coarse, shifted, level.shift - segment.shift, normal, tangential, coarser_steps, &level, &values, coder);
  } else {
    CodingState& first = state->first;
    first.normal_forecasts = std::move(normal);
    first.tangential_forecasts = std::move(tangential);
    first.coarser_steps = coarser_steps;
    first.normal_continues = first.tangential_continues = false;  // forecasts are made when they are wanted
    CodeLevel(coarse, shifted, &first, &values, coder);
  }
  level.has_begun = true;
  level.shift = segment.shift;
  level.steps = shifted;
  level.values = std::move(values);
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_LAYER_CODING_H_
