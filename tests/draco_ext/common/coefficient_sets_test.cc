#include "common/coefficient_sets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lacerta {
namespace {

TEST(RoundStepTest, IsNearestAndIdempotent) {
  for (float step = 1e-37f; step < 1e38f; step *= 1.37f) {
    const float rounded = RoundStep(step);
    EXPECT_LE(std::fabs(rounded - step), step / 256);
    EXPECT_EQ(RoundStep(rounded), rounded);
    EXPECT_EQ(StepFromBits(StepToBits(rounded)), rounded);
  }
  EXPECT_EQ(RoundStep(1.0f), 1.0f);
  EXPECT_EQ(RoundStep(0.1f), 0.10009765625f);
}

TEST(RoundStepTest, StaysInTheRangeOfTheStream) {
  EXPECT_EQ(RoundStep(0.0f), 0.0f);
  EXPECT_EQ(RoundStep(-1.0f), 0.0f);
  EXPECT_EQ(RoundStep(1e-40f), 0.0f);
  EXPECT_EQ(RoundStep(std::numeric_limits<float>::infinity()), 0.0f);
  EXPECT_EQ(RoundStep(std::numeric_limits<float>::quiet_NaN()), 0.0f);
  EXPECT_TRUE(std::isfinite(RoundStep(std::numeric_limits<float>::max())));
}

TEST(DequantizeTest, PullsTowardZeroByTheBias) {
  EXPECT_EQ(Dequantize(0, 2.0f, 15), 0.0f);
  EXPECT_EQ(Dequantize(3, 2.0f, 0), 6.0f);
  EXPECT_EQ(Dequantize(-3, 2.0f, 0), -6.0f);
  EXPECT_EQ(Dequantize(1, 2.0f, 8), 1.5f);
  EXPECT_EQ(Dequantize(-1, 2.0f, 8), -1.5f);
  EXPECT_EQ(Dequantize(kMaxMagnitude, 1.0f, 0), static_cast<float>(kMaxMagnitude));
}

}  // namespace
}  // namespace lacerta
