#include "encoder/allocation/set_statistics.h"

#include "encoder/allocation/generalized_gaussian.h"

namespace lacerta {
namespace {

SetStatistics DescribeSet(int level, SetKind kind, const std::vector<float>& samples, double energy, size_t num_vertices) {
  const bool base = level == 0;
  const GeneralizedGaussianFit fit = FitGeneralizedGaussian(samples, base ? Centering::kMean : Centering::kZero);
  const double per_vertex = static_cast<double>(samples.size()) / static_cast<double>(num_vertices);
  return {level, kind, samples.size(), fit.sigma, fit.alpha, per_vertex * energy, per_vertex / 3.0};
}

}  // namespace

std::vector<SetStatistics> Describe(Span<Vec3f> positions, size_t num_base_vertices, const std::vector<LevelCoefficients>& levels,
                                    const std::vector<double>& energies) {
  std::vector<SetStatistics> sets;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> samples;
    for (const Vec3f& p : positions.First(num_base_vertices)) samples.push_back(p[axis]);
    sets.push_back(DescribeSet(0, static_cast<SetKind>(axis), samples, energies[0], positions.size()));
  }
  for (size_t i = 0; i < levels.size(); ++i) {
    std::vector<float> tangential, normal;
    for (const Vec3f& d : levels[i].detail) {
      tangential.push_back(d.x);
      tangential.push_back(d.y);
      normal.push_back(d.z);
    }
    const int level = static_cast<int>(i) + 1;
    sets.push_back(DescribeSet(level, SetKind::kTangential, tangential, energies[i + 1], positions.size()));
    sets.push_back(DescribeSet(level, SetKind::kNormal, normal, energies[i + 1], positions.size()));
  }
  return sets;
}

}  // namespace lacerta
