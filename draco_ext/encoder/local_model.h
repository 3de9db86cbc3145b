// The local quadratic model of the distortion on one level of a SurfaceTarget, in which coefficients are chosen.
#ifndef LACERTA_ENCODER_LOCAL_MODEL_H_
#define LACERTA_ENCODER_LOCAL_MODEL_H_

#include <cstdint>
#include <utility>
#include <vector>

#include "encoder/surface_target.h"

namespace lacerta {

// The metric of SurfaceTarget at a vertex, applied to an offset. Sliding along the surface costs a share of what leaving it
// costs: little where the vertex was found by piercing, so that vertices just do not drift; much where it was not, since the
// surface is not flat there in the sense that planes presume. Where vertices are kept, what suits tangential steps of twice the
// normal one. On curves all directions matter, and more than the area at them says (docs/decisions/0008-curves.md).
inline Vec3f Weigh(const SurfaceTarget& target, size_t v, const Vec3f& offset) {
  constexpr float kPiercedSlideCost = 0.05f, kOtherSlideCost = 0.15f, kKeptSlideCost = 0.25f, kCurveSlideCost = 0.5f;
  constexpr float kCurveWeight = 4.0f;  // a border is seen, though hardly any area lies at it
  const bool on_curve = target.topologies.back().role[v] != CurveRole::kSmooth;
  const size_t num_base = target.points.size() - target.piercing.size();
  const bool pierced = v < num_base || target.piercing[v - num_base] == PiercingKind::kNormal;
  const float slide_cost = on_curve                ? kCurveSlideCost
                           : target.keeps_vertices ? kKeptSlideCost
                           : pierced               ? kPiercedSlideCost
                                                   : kOtherSlideCost;
  const float weight = on_curve ? kCurveWeight : 1.0f;
  const Vec3f& n = target.normals[v];
  return (offset * slide_cost + n * ((1 - slide_cost) * Dot(offset, n))) * weight;
}

// Half the gradient of the distortion with respect to the positions of every level 0 .. L, all finer details staying as they are:
// that of the finest level brought down by the transposed subdivision. positions: of the finest level.
std::vector<std::vector<Vec3f>> Gradients(const SurfaceTarget& target, const std::vector<Vec3f>& positions);

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

// The level that the effect of the vertices of `level` is looked at on: one level finer where there is one.
inline int LevelAhead(const SurfaceTarget& target, int level) { return level < target.num_levels() ? level + 1 : level; }

// Kept up to date while the vertices of `level` move.
class LocalModel {
 public:
  // gradient: of LevelAhead(target, level).
  LocalModel(const SurfaceTarget& target, int level, std::vector<Vec3f> gradient)
      : target_(target), reach_(target, level), masses_(target.masses[LevelAhead(target, level)]), gradient_(std::move(gradient)) {}

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

}  // namespace lacerta

#endif  // LACERTA_ENCODER_LOCAL_MODEL_H_
