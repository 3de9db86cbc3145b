#include "encoder/step_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/step_forecast.h"
#include "draco_ext/remesh/remeshing.h"

namespace lacerta {
namespace {

using lacerta::testing::Remesh;
using lacerta::testing::Scaled;

SurfaceTarget Bumps() { return MakeSurfaceTarget(Remesh(shapes::BumpySphere(5, 0.1f, 0.002f), 60, 4)); }

TEST(DetailScales, FallFromLevelToLevelOnSmoothSurfaces) {
  const std::vector<double> scales = DetailScales(MakeSurfaceTarget(Remesh(shapes::Icosphere(5), 60, 4)));
  ASSERT_EQ(scales.size(), 4u);
  for (size_t i = 0; i < scales.size(); ++i) {
    EXPECT_GT(scales[i], 0);
    EXPECT_LT(scales[i], 0.2);
    if (i > 0) {
      EXPECT_LT(scales[i], 0.6 * scales[i - 1]);
    }
  }
}

TEST(DetailScales, AreLengths) {
  const TriangleMesh input = shapes::BumpySphere(3);
  const std::vector<double> small = DetailScales(MakeSurfaceTarget(Remesh(input, 40, 2)));
  const std::vector<double> large = DetailScales(MakeSurfaceTarget(Remesh(Scaled(input, 64), 40, 2)));
  for (size_t i = 0; i < small.size(); ++i) EXPECT_NEAR(large[i] / small[i], 64, 0.1);
}

TEST(StepsForSlope, DoubleWithEveryLevelWithoutDetailAndGrowMoreSlowlyBelow) {
  const SurfaceTarget target = Bumps();
  const std::vector<double> scales = DetailScales(target);
  const std::vector<LevelSteps> coarse = StepsForSlope(target, scales, 1.0);  // no level carries detail
  const std::vector<LevelSteps> fine = StepsForSlope(target, scales, 1e-16);  // all of them do
  for (size_t i = 1; i < coarse.size(); ++i) {
    EXPECT_NEAR(coarse[i].normal_step / coarse[i - 1].normal_step, 2, 0.1);
    EXPECT_NEAR(fine[i].normal_step / fine[i - 1].normal_step, 1.2, 0.01);
    EXPECT_EQ(StepToBits(fine[i].normal_step), NextStepBits(StepToBits(fine[i - 1].normal_step))) << "costs bytes in the header";
  }
}

TEST(StepsForSlope, GrowWithTheSlopeAndAreWhatAStreamHolds) {
  const SurfaceTarget target = Bumps();
  const std::vector<double> scales = DetailScales(target);
  float last = 0;
  for (const double lambda : {1e-14, 1e-12, 1e-10, 1e-8, 1e-6}) {
    const std::vector<LevelSteps> steps = StepsForSlope(target, scales, lambda);
    ASSERT_EQ(steps.size(), 4u);
    for (const LevelSteps& s : steps) {
      EXPECT_EQ(RoundStep(s.normal_step), s.normal_step);
      EXPECT_EQ(RoundStep(s.tangential_step), s.tangential_step);
      EXPECT_NEAR(s.tangential_step / s.normal_step, 2, 0.03);
    }
    EXPECT_GT(steps[0].normal_step, last);
    last = steps[0].normal_step;
  }
}

TEST(BaseStepForSlope, IsTheRootOfTheSlopeAndFinerForSmallBases) {
  EXPECT_NEAR(BaseStepForSlope(4e-10, 300) / BaseStepForSlope(1e-10, 300), 2, 1e-9);
  EXPECT_GT(BaseStepForSlope(1e-10, 300), 1e-4);
  EXPECT_LT(BaseStepForSlope(1e-10, 300), 1e-1);
  EXPECT_LT(BaseStepForSlope(1e-10, 50), 0.8 * BaseStepForSlope(1e-10, 150));
  EXPECT_GT(BaseStepForSlope(1e-10, 4), 0.3 * BaseStepForSlope(1e-10, 1e6));
}

}  // namespace
}  // namespace lacerta
