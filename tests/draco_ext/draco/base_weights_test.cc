#include "draco/base_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace lacerta {
namespace {

TEST(BaseWeights, StepsArePowersOfTwoNearTheError) {
  EXPECT_EQ(WeightStep(1.0 / 256), 1.0f / 256);
  EXPECT_EQ(WeightStep(1.0 / 200), 1.0f / 256);
  EXPECT_EQ(WeightStep(2.0), 1.0f / 8);
  EXPECT_EQ(WeightStep(1e-12), 1.0f / 16384);
}

TEST(BaseWeights, RoundedOnesAddUpToOne) {
  constexpr float kStep = 1.0f / 64;
  for (uint32_t seed = 1; seed < 200; ++seed) {
    std::vector<float> row;
    for (uint32_t c = 0; c < 6; ++c) row.push_back(static_cast<float>(seed * (c + 1) * 2654435761u % 1000));
    std::vector<int32_t> points = {7};
    AppendRoundedWeights(row.data(), 6, kStep, &points);
    ASSERT_EQ(points.size(), 7u);
    EXPECT_EQ(std::accumulate(points.begin() + 1, points.end(), 0), 64);
    EXPECT_GE(*std::min_element(points.begin(), points.end()), 0);
    EXPECT_LE(std::count_if(points.begin() + 1, points.end(), [](int32_t p) { return p > 0; }), 4);
    const FourWeights four = LargestFour(row.data(), {0, 1, 2, 3, 4, 5});
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(static_cast<float>(points[1u + four.joints[i]]) * kStep, four.weights[i], kStep);
    }
  }
}

TEST(BaseWeights, JointsKeepTheirPlaceWhereItIsFree) {
  const JointTable joints = {2, 3, 6};
  const std::vector<int32_t> points = {0, 64, 0, 40, 0, 24, 10, 30, 24};
  const PlacedWeights placed = PlaceWeights(points.data(), 3, 1.0f / 64, joints);
  EXPECT_EQ(placed.points, (std::vector<int32_t>{0, 0, 0, 64, 0, 0, 40, 24, 10, 0, 24, 30}));
  EXPECT_EQ(placed.joints, (std::vector<uint16_t>{0, 0, 0, 3, 0, 0, 2, 6, 2, 0, 6, 3}));
}

}  // namespace
}  // namespace lacerta
