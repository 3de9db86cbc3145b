// The local quadratic model of the distortion on one level of a SurfaceTarget, in which coefficients are chosen.
#ifndef LACERTA_ENCODER_LOCAL_MODEL_H_
#define LACERTA_ENCODER_LOCAL_MODEL_H_

#include <cstdint>
#include <utility>
#include <vector>

#include "common/butterfly.h"
#include "encoder/surface_target.h"

namespace lacerta {

// Half the second derivative of the distortion with respect to the position of each vertex of `level`: #V. Its effect is looked at two
// levels finer, where there are so many: with the masses lumped at one it is overstated by some hundredths (docs/decisions/0006-descent.md).
std::vector<SymmetricMatrix> Curvatures(const SurfaceTarget& target, int level);

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
      : target_(target),
        topology_(target.topologies[level]),
        reach_(target, level),
        masses_(target.masses[LevelAhead(target, level)]),
        curvatures_(target.curvatures[level]),
        gradient_(std::move(gradient)),
        slopes_(topology_.num_vertices),
        is_known_(topology_.num_vertices, 0) {}

  // Distortion as a function of a move of vertex v by `length` along `direction`: slope * 2 length + curvature * length^2.
  struct Parabola {
    float slope = 0, curvature = 0;
    float Rise(float length) const { return length * (2 * slope + curvature * length); }
    float Lowest() const { return curvature > 0 ? -slope / curvature : 0.0f; }
  };
  Parabola Along(uint32_t v, const Vec3f& direction) {
    return {Dot(SlopeAt(v), direction), curvatures_[v].Along(direction)};
  }

  void Move(uint32_t v, const Vec3f& displacement) {
    reach_.Visit(v, [&](uint32_t u, float weight) {
      gradient_[u] += Weigh(target_, u, displacement) * (masses_[u] * weight);
      Forget(u);
    });
  }

 private:
  const Vec3f& SlopeAt(uint32_t v) {
    if (is_known_[v] == 0) {
      Vec3f sum;
      reach_.Visit(v, [&](uint32_t u, float weight) { sum += gradient_[u] * weight; });
      slopes_[v] = sum;
      is_known_[v] = target_.next_twin.empty();  // else others than Forget finds may change it
    }
    return slopes_[v];
  }

  // Slopes that the gradient at u of the level ahead is part of.
  void Forget(uint32_t u) {
    if (!target_.next_twin.empty()) return;
    if (u < topology_.num_vertices) {
      is_known_[u] = 0;
    } else {
      VisitStencil(topology_, target_.stencils, u - topology_.num_vertices, [&](uint32_t w, float) { is_known_[w] = 0; });
    }
  }

  const SurfaceTarget& target_;
  const Topology& topology_;
  const Reach reach_;
  const std::vector<float>& masses_;
  const std::vector<SymmetricMatrix>& curvatures_;
  std::vector<Vec3f> gradient_;
  std::vector<Vec3f> slopes_;       // #V of `level`, where known
  std::vector<uint8_t> is_known_;
};

}  // namespace lacerta

#endif  // LACERTA_ENCODER_LOCAL_MODEL_H_
