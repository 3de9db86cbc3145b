#include "encoder/allocation/rate_distortion_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <limits>

#include "encoder/allocation/generalized_gaussian.h"

namespace lacerta {
namespace {

TEST(RateDistortionTableTest, AgreesWithTheQuantizerBetweenItsKnots) {
  for (const double alpha : {0.2, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 4.0}) {
    const RateDistortionTable table(alpha);
    for (double q = 3e-7; q < 3; q *= 1.37) {
      SCOPED_TRACE(::testing::Message() << "alpha " << alpha << " q " << q);
      const QuantizerPoint exact = EvaluateUniformQuantizer(alpha, q);
      EXPECT_NEAR(table.RateAtStep(q), exact.rate, 5e-4 * exact.rate);
      EXPECT_NEAR(table.DistortionAtStep(q), exact.distortion, 1e-3 * exact.distortion);
      if (alpha > 2.0 && q > 2.0) continue;  // not convex
      EXPECT_NEAR(table.StepAtSlope(std::log(exact.slope)), q, 1e-3 * q);
      EXPECT_NEAR(table.RateAtSlope(std::log(exact.slope)), exact.rate, 2e-3 * exact.rate);
    }
  }
}

TEST(RateDistortionTableTest, IsMonotone) {
  for (const double alpha : {0.2, 0.6, 1.0, 2.0, 3.0, 4.0}) {
    const RateDistortionTable table(alpha);
    EXPECT_LT(table.min_log_slope(), std::log(1e-12));
    double last_rate = 100.0, last_step = 0.0;
    for (double s = table.min_log_slope(); s <= table.max_log_slope(); s += 0.01) {
      EXPECT_LE(table.RateAtSlope(s), last_rate + 1e-12);
      EXPECT_GE(table.StepAtSlope(s), last_step);
      last_rate = table.RateAtSlope(s);
      last_step = table.StepAtSlope(s);
    }
    double last_distortion = 0.0;
    for (double q = 1e-9; q < 1e5; q *= 1.05) {
      EXPECT_GE(table.DistortionAtStep(q), last_distortion);
      last_distortion = table.DistortionAtStep(q);
    }
    EXPECT_EQ(last_distortion, 1.0);
  }
}

TEST(RateDistortionTableTest, EndsOfTheStepRange) {
  const RateDistortionTable table(0.8);
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(table.RateAtStep(inf), 0.0);
  EXPECT_EQ(table.DistortionAtStep(inf), 1.0);
  EXPECT_NEAR(table.RateAtStep(1e-9) - table.RateAtStep(1e-8), std::log2(10.0), 1e-6);
  EXPECT_NEAR(table.DistortionAtStep(1e-9), 1e-18 / 12, 1e-22);
}

TEST(RateDistortionTableTest, BringsAlphaIntoRange) {
  EXPECT_EQ(RateDistortionTable(0.01).alpha(), kMinAlpha);
  EXPECT_EQ(RateDistortionTable(50.0).alpha(), kMaxAlpha);
  EXPECT_EQ(RateDistortionTable(0.7).alpha(), 0.7);
}

TEST(RateDistortionTableTest, IsQuickToMake) {
  // 20 tables, more than any mesh has sets: some 15 ms in release, an order more with sanitizers.
  const std::clock_t start = std::clock();
  double sum = 0.0;
  for (int i = 0; i < 20; ++i) sum += RateDistortionTable(0.2 + 0.1 * i).RateAtStep(1.0);
  EXPECT_GT(sum, 20.0);
  EXPECT_LT(std::clock() - start, 6 * CLOCKS_PER_SEC / 10);
}

}  // namespace
}  // namespace lacerta
