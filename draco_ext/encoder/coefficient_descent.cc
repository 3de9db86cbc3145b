#include "encoder/coefficient_descent.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base_tags.h"
#include "common/coefficient_coding.h"
#include "common/local_frame.h"
#include "decoder/synthesis.h"
#include "encoder/bit_cost.h"
#include "encoder/quantizer.h"

namespace lacerta {
namespace {

Vec3f LatticePoint(const BaseMesh& base, uint32_t v) {
  const auto& q = base.lattice[v];
  return Vec3f{static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2])} * base.step;
}

// How a vertex moves the level that it is looked at on: itself and its twins with weight 1, and the midpoints of the next level.
class Reach {
 public:
  Reach(const SurfaceTarget& target, int level)
      : next_twin_(target.next_twin),
        spread_(level < target.num_levels() ? &target.spreads[level] : nullptr),
        first_midpoint_(target.topologies[level].num_vertices) {}

  template <typename Visitor>
  void Visit(uint32_t v, const Visitor& visit) const {
    for (uint32_t twin = v; twin != kNone; twin = next_twin_.empty() ? kNone : next_twin_[twin]) {
      visit(twin, 1.0f);
      if (spread_ == nullptr) continue;
      for (uint32_t k = spread_->first[twin]; k < spread_->first[twin + 1]; ++k) {
        visit(first_midpoint_ + spread_->edges[k], spread_->weights[k]);
      }
    }
  }

 private:
  const std::vector<uint32_t>& next_twin_;
  const StencilSpread* spread_;
  uint32_t first_midpoint_;
};

// The metric of SurfaceTarget at a vertex, applied to an offset. Sliding along the surface costs a share of what leaving it
// costs: little where the vertex was found by piercing, so that vertices just do not drift; much where it was not, since the
// surface is not flat there in the sense that planes presume. Where vertices are kept, what suits tangential steps of twice the
// normal one.
Vec3f Weigh(const SurfaceTarget& target, size_t v, const Vec3f& offset) {
  constexpr float kPiercedSlideCost = 0.05f, kOtherSlideCost = 0.15f, kKeptSlideCost = 0.25f, kCurveSlideCost = 0.5f;
  const bool on_curve = target.topologies.back().role[v] != CurveRole::kSmooth;
  const size_t num_base = target.points.size() - target.piercing.size();
  const bool pierced = v < num_base || target.piercing[v - num_base] == PiercingKind::kNormal;
  const float slide_cost = on_curve                ? kCurveSlideCost
                           : target.keeps_vertices ? kKeptSlideCost
                           : pierced               ? kPiercedSlideCost
                                                   : kOtherSlideCost;
  const Vec3f& n = target.normals[v];
  return offset * slide_cost + n * ((1 - slide_cost) * Dot(offset, n));
}

// Half the gradient of the distortion with respect to the positions of the finest level, brought down to `level`.
std::vector<Vec3f> GradientAt(const SurfaceTarget& target, const std::vector<Vec3f>& positions, int level) {
  const std::vector<float>& mass = target.masses.back();
  std::vector<Vec3f> gradient(positions.size());
  for (size_t v = 0; v < positions.size(); ++v) {
    gradient[v] = Weigh(target, v, positions[v] - target.points[v]) * mass[v];
  }
  for (int l = target.num_levels() - 1; l >= level; --l) {
    const uint32_t num_vertices = target.topologies[l].num_vertices;
    const StencilSpread& spread = target.spreads[l];
    for (uint32_t v = 0; v < num_vertices; ++v) {
      Vec3f sum;
      for (uint32_t k = spread.first[v]; k < spread.first[v + 1]; ++k) {
        sum += gradient[num_vertices + spread.edges[k]] * spread.weights[k];
      }
      gradient[v] += sum;
    }
    gradient.resize(num_vertices);
  }
  return gradient;
}

// The local quadratic model of the distortion on one level, kept up to date while coefficients move.
class LocalModel {
 public:
  LocalModel(const SurfaceTarget& target, const std::vector<Vec3f>& positions, int level)
      : target_(target),
        reach_(target, level),
        masses_(target.masses[std::min(level + 1, target.num_levels())]),
        gradient_(GradientAt(target, positions, std::min(level + 1, target.num_levels()))) {}

  // Distortion as a function of a move of vertex v by `length` along `direction`: slope * 2 length + curvature * length^2.
  struct Parabola {
    float slope = 0, curvature = 0;
    float Rise(float length) const { return length * (2 * slope + curvature * length); }
    float Lowest() const { return curvature > 0 ? -slope / curvature : 0.0f; }
  };
  Parabola Along(uint32_t v, const Vec3f& direction) const {
    Parabola p;
    reach_.Visit(v, [&](uint32_t u, float weight) {
      p.slope += weight * Dot(gradient_[u], direction);
      p.curvature += weight * weight * masses_[u] * Dot(direction, Weigh(target_, u, direction));
    });
    return p;
  }

  void Move(uint32_t v, const Vec3f& displacement) {
    reach_.Visit(v, [&](uint32_t u, float weight) {
      gradient_[u] += Weigh(target_, u, displacement) * (masses_[u] * weight);
    });
  }

 private:
  const SurfaceTarget& target_;
  const Reach reach_;
  const std::vector<float>& masses_;
  std::vector<Vec3f> gradient_;
};

// The quantized value that lowers distortion + lambda * bits most: near the bottom of the parabola, or nearer to zero. The
// parabola holds for moves up to `reach`.
template <typename BitsOf>
int32_t BestValue(const LocalModel::Parabola& parabola, int32_t current, float step, float reach, double lambda,
                  const BitsOf& bits_of) {
  const float move = std::clamp(parabola.Lowest(), -reach, reach);
  const int32_t target = RoundToStep(static_cast<float>(current) * step + move, step);
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

void DescendBase(const SurfaceTarget& target, const std::vector<Vec3f>& positions, BaseMesh* base) {
  LocalModel model(target, positions, 0);
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
void DescendLevel(const SurfaceTarget& target, const std::vector<Vec3f>& positions, int level, double lambda,
                  CodedSurface* coded, CodingState* state) {
  const Topology& coarse = target.topologies[level - 1];
  std::vector<Vec3f> coarse_positions(positions.begin(), positions.begin() + coarse.num_vertices);
  const std::vector<LocalFrame> frames =
      ComputeLocalFrames(coarse, coarse_positions, PredictMidpoints(coarse, target.stencils, coarse_positions));
  const LevelSteps& steps = coded->steps[level - 1];
  LocalModel model(target, positions, level);
  BitMeter meter;
  const auto choose = [&](CoefficientKind kind, uint32_t edge, SetModels& models, const CoefficientContext& context,
                          int32_t* value) {
    const LocalFrame& frame = frames[edge];
    const Vec3f& direction = kind == CoefficientKind::kNormal       ? frame.normal
                             : kind == CoefficientKind::kTangential1 ? frame.tangent1
                                                                     : frame.tangent2;
    const float step = kind == CoefficientKind::kNormal ? steps.normal_step : steps.tangential_step;
    const uint32_t v = coarse.num_vertices + edge;
    constexpr float kTrust = 0.25f;  // of the edge
    const float reach = kTrust * Norm(positions[coarse.edges[edge][1]] - positions[coarse.edges[edge][0]]);
    const int32_t best = BestValue(model.Along(v, direction), *value, step, reach, lambda,
                                   [&](int32_t q) { return CoefficientBits(models, context, q); });
    if (best == *value) return;
    model.Move(v, direction * (static_cast<float>(best - *value) * step));
    *value = best;
  };
  CodeLevel(coarse, steps, state, &coded->levels[level - 1], &meter, choose);
}

// Bits of the two sets of every level.
struct SetBits {
  double normal = 0, tangential = 0;
};
std::vector<SetBits> CountBits(const SurfaceTarget& target, CodedSurface coded) {
  std::vector<SetBits> bits(coded.levels.size());
  CodingState state;
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

// Leaves out whole sets, finest first, where that saves more rate than it costs distortion: zeros are cheap, not free.
void DropIdleSets(const SurfaceTarget& target, double lambda, CodedSurface* coded) {
  double distortion = PlaneDistortion(target, Synthesize(target, *coded));
  const auto try_without = [&](float LevelSteps::*step, std::vector<int32_t> QuantizedLevel::*values, size_t i, double bits) {
    if (bits == 0) return;
    CodedSurface without = *coded;
    without.steps[i].*step = 0;
    std::fill((without.levels[i].*values).begin(), (without.levels[i].*values).end(), 0);
    const double raised = PlaneDistortion(target, Synthesize(target, without));
    if (raised - distortion > lambda * bits) return;
    distortion = raised;
    *coded = std::move(without);
  };
  const std::vector<SetBits> bits = CountBits(target, *coded);
  for (size_t i = bits.size(); i-- > 0;) {
    try_without(&LevelSteps::tangential_step, &QuantizedLevel::tangential, i, bits[i].tangential);
    try_without(&LevelSteps::normal_step, &QuantizedLevel::normal, i, bits[i].normal);
  }
}

}  // namespace

std::vector<Vec3f> Synthesize(const SurfaceTarget& target, const CodedSurface& coded) {
  std::vector<Vec3f> positions;
  positions.reserve(target.points.size());
  for (uint32_t v = 0; v < coded.base.lattice.size(); ++v) positions.push_back(LatticePoint(coded.base, v));
  for (int level = 1; level <= target.num_levels(); ++level) {
    SynthesizeLevel(target.topologies[level - 1], target.stencils, coded.steps[level - 1], coded.levels[level - 1], &positions);
  }
  return positions;
}

double PlaneDistortion(const SurfaceTarget& target, const std::vector<Vec3f>& positions) {
  double sum = 0;
  for (size_t v = 0; v < positions.size(); ++v) {
    const double distance = Dot(positions[v] - target.points[v], target.normals[v]);
    sum += target.masses.back()[v] * distance * distance;
  }
  return sum;
}

CodedSurface QuantizeClosedLoop(const SurfaceTarget& target, const BaseMesh& base, const std::vector<LevelSteps>& steps) {
  CodedSurface coded{base, steps, {}};
  std::vector<Vec3f> positions;
  for (uint32_t v = 0; v < base.lattice.size(); ++v) positions.push_back(LatticePoint(base, v));
  for (int level = 1; level <= target.num_levels(); ++level) {
    const Topology& coarse = target.topologies[level - 1];
    const LevelSteps& step = steps[level - 1];
    const std::vector<Vec3f> predicted = PredictMidpoints(coarse, target.stencils, positions);
    const std::vector<LocalFrame> frames = ComputeLocalFrames(coarse, positions, predicted);
    QuantizedLevel quantized;
    quantized.normal.resize(coarse.num_edges());
    quantized.tangential.resize(size_t{2} * coarse.num_edges());
    for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
      if (coarse.is_copy(e)) continue;
      const uint32_t v = coarse.num_vertices + e;
      const Vec3f detail = target.points[v] - predicted[e];
      const Vec3f local = frames[e].ToLocal(detail);
      const float on_plane = Dot(detail, target.normals[v]) / Dot(frames[e].normal, target.normals[v]);
      // Where the tangent plane stands too steep the normal line meets it far away, or never.
      constexpr float kMaxSlide = 0.1f;  // of the edge
      const float edge = Norm(positions[coarse.edges[e][1]] - positions[coarse.edges[e][0]]);
      const bool slides = std::fabs(on_plane - local.z) <= kMaxSlide * edge;  // false for NaN and infinity
      if (slides && target.piercing[v - base.lattice.size()] == PiercingKind::kNormal) {
        quantized.normal[e] = RoundToStep(on_plane, step.normal_step);
        continue;
      }
      quantized.tangential[2 * e] = RoundToStep(local.x, step.tangential_step);
      quantized.tangential[2 * e + 1] = RoundToStep(local.y, step.tangential_step);
      quantized.normal[e] = RoundToStep(local.z, step.normal_step);
    }
    SynthesizeLevel(coarse, target.stencils, step, quantized, &positions);
    coded.levels.push_back(std::move(quantized));
  }
  return coded;
}

CodedSurface Descend(const SurfaceTarget& target, CodedSurface coded, const DescentOptions& options) {
  for (int pass = 0; pass < options.passes; ++pass) {
    if (options.move_base) DescendBase(target, Synthesize(target, coded), &coded.base);
    CodingState state;
    for (int level = 1; level <= target.num_levels(); ++level) {
      DescendLevel(target, Synthesize(target, coded), level, options.lambda, &coded, &state);
    }
  }
  if (!target.keeps_vertices) DropIdleSets(target, options.lambda, &coded);  // by distance to the surface alone
  return coded;
}

}  // namespace lacerta
