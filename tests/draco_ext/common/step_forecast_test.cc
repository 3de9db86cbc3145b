#include "common/step_forecast.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/coefficient_sets.h"

namespace lacerta {
namespace {

TEST(StepForecastTest, CodesAreThoseOfPositiveNormalSteps) {
  for (int bits = 0; bits < 0x10000; ++bits) {
    const float step = StepFromBits(static_cast<uint16_t>(bits));
    EXPECT_EQ(IsStepBits(bits), step > 0 && std::isnormal(step)) << bits;
  }
  EXPECT_FALSE(IsStepBits(-1));
  EXPECT_FALSE(IsStepBits(int64_t{1} << 40));
}

TEST(StepForecastTest, NextStepIsTheRoundedOneOfSixFifths) {
  for (int bits = kLeastStepBits; bits < kMostStepBits - 64; ++bits) {
    const float next = StepFromBits(static_cast<uint16_t>(NextStepBits(bits)));
    ASSERT_EQ(next, RoundStep(1.2f * StepFromBits(static_cast<uint16_t>(bits)))) << bits;
  }
  for (int bits = kMostStepBits - 64; bits <= kMostStepBits; ++bits) {
    EXPECT_GT(NextStepBits(bits), bits - 1);
    EXPECT_LE(NextStepBits(bits), kMostStepBits);
  }
  EXPECT_EQ(NextStepBits(kMostStepBits), kMostStepBits);
}

TEST(StepForecastTest, TangentialStepIsTwiceTheNormalOne) {
  for (const float step : {0.001f, 1.0f, 1e20f}) {
    const float normal = RoundStep(step);
    EXPECT_EQ(TangentialStepBits(StepToBits(normal)), StepToBits(2 * normal));
  }
}

}  // namespace
}  // namespace lacerta
