#include "encoder/allocation/subband_weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "common/butterfly.h"
#include "encoder/allocation/set_statistics.h"
#include "encoder/analysis.h"
#include "shapes/base_meshes.h"
#include "shapes/open_loop_synthesis.h"

namespace lacerta {
namespace {

// Squared sum over the finest vertices of a unit impulse at `vertex` after num_subdivisions.
double ImpulseEnergy(Topology topology, uint32_t vertex, int num_subdivisions) {
  std::vector<Vec3f> field(topology.num_vertices);
  field[vertex].x = 1.0f;
  for (int i = 0; i < num_subdivisions; ++i) {
    const std::vector<Vec3f> midpoints = PredictMidpoints(topology, StencilTable(topology), field);
    field.insert(field.end(), midpoints.begin(), midpoints.end());
    topology = Refine(topology);
  }
  double energy = 0.0;
  for (const Vec3f& v : field) energy += SquaredNorm(v);
  return energy;
}

TEST(RegularEnergyTest, IsTheEnergyOfAnImpulseOnARegularMesh) {
  const Topology torus = shapes::TopologyOf(shapes::Torus(12, 12));
  for (int k = 0; k <= 5; ++k) {
    EXPECT_NEAR(RegularEnergy(k), ImpulseEnergy(torus, 0, k), 2e-5 * RegularEnergy(k)) << k;
  }
}

TEST(RegularEnergyTest, GrowsByFourInTheLimit) {
  EXPECT_NEAR(RegularEnergy(6) / std::ldexp(1.0, 12), 0.627394, 1e-5);
  EXPECT_NEAR(RegularEnergy(12) / std::ldexp(1.0, 24), 0.627394, 1e-5);
}

TEST(RegularEnergyTest, ByLevelFromTheBase) {
  EXPECT_EQ(RegularEnergies(0), std::vector<double>{1.0});
  EXPECT_EQ(RegularEnergies(2), (std::vector<double>{RegularEnergy(2), RegularEnergy(1), RegularEnergy(0)}));
}

TEST(ProbeEnergiesTest, AgreesWithTheClosedNumbersOnARegularMesh) {
  const std::vector<double> probed = ProbeEnergies(shapes::TopologyOf(shapes::Torus(8, 8)), 4, 60);
  const std::vector<double> closed = RegularEnergies(4);
  ASSERT_EQ(probed.size(), closed.size());
  for (size_t i = 0; i < closed.size(); ++i) EXPECT_NEAR(probed[i], closed[i], 0.03 * closed[i]) << i;
  EXPECT_DOUBLE_EQ(probed.back(), 1.0);
}

TEST(ProbeEnergiesTest, AgreesWithImpulsesOnIrregularMeshes) {
  for (const TriangleMesh& mesh :
       {shapes::Icosahedron(), shapes::Bipyramid(4), shapes::Bipyramid(12), shapes::Grid(3)}) {
    const Topology base = shapes::TopologyOf(mesh);
    const Topology fine = Refine(base);
    double base_energy = 0.0, detail_energy = 0.0;
    for (uint32_t v = 0; v < base.num_vertices; ++v) base_energy += ImpulseEnergy(base, v, 3) / base.num_vertices;
    for (uint32_t e = 0; e < base.num_edges(); ++e)
      detail_energy += ImpulseEnergy(fine, base.num_vertices + e, 2) / base.num_edges();
    const std::vector<double> probed = ProbeEnergies(base, 3, 400);
    EXPECT_NEAR(probed[0], base_energy, 0.05 * base_energy);
    EXPECT_NEAR(probed[1], detail_energy, 0.05 * detail_energy);
  }
}

TEST(ProbeEnergiesTest, IsDeterministic) {
  const Topology base = shapes::TopologyOf(shapes::Icosahedron());
  EXPECT_EQ(ProbeEnergies(base, 3, 2), ProbeEnergies(base, 3, 2));
}

// Mean squared vertex error of the finest mesh where uniform noise of variance 1e-8 is added to the samples of one set.
double NoiseError(const SemiRegularMesh& mesh, const std::vector<LevelCoefficients>& levels, const SetStatistics& set,
                  int num_trials) {
  const Topology base = BuildTopology(mesh.num_base_vertices, mesh.base_triangles).value();
  const float half_width = static_cast<float>(std::sqrt(3e-8));
  std::mt19937 generator(7);
  const auto noise = [&] { return half_width * (static_cast<float>(generator()) / 2147483648.0f - 1.0f); };
  double error = 0.0;
  for (int trial = 0; trial < num_trials; ++trial) {
    std::vector<Vec3f> base_positions(mesh.positions.begin(), mesh.positions.begin() + mesh.num_base_vertices);
    std::vector<LevelCoefficients> noisy = levels;
    if (set.level == 0) {
      for (Vec3f& p : base_positions) p[static_cast<int>(set.kind)] += noise();
    } else {
      for (Vec3f& d : noisy[static_cast<size_t>(set.level) - 1].detail) {
        d += set.kind == SetKind::kNormal ? Vec3f{0, 0, noise()} : Vec3f{noise(), noise(), 0};
      }
    }
    const std::vector<Vec3f> decoded = shapes::Synthesize(base, base_positions, noisy);
    for (size_t v = 0; v < decoded.size(); ++v)
      error += SquaredNorm(Vec3Cast<double>(decoded[v]) - Vec3Cast<double>(mesh.positions[v]));
  }
  return error / (static_cast<double>(mesh.positions.size()) * num_trials);
}

// The weights (10)-(11) hold for the real synthesis with its moving frames.
TEST(WeightsTest, PredictTheErrorOfNoiseInEachSet) {
  for (const TriangleMesh& base : {shapes::Icosahedron(), shapes::Torus(5, 7), shapes::Bipyramid(9)}) {
    const SemiRegularMesh mesh = shapes::Subdivided(base, 3, shapes::Bumpy);
    const std::vector<LevelCoefficients> levels = Analyze(mesh).value();
    const std::vector<double> energies = ProbeEnergies(shapes::TopologyOf(base), 3, 300);
    const std::vector<SetStatistics> sets = Describe(mesh.positions, mesh.num_base_vertices, levels, energies);
    ASSERT_EQ(sets.size(), 9u);
    for (const SetStatistics& set : sets) {
      SCOPED_TRACE(::testing::Message() << "level " << set.level << " kind " << static_cast<int>(set.kind));
      const double predicted = set.weight * 1e-8;
      EXPECT_NEAR(NoiseError(mesh, levels, set, set.level < 2 ? 400 : 20), predicted,
                  (set.level == 0 ? 0.08 : 0.05) * predicted);
    }
  }
}

}  // namespace
}  // namespace lacerta
