#include "encoder/allocation/set_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "encoder/allocation/subband_weights.h"
#include "shapes/base_meshes.h"

namespace lacerta {
namespace {

TEST(DescribeTest, CountsOrderAndSharesOfTheSets) {
  const SemiRegularMesh mesh = shapes::Subdivided(shapes::Icosahedron(), 4, shapes::Bumpy);
  const std::vector<LevelCoefficients> levels = Analyze(mesh).value();
  const std::vector<SetStatistics> sets = Describe(mesh.positions, 12, levels, RegularEnergies(4));
  ASSERT_EQ(sets.size(), 3u + 2u * 4u);
  double share = 0.0;
  for (size_t k = 0; k < sets.size(); ++k) {
    const int level = k < 3 ? 0 : static_cast<int>(k - 1) / 2;
    EXPECT_EQ(sets[k].level, level);
    const SetKind kinds[] = {SetKind::kTangential, SetKind::kNormal};
    EXPECT_EQ(sets[k].kind, k < 3 ? static_cast<SetKind>(k) : kinds[(k - 3) % 2]);
    share += sets[k].sample_fraction;
  }
  EXPECT_NEAR(share, 1.0, 1e-12);
  EXPECT_EQ(sets[0].count, 12u);
  EXPECT_EQ(sets[3].count, 60u);  // level 1: 30 edges, two tangential coordinates
  EXPECT_EQ(sets[4].count, 30u);
  // Published weights of a detail band: 0.75, 0.495, 0.472 from the finest; the base tends to 0.627.
  EXPECT_NEAR(sets[10].weight, 0.75, 0.002);
  EXPECT_NEAR(sets[8].weight, 0.495, 0.002);
  EXPECT_NEAR(sets[6].weight, 0.472, 0.002);
  EXPECT_NEAR(sets[9].weight, 2 * sets[10].weight, 1e-12);
  EXPECT_NEAR(sets[0].weight, 0.627, 0.13);  // 12 of 2562 vertices, not yet 1 / 256
}

TEST(DescribeTest, StatisticsAreThoseOfTheSamples) {
  LevelCoefficients level;
  level.detail = {{1, -1, 3}, {-1, 1, 3}, {1, 1, 3}};
  const std::vector<Vec3f> positions = {{10, 0, 1}, {12, 0, -1}, {11, 0, 0}, {}, {}, {}};
  const std::vector<SetStatistics> sets = Describe(positions, 3, {level}, {4.0, 1.0});
  ASSERT_EQ(sets.size(), 5u);
  EXPECT_NEAR(sets[0].sigma, std::sqrt(2.0 / 3), 1e-12);  // about the mean
  EXPECT_EQ(sets[1].sigma, 0.0);
  EXPECT_NEAR(sets[2].sigma, std::sqrt(2.0 / 3), 1e-12);
  EXPECT_NEAR(sets[3].sigma, 1.0, 1e-12);
  EXPECT_NEAR(sets[4].sigma, 3.0, 1e-12);  // about zero
  EXPECT_NEAR(sets[0].weight, 0.5 * 4.0, 1e-12);
  EXPECT_NEAR(sets[3].weight, 1.0, 1e-12);
  EXPECT_NEAR(sets[4].weight, 0.5, 1e-12);
  EXPECT_NEAR(sets[3].sample_fraction, 6.0 / 18, 1e-12);
}

TEST(DescribeTest, ZeroesAreSetApart) {
  LevelCoefficients level;
  level.mean_edge_length = 1.0;
  level.detail = {{1, -1, 0.5f}, {1e-6f, 0, 0.5f}, {0, -1e-5f, 0.5f}, {0, 0, -0.5f}};
  const std::vector<Vec3f> positions(8);
  const SetStatistics apart = Describe(positions, 4, {level}, {4.0, 1.0})[3];
  EXPECT_DOUBLE_EQ(apart.active, 0.25);
  EXPECT_EQ(apart.count, 8u);
  EXPECT_NEAR(apart.sigma, 0.5, 1e-9);  // of all eight
  EXPECT_NEAR(apart.sample_fraction, 1.0 / 3, 1e-12);
  const SetStatistics paper = Describe(positions, 4, {level}, {4.0, 1.0}, {0.0})[3];
  EXPECT_EQ(paper.active, 1.0);
  EXPECT_NEAR(paper.sigma, 0.5, 1e-9);
  EXPECT_LT(paper.alpha, apart.alpha);
  level.detail = {{0, 0, 1}, {1e-5f, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  const SetStatistics nothing = Describe(positions, 4, {level}, {4.0, 1.0})[3];
  EXPECT_EQ(nothing.sigma, 0.0);
  EXPECT_EQ(nothing.active, 1.0);
}

TEST(DescribeTest, MeshWithoutLevelsHasTheBaseSetsAlone) {
  const TriangleMesh base = shapes::Tetrahedron();
  const std::vector<SetStatistics> sets = Describe(base.positions, 4, {}, RegularEnergies(0));
  ASSERT_EQ(sets.size(), 3u);
  EXPECT_DOUBLE_EQ(sets[0].weight, 1.0);
  EXPECT_NEAR(sets[0].sample_fraction, 1.0 / 3, 1e-15);
}

}  // namespace
}  // namespace lacerta
