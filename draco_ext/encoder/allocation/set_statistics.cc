#include "encoder/allocation/set_statistics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/allocation/generalized_gaussian.h"

namespace lacerta {
namespace {

SetStatistics DescribeSet(int level, SetKind kind, std::vector<float> samples, double zero_below, double energy,
                          size_t num_vertices) {
  const size_t count = samples.size();
  if (zero_below > 0.0) {
    const auto is_zero = [zero_below](float x) { return std::fabs(x) <= zero_below; };
    samples.erase(std::remove_if(samples.begin(), samples.end(), is_zero), samples.end());
  }
  const GeneralizedGaussianFit fit = FitGeneralizedGaussian(samples, level == 0 ? Centering::kMean : Centering::kZero);
  const double active = samples.empty() ? 1.0 : static_cast<double>(samples.size()) / static_cast<double>(count);
  const double per_vertex = static_cast<double>(count) / static_cast<double>(num_vertices);
  return {level, kind, count, fit.sigma * std::sqrt(active), fit.alpha, active, per_vertex * energy, per_vertex / 3.0};
}

}  // namespace

std::vector<SetStatistics> Describe(Span<Vec3f> positions, size_t num_base_vertices,
                                    const std::vector<LevelCoefficients>& levels, const std::vector<double>& energies,
                                    const DescribeOptions& options) {
  std::vector<SetStatistics> sets;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> samples;
    for (const Vec3f& p : positions.First(num_base_vertices)) samples.push_back(p[axis]);
    sets.push_back(DescribeSet(0, static_cast<SetKind>(axis), std::move(samples), 0.0, energies[0], positions.size()));
  }
  for (size_t i = 0; i < levels.size(); ++i) {
    std::vector<float> tangential, normal;
    for (const Vec3f& d : levels[i].detail) {
      tangential.push_back(d.x);
      tangential.push_back(d.y);
      normal.push_back(d.z);
    }
    const int level = static_cast<int>(i) + 1;
    const double zero_below = options.zero_share_of_edge_length * levels[i].mean_edge_length;
    sets.push_back(
        DescribeSet(level, SetKind::kTangential, std::move(tangential), zero_below, energies[i + 1], positions.size()));
    sets.push_back(
        DescribeSet(level, SetKind::kNormal, std::move(normal), zero_below, energies[i + 1], positions.size()));
  }
  return sets;
}

}  // namespace lacerta
