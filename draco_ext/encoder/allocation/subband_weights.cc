#include "encoder/allocation/subband_weights.h"

#include <array>
#include <cmath>
#include <cstdint>

#include "common/butterfly.h"

namespace lacerta {
namespace {

// Signs from a counter [Steele, Lea, Flood 2014: SplitMix64].
class SignSource {
 public:
  explicit SignSource(uint64_t seed) : state_(seed) {}
  Vec3f Next() {
    uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    const auto sign = [z](int bit) { return (z >> bit & 1) != 0 ? 1.0f : -1.0f; };
    return {sign(61), sign(62), sign(63)};
  }

 private:
  uint64_t state_;
};

double SumOfSquares(const std::vector<Vec3f>& values) {
  double sum = 0.0;
  for (const Vec3f& v : values) sum += SquaredNorm(Vec3Cast<double>(v));
  return sum;
}

}  // namespace

double RegularEnergy(int num_subdivisions) {
  // Sums of squares of the subdivided unit impulse on the regular lattice.
  constexpr std::array<double, 6> kEnergies = {1.0, 2.640625, 10.077637, 40.164011, 160.615435, 642.451004};
  constexpr int kLast = static_cast<int>(kEnergies.size()) - 1;
  if (num_subdivisions <= kLast) return kEnergies[num_subdivisions];
  return std::ldexp(kEnergies[kLast], 2 * (num_subdivisions - kLast));
}

std::vector<double> RegularEnergies(int num_levels) {
  std::vector<double> energies = {RegularEnergy(num_levels)};
  for (int level = 1; level <= num_levels; ++level) energies.push_back(RegularEnergy(num_levels - level));
  return energies;
}

std::vector<double> ProbeEnergies(const Topology& base, int num_levels, int num_probes) {
  std::vector<Topology> levels = {base};
  for (int level = 1; level < num_levels; ++level) levels.push_back(Refine(levels.back()));
  std::vector<StencilTable> stencils(levels.begin(), levels.end());

  std::vector<double> energies;
  for (int level = 0; level <= num_levels; ++level) {
    // Old vertices of the level stay at rest; its own are the coefficients.
    const uint32_t num_old = level == 0 ? 0 : levels[level - 1].num_vertices;
    const uint32_t num_own = level == 0 ? base.num_vertices : levels[level - 1].num_edges();
    double energy = 0.0;
    SignSource signs(static_cast<uint64_t>(level));
    for (int probe = 0; probe < num_probes; ++probe) {
      std::vector<Vec3f> field(num_old);
      for (uint32_t i = 0; i < num_own; ++i) field.push_back(signs.Next());
      for (int finer = level; finer < num_levels; ++finer) {
        const std::vector<Vec3f> midpoints = PredictMidpoints(levels[finer], stencils[finer], field);
        field.insert(field.end(), midpoints.begin(), midpoints.end());
      }
      energy += SumOfSquares(field);
    }
    energies.push_back(num_own == 0 ? 0.0 : energy / (3.0 * num_probes * num_own));
  }
  return energies;
}

}  // namespace lacerta
