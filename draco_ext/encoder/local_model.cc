#include "encoder/local_model.h"

namespace lacerta {
namespace {

// A gradient on the positions of `level` (1 .. L) as one on those of the next coarser level.
std::vector<Vec3f> BringDown(const SurfaceTarget& target, const std::vector<Vec3f>& gradient, int level) {
  const uint32_t num_vertices = target.topologies[level - 1].num_vertices;
  const StencilSpread& spread = target.spreads[level - 1];
  std::vector<Vec3f> coarser(num_vertices);
  for (uint32_t v = 0; v < num_vertices; ++v) {
    Vec3f sum = gradient[v];
    for (uint32_t k = spread.first[v]; k < spread.first[v + 1]; ++k) {
      sum += gradient[num_vertices + spread.edges[k]] * spread.weights[k];
    }
    coarser[v] = sum;
  }
  return coarser;
}

}  // namespace

std::vector<SymmetricMatrix> Curvatures(const SurfaceTarget& target, int level) {
  const Reach reach(target, level);
  const std::vector<float>& masses = target.masses[LevelAhead(target, level)];
  std::vector<SymmetricMatrix> curvatures(target.topologies[level].num_vertices);
  for (uint32_t v = 0; v < curvatures.size(); ++v) {
    reach.Visit(v, [&](uint32_t u, float weight) {
      const VertexMetric metric = MetricAt(target, u);
      const float mass = weight * weight * masses[u];
      curvatures[v].Add(target.normals[u], mass * metric.slide, mass * (metric.leave - metric.slide));
    });
  }
  return curvatures;
}

std::vector<std::vector<Vec3f>> Gradients(const SurfaceTarget& target, const std::vector<Vec3f>& positions) {
  const int num_levels = target.num_levels();
  std::vector<std::vector<Vec3f>> gradients(num_levels + 1);
  gradients.back().resize(positions.size());
  for (size_t v = 0; v < positions.size(); ++v) {
    gradients.back()[v] = Weigh(target, v, positions[v] - target.points[v]) * target.masses.back()[v];
  }
  for (int level = num_levels; level > 0; --level) gradients[level - 1] = BringDown(target, gradients[level], level);
  return gradients;
}

}  // namespace lacerta
