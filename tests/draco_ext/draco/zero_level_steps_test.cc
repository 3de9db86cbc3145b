#include "draco/zero_level_steps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "draco/candidate_search.h"
#include "remesh/simplify.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

class ZeroLevelStepsTest : public ::testing::Test {
 protected:
  ZeroLevelStepsTest()
      : mesh_(shapes::BumpySphere(5, 0.2f)), meter_(SurfaceDistanceMeter::Create(mesh_).value()), fit_target_(mesh_, 8000),
        candidate_(fit_target_, SimplificationSequence(mesh_).MeshWith(1000), ZeroLevelCandidate::Source::kSimplified) {}

  // A PSNR so many dB below what the mesh has without a lattice.
  ResolvedTarget Below(double decibels) const { return {false, 0, Psnr(std::sqrt(candidate_.fit_distortion()), meter_.diagonal()) - decibels}; }

  TriangleMesh mesh_;
  SurfaceDistanceMeter meter_;
  FitTarget fit_target_;
  ZeroLevelCandidate candidate_;
};

TEST_F(ZeroLevelStepsTest, MeetsAPsnrClosely) {
  const ResolvedTarget target = Below(2);
  const ZeroLevelTrial trial = TrySteps(target, meter_, 1, &candidate_).value();
  EXPECT_TRUE(trial.meets);
  const FinishedZeroLevel finished = FinishSteps(target, meter_, candidate_, trial.step, 1).value();
  EXPECT_TRUE(finished.stream.meets_target);
  EXPECT_GE(finished.stream.psnr, target.psnr);
  EXPECT_LT(finished.stream.psnr, target.psnr + 0.3);
  EXPECT_NEAR(static_cast<double>(finished.stream.stream.size()), static_cast<double>(trial.bytes), 0.1 * static_cast<double>(trial.bytes));
  EXPECT_GE(finished.stream.measurements, 1);
  EXPECT_LE(finished.stream.measurements, CandidateSearch::kMostMeasurements);
  EXPECT_NEAR(finished.bias, 1, 0.3);
}

TEST_F(ZeroLevelStepsTest, FillsANumberOfBytes) {
  const ResolvedTarget target{true, 1200, 0};
  const ZeroLevelTrial trial = TrySteps(target, meter_, 1, &candidate_).value();
  const FinishedZeroLevel finished = FinishSteps(target, meter_, candidate_, trial.step, 1).value();
  EXPECT_TRUE(finished.stream.meets_target);
  EXPECT_LE(finished.stream.stream.size(), 1200u);
  EXPECT_GE(finished.stream.stream.size(), 1100u);
}

// Where full measures are known to be larger than those by the samples, finer steps are needed for the same target.
TEST_F(ZeroLevelStepsTest, TrialsRegardWhatFullMeasuresSaid) {
  const ResolvedTarget target = Below(3);
  const ZeroLevelTrial usual = TrySteps(target, meter_, 1, &candidate_).value(), biased = TrySteps(target, meter_, 1.5, &candidate_).value();
  EXPECT_TRUE(biased.meets);
  EXPECT_LT(biased.step, 0.9 * usual.step);
  EXPECT_GT(biased.step, 0.3 * usual.step);
  EXPECT_GT(biased.bytes, usual.bytes);
  EXPECT_FALSE(TrySteps(target, meter_, 3, &candidate_).value().meets) << "what is wanted then is nearer than the mesh without a lattice";
}

TEST_F(ZeroLevelStepsTest, NoStepMeetsWhatTheMeshMisses) {
  const ResolvedTarget target = Below(-1);
  const ZeroLevelTrial trial = TrySteps(target, meter_, 1, &candidate_).value();
  EXPECT_FALSE(trial.meets);
  EXPECT_GT(trial.score, 1e8);
  const FinishedZeroLevel finished = FinishSteps(target, meter_, candidate_, trial.step, 1).value();
  EXPECT_FALSE(finished.stream.meets_target);
  EXPECT_GT(finished.stream.psnr, target.psnr - 1.5) << "but comes near";
}

}  // namespace
}  // namespace lacerta
