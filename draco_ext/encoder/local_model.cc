#include "encoder/local_model.h"

#include "encoder/for_ranges.h"

namespace lacerta {
namespace {

// A gradient on the positions of `level` (1 .. L) as one on those of the next coarser level.
std::vector<Vec3f> BringDown(const SurfaceTarget& target, const std::vector<Vec3f>& gradient, int level) {
  const uint32_t num_vertices = target.topologies[level - 1].num_vertices;
  const StencilSpread& spread = target.spreads[level - 1];
  std::vector<Vec3f> coarser(num_vertices);
  ForRanges(num_vertices, [&](size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) {
      Vec3f sum = gradient[v];
      for (uint32_t k = spread.first[v]; k < spread.first[v + 1]; ++k) {
        sum += gradient[num_vertices + spread.edges[k]] * spread.weights[k];
      }
      coarser[v] = sum;
    }
  });
  return coarser;
}

}  // namespace

std::vector<SymmetricMatrix> Curvatures(const SurfaceTarget& target, int level) {
  const int ahead = LevelAhead(target, level), farther = LevelAhead(target, ahead);
  const Reach reach(target, level);
  std::vector<SymmetricMatrix> curvatures(target.topologies[level].num_vertices);
  std::vector<float> weights(target.topologies[farther].num_vertices, 0.0f);  // with which the vertex at hand moves those two levels finer
  std::vector<uint32_t> moved;                                                // those that it moves
  const auto add = [&](uint32_t u, float weight) {
    if (weights[u] == 0) moved.push_back(u);
    weights[u] += weight;
  };
  for (uint32_t v = 0; v < curvatures.size(); ++v) {
    moved.clear();
    reach.Visit(v, add);
    if (farther > ahead) {
      const StencilSpread& spread = target.spreads[ahead];
      for (size_t i = 0, num_ahead = moved.size(); i < num_ahead; ++i) {
        const uint32_t u = moved[i];
        for (uint32_t k = spread.first[u]; k < spread.first[u + 1]; ++k) {
          add(target.topologies[ahead].num_vertices + spread.edges[k], weights[u] * spread.weights[k]);
        }
      }
    }
    for (const uint32_t u : moved) {
      const VertexMetric metric = MetricAt(target, u);
      const float weight = std::exchange(weights[u], 0.0f), mass = weight * weight * target.masses[farther][u];
      curvatures[v].Add(target.normals[u], mass * metric.slide, mass * (metric.leave - metric.slide));
    }
  }
  return curvatures;
}

std::vector<std::vector<Vec3f>> Gradients(const SurfaceTarget& target, const std::vector<Vec3f>& positions) {
  const int num_levels = target.num_levels();
  std::vector<std::vector<Vec3f>> gradients(num_levels + 1);
  gradients.back().resize(positions.size());
  ForRanges(positions.size(), [&](size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) gradients.back()[v] = Weigh(target, v, positions[v] - target.points[v]) * target.masses.back()[v];
  });
  for (int level = num_levels; level > 0; --level) gradients[level - 1] = BringDown(target, gradients[level], level);
  return gradients;
}

}  // namespace lacerta
