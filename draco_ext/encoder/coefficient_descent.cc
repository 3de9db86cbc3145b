#include "encoder/coefficient_descent.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base_tags.h"
#include "common/coefficient_coding.h"
#include "common/length_classes.h"
#include "decoder/synthesis.h"
#include "encoder/bit_cost.h"
#include "encoder/level_prediction.h"
#include "encoder/local_model.h"
#include "encoder/quantizer.h"

namespace lacerta {
namespace {

Vec3f LatticePoint(const BaseMesh& base, uint32_t v) {
  const auto& q = base.lattice[v];
  return Vec3f{static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2])} * base.step;
}

std::vector<Vec3f> LatticePoints(const BaseMesh& base) {
  std::vector<Vec3f> points;
  for (uint32_t v = 0; v < base.lattice.size(); ++v) points.push_back(LatticePoint(base, v));
  return points;
}

// Appends the vertices of level `level` (1 .. L) to the positions of the coarser ones. predicted: of them, where it is at hand.
void AppendLevel(const SurfaceTarget& target, const CodedSurface& coded, int level, std::vector<Vec3f>* positions) {
  const size_t num_coarse = positions->size();
  positions->resize(num_coarse + target.topologies[level - 1].num_edges());
  target.midpoints[level - 1].Predict(positions->data(), positions->data() + num_coarse);
  AddDetails(target.topologies[level - 1], coded.steps[level - 1], coded.levels[level - 1], positions);
}
void AppendLevel(const SurfaceTarget& target, const CodedSurface& coded, int level, const LevelPrediction& predicted, std::vector<Vec3f>* positions) {
  AppendLevel(target.topologies[level - 1], predicted, coded.steps[level - 1], coded.levels[level - 1], positions);
}

// The quantized value that lowers distortion + lambda * bits most: near the bottom of the parabola, or nearer to zero. The
// parabola holds for moves up to `reach`.
template <typename BitsOf>
int32_t BestValue(const LocalModel::Parabola& parabola, int32_t current, float step, float reach, double lambda,
                  const BitsOf& bits_of) {
  const float move = std::clamp(parabola.Lowest(), -reach, reach);
  const int32_t target = RoundToStep(static_cast<float>(current) * step + move, step);
  if (current == 0 && target == 0) return 0;
  const int32_t toward_zero = target - (target > 0) + (target < 0);
  int32_t best = current;
  double best_cost = lambda * bits_of(current);
  for (const int32_t q : {target, toward_zero, 0}) {
    if (q == best) continue;
    const double cost = parabola.Rise(static_cast<float>(q - current) * step) + lambda * bits_of(q);
    if (cost < best_cost) {
      best_cost = cost;
      best = q;
    }
  }
  return best;
}

void DescendBase(const SurfaceTarget& target, std::vector<Vec3f> gradient, BaseMesh* base) {
  LocalModel model(target, 0, std::move(gradient));
  const std::vector<uint32_t>& next_twin = target.next_twin;
  std::vector<bool> follows(base->lattice.size(), false);  // another vertex, which was moved already
  const BaseMesh before = *base;
  for (uint32_t v = 0; v < base->lattice.size(); ++v) {
    if (!next_twin.empty() && next_twin[v] != kNone) follows[next_twin[v]] = true;
    if (follows[v]) continue;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3f direction;
      direction[axis] = 1;
      const int32_t moves = RoundToStep(model.Along(v, direction).Lowest(), base->step);
      // A far jump says that the model does not hold there.
      const int32_t steps = std::clamp(moves, -1, 1);
      if (steps == 0) continue;
      for (uint32_t u = v; u != kNone; u = next_twin.empty() ? kNone : next_twin[u]) base->lattice[u][axis] += steps;
      model.Move(v, direction * (static_cast<float>(steps) * base->step));
    }
  }
  // Decoders take vertices at one point for joined ones: none may come together that were apart.
  if (!next_twin.empty() && FirstAtSamePoint(before.lattice) != FirstAtSamePoint(base->lattice)) *base = before;
}

// Chooses the details of level `level` (1 .. L) and advances the state of the entropy coder over them.
//   positions  of the coarser level; predicted: from there
//   gradient   for LocalModel
void DescendLevel(const SurfaceTarget& target, int level, const std::vector<Vec3f>& positions, const LevelPrediction& predicted,
                  std::vector<Vec3f> gradient, const DescentOptions& options, CodedSurface* coded, CodingState* state) {
  const Topology& coarse = target.topologies[level - 1];
  const LevelSteps& steps = coded->steps[level - 1];
  LocalModel model(target, level, std::move(gradient));
  BitMeter meter;
  const FinerLayer* const finer = options.finer;
  const bool is_fixed = finer != nullptr && finer->drops[level - 1] == 0;
  const auto choose = [&](CoefficientKind kind, uint32_t edge, SetModels& models, const CoefficientContext& context,
                          int32_t* value) {
    if (is_fixed) return;
    const LocalFrame& frame = predicted.frames[edge];
    const Vec3f& direction = kind == CoefficientKind::kNormal       ? frame.normal
                             : kind == CoefficientKind::kTangential1 ? frame.tangent1
                                                                     : frame.tangent2;
    const float step = kind == CoefficientKind::kNormal ? steps.normal_step : steps.tangential_step;
    const uint32_t v = coarse.num_vertices + edge;
    constexpr float kTrust = 0.25f;  // of the edge
    const float reach = kTrust * Norm(positions[coarse.edges[edge][1]] - positions[coarse.edges[edge][0]]);
    const int32_t best = BestValue(model.Along(v, direction), *value, step, reach, options.lambda, [&](int32_t q) {
      return CoefficientBits(models, context, q) + (finer != nullptr ? finer->Bits(level, kind, edge, q) : 0.0f);
    });
    if (best == *value) return;
    model.Move(v, direction * (static_cast<float>(best - *value) * step));
    *value = best;
  };
  CodeLevel(coarse, steps, state, &coded->levels[level - 1], &meter, choose);
}

// The finest level that has coefficients; 0 if none has.
int LastActiveLevel(const std::vector<LevelSteps>& steps) {
  size_t last = steps.size();
  while (last > 0 && steps[last - 1].is_silent()) --last;
  return static_cast<int>(last);
}

// One pass over all levels, coarse to fine. The gradient is computed once; what the coarser levels have moved since then comes to it
// with the lumped masses.
//   positions  Synthesize of `coded`, on entry and on return
void DescendOnce(const SurfaceTarget& target, const DescentOptions& options, CodedSurface* coded, std::vector<Vec3f>* positions) {
  std::vector<std::vector<Vec3f>> gradients = Gradients(target, *positions);
  if (options.move_base) DescendBase(target, gradients[LevelAhead(target, 0)], &coded->base);
  const std::vector<Vec3f> before = std::exchange(*positions, LatticePoints(coded->base));
  CodingState state;
  state.length_classes = LengthClasses(target.topologies[0], coded->base.lattice);
  const int last_active = LastActiveLevel(coded->steps);
  for (int level = 1; level <= last_active; ++level) {
    state.normal_continues = level < last_active && coded->steps[level].normal_step > 0;
    state.tangential_continues = level < last_active && coded->steps[level].tangential_step > 0;
    const LevelPrediction predicted = PredictLevel(target, level, coded->steps[level - 1], *positions);
    const int ahead = LevelAhead(target, level);
    std::vector<Vec3f> present = *positions;  // on the level ahead, with the coefficients so far
    AppendLevel(target, *coded, level, predicted, &present);
    if (ahead > level) AppendLevel(target, *coded, ahead, &present);
    std::vector<Vec3f> gradient = gradients[ahead];
    for (size_t v = 0; v < gradient.size(); ++v) {
      gradient[v] += Weigh(target, v, present[v] - before[v]) * target.masses[ahead][v];
    }
    DescendLevel(target, level, *positions, predicted, std::move(gradient), options, coded, &state);
    AppendLevel(target, *coded, level, predicted, positions);
  }
  for (int level = last_active + 1; level <= target.num_levels(); ++level) AppendLevel(target, *coded, level, positions);
}

// Bits of the two sets of every level.
struct SetBits {
  double normal = 0, tangential = 0;
};
std::vector<SetBits> CountBits(const SurfaceTarget& target, CodedSurface coded) {
  std::vector<SetBits> bits(coded.levels.size());
  CodingState state;
  state.length_classes = LengthClasses(target.topologies[0], coded.base.lattice);
  for (size_t i = 0; i < coded.levels.size(); ++i) {
    BitMeter meter;
    double before_tangential = -1;
    CodeLevel(target.topologies[i], coded.steps[i], &state, &coded.levels[i], &meter,
              [&](CoefficientKind kind, uint32_t, const SetModels&, const CoefficientContext&, const int32_t*) {
                if (kind != CoefficientKind::kNormal && before_tangential < 0) before_tangential = meter.bits();
              });
    if (before_tangential < 0) before_tangential = meter.bits();
    bits[i] = {before_tangential, meter.bits() - before_tangential};
  }
  return bits;
}

// What it does to the squared distance of the vertices of a level (1 .. L) that they are elsewhere, alone: about what it does to the surface.
double RiseOfLevel(const SurfaceTarget& target, int level, const std::vector<Vec3f>& before, const std::vector<Vec3f>& after) {
  const auto squared = [&](const Vec3f& position, size_t v) {
    const double distance = Dot(position - target.points[v], target.normals[v]);
    return distance * distance;
  };
  double rise = 0;
  for (size_t v = target.topologies[level - 1].num_vertices; v < target.topologies[level].num_vertices; ++v) {
    rise += target.masses[level][v] * (squared(after[v], v) - squared(before[v], v));
  }
  return rise;
}

// Leaves out whole sets, finest first, where that saves more rate than it costs distortion: zeros are cheap, not free.
//   positions  Synthesize of `coded`, on entry and on return
void DropIdleSets(const SurfaceTarget& target, double lambda, CodedSurface* coded, std::vector<Vec3f>* positions) {
  double distortion = SurfaceDistortion(target, *positions);
  const auto try_without = [&](float LevelSteps::*step, std::vector<int32_t> QuantizedLevel::*set, size_t i, double bits) {
    if (bits == 0) return;
    std::vector<int32_t>& values = coded->levels[i].*set;
    const bool is_silent = std::all_of(values.begin(), values.end(), [](int32_t q) { return q == 0; });
    if (!is_silent) {
      std::vector<int32_t> kept(values.size(), 0);
      values.swap(kept);
      std::vector<Vec3f> without(positions->begin(), positions->begin() + target.topologies[i].num_vertices);
      int level = static_cast<int>(i) + 1;
      AppendLevel(target, *coded, level, &without);
      constexpr double kMuchMore = 4;  // than would pay: then that is known without the finer levels
      if (RiseOfLevel(target, level, *positions, without) > kMuchMore * lambda * bits) {
        values.swap(kept);
        return;
      }
      while (++level <= target.num_levels()) AppendLevel(target, *coded, level, &without);
      const double raised = SurfaceDistortion(target, without);
      if (raised - distortion > lambda * bits) {
        values.swap(kept);
        return;
      }
      distortion = raised;
      *positions = std::move(without);
    }
    coded->steps[i].*step = 0;
  };
  const std::vector<SetBits> bits = CountBits(target, *coded);
  for (size_t i = bits.size(); i-- > 0;) {
    try_without(&LevelSteps::tangential_step, &QuantizedLevel::tangential, i, bits[i].tangential);
    try_without(&LevelSteps::normal_step, &QuantizedLevel::normal, i, bits[i].normal);
  }
}

// The details of level `level` (1 .. L) against `predicted`, rounded.
//   positions  of the coarser level, decoded
QuantizedLevel QuantizeLevel(const SurfaceTarget& target, int level, const std::vector<Vec3f>& positions, const LevelPrediction& predicted,
                             const LevelSteps& step) {
  const Topology& coarse = target.topologies[level - 1];
  QuantizedLevel quantized = ZeroLevel(coarse.num_edges());
  if (step.is_silent()) return quantized;
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
    if (coarse.is_copy(e)) continue;
    const uint32_t v = coarse.num_vertices + e;
    const LocalFrame& frame = predicted.frames[e];
    const Vec3f detail = target.points[v] - predicted.midpoints[e] - predicted.OffsetOf(e);
    const Vec3f local = frame.ToLocal(detail);
    const float on_plane = Dot(detail, target.normals[v]) / Dot(frame.normal, target.normals[v]);
    // Where the tangent plane stands too steep the normal line meets it far away, or never.
    constexpr float kMaxSlide = 0.1f;  // of the edge
    const float edge = Norm(positions[coarse.edges[e][1]] - positions[coarse.edges[e][0]]);
    const bool slides = std::fabs(on_plane - local.z) <= kMaxSlide * edge;  // false for NaN and infinity
    if (slides && target.piercing[v - target.topologies[0].num_vertices] == PiercingKind::kNormal) {
      quantized.normal[e] = RoundToStep(on_plane, step.normal_step);
      continue;
    }
    quantized.tangential[size_t{2} * e] = RoundToStep(local.x, step.tangential_step);
    quantized.tangential[size_t{2} * e + 1] = RoundToStep(local.y, step.tangential_step);
    quantized.normal[e] = RoundToStep(local.z, step.normal_step);
  }
  return quantized;
}

}  // namespace

// Rough figures: a segment is coded after many decisions about the layer before it.
float FinerLayer::Bits(int level, CoefficientKind kind, uint32_t edge, int32_t value) const {
  const QuantizedLevel& wanted = (*levels)[level - 1];
  const int32_t goal = kind == CoefficientKind::kNormal ? wanted.normal[edge]
                                                        : wanted.tangential[size_t{2} * edge + (kind == CoefficientKind::kTangential2)];
  const int32_t residual = goal - value * (1 << drops[level - 1]);
  const auto magnitude = static_cast<float>(Magnitude(residual));
  float bits;
  if (value == 0) {
    bits = residual == 0 ? 0.3f : 3.0f + 2.0f * std::log2(magnitude);
  } else if (residual == 0) {
    bits = 0.8f;
  } else if ((residual > 0) == (value > 0)) {
    bits = residual == 1 || residual == -1 ? 1.2f : 3.0f + 1.5f * std::log2(magnitude);
  } else {
    bits = 3.5f + 2.0f * std::log2(magnitude);
  }
  return static_cast<float>(weight) * bits;
}

std::vector<Vec3f> Synthesize(const SurfaceTarget& target, const CodedSurface& coded) {
  std::vector<Vec3f> positions = LatticePoints(coded.base);
  positions.reserve(target.points.size());
  for (int level = 1; level <= target.num_levels(); ++level) AppendLevel(target, coded, level, &positions);
  return positions;
}

double PlaneDistortion(const SurfaceTarget& target, const std::vector<Vec3f>& positions) {
  std::vector<double> distance(positions.size());
  for (size_t v = 0; v < positions.size(); ++v) distance[v] = Dot(positions[v] - target.points[v], target.normals[v]);
  double sum = 0;
  const std::vector<Triangle>& triangles = target.topologies.back().triangles;
  for (size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    const double a = distance[t[0]], b = distance[t[1]], c = distance[t[2]];
    sum += target.areas[i] * (a * a + b * b + c * c + a * b + b * c + c * a) / 6;
  }
  return sum;
}

double SurfaceDistortion(const SurfaceTarget& target, const std::vector<Vec3f>& positions) {
  const std::vector<CurveRole>& role = target.topologies.back().role;
  double sum = PlaneDistortion(target, positions);
  for (size_t v = 0; v < positions.size(); ++v) {
    if (role[v] == CurveRole::kSmooth) continue;
    const Vec3f offset = positions[v] - target.points[v];
    const double distance = Dot(offset, target.normals[v]);
    sum += target.masses.back()[v] * (Dot(offset, Weigh(target, v, offset)) - distance * distance);
  }
  return sum;
}

CodedSurface QuantizeClosedLoop(const SurfaceTarget& target, const BaseMesh& base, const std::vector<LevelSteps>& steps,
                                std::vector<Vec3f>* positions) {
  CodedSurface coded{base, steps, {}};
  std::vector<Vec3f> decoded = LatticePoints(base);
  for (int level = 1; level <= target.num_levels(); ++level) {
    const LevelPrediction predicted = PredictLevel(target, level, steps[level - 1], decoded);
    coded.levels.push_back(QuantizeLevel(target, level, decoded, predicted, steps[level - 1]));
    AppendLevel(target, coded, level, predicted, &decoded);
  }
  if (positions != nullptr) *positions = std::move(decoded);
  return coded;
}

CodedSurface Descend(const SurfaceTarget& target, CodedSurface coded, const DescentOptions& options, std::vector<Vec3f>* positions) {
  std::vector<Vec3f> present = positions != nullptr ? std::move(*positions) : Synthesize(target, coded);
  for (int pass = 0; pass < options.passes; ++pass) DescendOnce(target, options, &coded, &present);
  if (!target.keeps_vertices && options.finer == nullptr) DropIdleSets(target, options.lambda, &coded, &present);  // by distance to the surface alone
  if (positions != nullptr) *positions = std::move(present);
  return coded;
}

}  // namespace lacerta
