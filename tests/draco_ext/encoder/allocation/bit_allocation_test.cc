#include "encoder/allocation/bit_allocation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <vector>

#include "encoder/allocation/generalized_gaussian.h"
#include "encoder/allocation/subband_weights.h"

namespace lacerta {
namespace {

using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

SetStatistics MakeSet(double sigma, double alpha, double weight, double fraction) {
  SetStatistics set;
  set.count = 1000;
  set.sigma = sigma;
  set.alpha = alpha;
  set.weight = weight;
  set.sample_fraction = fraction;
  return set;
}

// The sets of a typical normal mesh: sigma falls by 3 per level, tangential parts are small and peaked.
std::vector<SetStatistics> TypicalSets(int num_levels) {
  const std::vector<double> energies = RegularEnergies(num_levels);
  const double finest = std::ldexp(1.0, 2 * num_levels);
  std::vector<SetStatistics> sets;
  for (int axis = 0; axis < 3; ++axis) {
    sets.push_back(MakeSet(0.3 + 0.1 * axis, 1.8, energies[0] / finest, 1 / (3 * finest)));
    sets.back().level = 0;
    sets.back().kind = static_cast<SetKind>(axis);
  }
  for (int level = 1; level <= num_levels; ++level) {
    const double share = 0.75 * std::ldexp(1.0, 2 * level) / finest, sigma = 0.03 * std::pow(3.0, 1 - level);
    for (const SetKind kind : {SetKind::kTangential, SetKind::kNormal}) {
      const double parts = kind == SetKind::kTangential ? 2.0 : 1.0;
      sets.push_back(MakeSet(kind == SetKind::kTangential ? 0.05 * sigma : sigma,
                             kind == SetKind::kTangential ? 0.3 : 0.7,
                             parts * share * energies[static_cast<size_t>(level)], parts * share / 3));
      sets.back().level = level;
      sets.back().kind = kind;
    }
  }
  return sets;
}

BitAllocation Allocate(const std::vector<SetStatistics>& sets, double target, const AllocationOptions& options = {}) {
  StatusOr<BitAllocation> allocation = AllocateBits(sets, target, options);
  EXPECT_TRUE(allocation.ok()) << allocation.status().message();
  return allocation.ok() ? std::move(allocation).value() : BitAllocation{};
}

// Rate and distortion of given steps by the exact quantizer, without the tables.
struct Exact {
  double rate = 0.0, distortion = 0.0;
};
Exact Evaluate(const std::vector<SetStatistics>& sets, const std::vector<double>& steps) {
  Exact sum;
  for (size_t k = 0; k < sets.size(); ++k) {
    QuantizerPoint point{1.0, 0.0, 0.0};
    if (std::isfinite(steps[k])) point = EvaluateUniformQuantizer(sets[k].alpha, steps[k] / sets[k].sigma);
    sum.rate += sets[k].sample_fraction * point.rate;
    sum.distortion += sets[k].weight * sets[k].sigma * sets[k].sigma * point.distortion;
  }
  return sum;
}

TEST(BitAllocationTest, MeetsTheTargetFromBothSides) {
  for (const double ratio : {0.0, 1.5}) {
    for (const double exponent : {1.0, 0.4, 0.0}) {
      for (const double target : {0.001, 0.01, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0}) {
        SCOPED_TRACE(::testing::Message() << "ratio " << ratio << " exponent " << exponent << " target " << target);
        const std::vector<SetStatistics> sets = TypicalSets(5);
        const BitAllocation allocation = Allocate(sets, target, {exponent, ratio});
        EXPECT_LE(allocation.predicted_rate, target);
        EXPECT_GE(allocation.predicted_rate, 0.9999 * target);
        const Exact exact = Evaluate(sets, allocation.steps);
        EXPECT_NEAR(exact.rate, target, 0.003 * target);
        EXPECT_NEAR(exact.distortion, allocation.predicted_distortion, 0.003 * exact.distortion);
      }
    }
  }
}

TEST(BitAllocationTest, SlopesOfAllCodedSetsAreEqual) {
  for (const double target : {0.05, 0.5, 2.0, 8.0}) {
    const std::vector<SetStatistics> sets = TypicalSets(4);
    const BitAllocation allocation = Allocate(sets, target);
    int coded = 0;
    for (size_t k = 0; k < sets.size(); ++k) {
      if (!std::isfinite(allocation.steps[k])) continue;
      ++coded;
      const QuantizerPoint point = EvaluateUniformQuantizer(sets[k].alpha, allocation.steps[k] / sets[k].sigma);
      const double lambda = sets[k].weight * sets[k].sigma * sets[k].sigma * point.slope / sets[k].sample_fraction;
      EXPECT_NEAR(lambda, allocation.lambda, 0.004 * allocation.lambda) << "set " << k << " target " << target;
      EXPECT_NEAR(allocation.rates[k], point.rate, 0.004 * point.rate + 1e-6);
    }
    EXPECT_GE(coded, 5);
  }
}

TEST(BitAllocationTest, HighRateStepsFollowTheEnergies) {
  const std::vector<SetStatistics> sets = TypicalSets(5);
  for (const double exponent : {1.0, 0.4, 0.0}) {
    const BitAllocation allocation = Allocate(sets, 7.0, {exponent, 0.0});
    const std::vector<double> energies = RegularEnergies(5);
    for (size_t k = 0; k < sets.size(); ++k) {
      if (sets[k].kind == SetKind::kTangential) continue;  // alpha 0.3 gets there later
      const double expected =
          allocation.steps.back() * std::pow(energies[static_cast<size_t>(sets[k].level)], -0.5 * exponent);
      EXPECT_NEAR(allocation.steps[k], expected, 0.005 * expected) << "exponent " << exponent << " set " << k;
    }
  }
}

TEST(BitAllocationTest, MoreRateMeansSmallerStepsAndLessDistortion) {
  const std::vector<SetStatistics> sets = TypicalSets(5);
  BitAllocation last = Allocate(sets, 0.01);
  for (double target = 0.02; target < 10; target *= 1.3) {
    const BitAllocation next = Allocate(sets, target);
    EXPECT_LT(next.lambda, last.lambda);
    EXPECT_LT(next.predicted_distortion, last.predicted_distortion);
    for (size_t k = 0; k < sets.size(); ++k) EXPECT_LE(next.steps[k], last.steps[k]);
    last = next;
  }
}

TEST(BitAllocationTest, RateFallsAsLambdaGrows) {
  const StatusOr<BitAllocator> allocator = BitAllocator::Create(TypicalSets(5), {1.0, 1.5});
  ASSERT_TRUE(allocator.ok());
  double last = 1e9;
  for (double lambda = 1e-15; lambda < 1e6; lambda *= 1.7) {
    const double rate = allocator.value().ForSlope(lambda).predicted_rate;
    EXPECT_LE(rate, last + 1e-12);
    last = rate;
  }
  EXPECT_EQ(last, 0.0);
}

TEST(BitAllocationTest, SlopeOfAnAllocationGivesItBack) {
  const std::vector<SetStatistics> sets = TypicalSets(3);
  const BitAllocation by_rate = Allocate(sets, 1.0);
  const StatusOr<BitAllocation> by_slope = AllocateForSlope(sets, by_rate.lambda);
  ASSERT_TRUE(by_slope.ok());
  for (size_t k = 0; k < sets.size(); ++k) {
    if (std::isfinite(by_rate.steps[k])) {
      EXPECT_NEAR(by_slope.value().steps[k], by_rate.steps[k], 1e-9 * by_rate.steps[k]);
    }
  }
}

TEST(BitAllocationTest, EqualSetsGetEqualSteps) {
  const SetStatistics set = MakeSet(0.1, 0.8, 0.3, 0.25);
  const BitAllocation allocation = Allocate({set, set, set, set}, 1.0);
  for (const double step : allocation.steps) EXPECT_EQ(step, allocation.steps[0]);
  EXPECT_NEAR(allocation.rates[0], 1.0, 1e-6);
}

TEST(BitAllocationTest, ScalesWithTheModel) {
  std::vector<SetStatistics> sets = TypicalSets(4);
  const BitAllocation before = Allocate(sets, 0.7, {1.0, 1.5});
  for (const double scale : {1e-9, 1e-3, 1e6}) {
    std::vector<SetStatistics> scaled = sets;
    for (SetStatistics& set : scaled) set.sigma *= scale;
    const BitAllocation after = Allocate(scaled, 0.7, {1.0, 1.5});
    EXPECT_NEAR(after.predicted_distortion / (scale * scale), before.predicted_distortion,
                1e-6 * before.predicted_distortion);
    for (size_t k = 0; k < sets.size(); ++k) {
      EXPECT_EQ(std::isfinite(after.steps[k]), std::isfinite(before.steps[k]));
      if (std::isfinite(before.steps[k])) {
        EXPECT_NEAR(after.steps[k] / scale, before.steps[k], 1e-6 * before.steps[k]);
      }
    }
  }
}

// The least distortion of two or three sets within the rate, by trying all steps of a fine grid.
double BruteForce(const std::vector<SetStatistics>& sets, double target) {
  std::vector<std::vector<std::pair<double, double>>>
      curves;  // by set: (rate share, distortion) per step, rates falling
  for (const SetStatistics& set : sets) {
    curves.emplace_back();
    for (double q = 1e-3; q < 200; q *= 1.01) {
      const QuantizerPoint point = EvaluateUniformQuantizer(set.alpha, q);
      if (point.rate < 1e-7) break;
      curves.back().emplace_back(set.sample_fraction * point.rate,
                                 set.weight * set.sigma * set.sigma * point.distortion);
    }
    curves.back().emplace_back(0.0, set.weight * set.sigma * set.sigma);
  }
  while (curves.size() < 3) curves.push_back({{0.0, 0.0}});
  double best = kInfinity;
  for (const auto& a : curves[0]) {
    for (const auto& b : curves[2]) {
      const double left = target - a.first - b.first;
      if (left < 0.0) continue;
      const auto c = std::lower_bound(curves[1].begin(), curves[1].end(), left,
                                      [](const auto& point, double rate) { return point.first > rate; });
      best = std::min(best, a.second + b.second + c->second);
    }
  }
  return best;
}

TEST(BitAllocationTest, AgreesWithBruteForce) {
  const std::vector<std::vector<SetStatistics>> problems = {
      {MakeSet(1.0, 1.0, 0.7, 0.5), MakeSet(0.2, 0.5, 0.5, 0.5)},
      {MakeSet(0.01, 0.3, 1.5, 0.6), MakeSet(0.3, 0.7, 0.4, 0.4)},
      {MakeSet(1.0, 2.0, 0.6, 0.05), MakeSet(0.1, 0.6, 0.5, 0.3), MakeSet(0.02, 0.4, 0.75, 0.65)},
      {MakeSet(1.0, 0.9, 1.0, 0.2), MakeSet(1.0, 0.9, 0.1, 0.4), MakeSet(1.0, 0.5, 1.0, 0.4)}};
  for (const std::vector<SetStatistics>& sets : problems) {
    for (const double target : {0.1, 0.5, 1.5, 3.0}) {
      const double brute = BruteForce(sets, target), ours = Evaluate(sets, Allocate(sets, target).steps).distortion;
      EXPECT_LE(ours, 1.005 * brute) << target;
      EXPECT_GE(ours, 0.97 * brute) << target;  // the grid of 1 % steps wastes a little
    }
  }
}

TEST(BitAllocationTest, MixtureWithZerosTakesPartInTheSystem) {
  std::vector<SetStatistics> sets = TypicalSets(4);
  for (size_t k = 3; k < sets.size(); k += 2) sets[k].active = 0.02;
  for (const double target : {0.1, 1.0, 4.0}) {
    const BitAllocation allocation = Allocate(sets, target);
    EXPECT_LE(allocation.predicted_rate, target);
    EXPECT_GE(allocation.predicted_rate, 0.999 * target);
    for (size_t k = 3; k < sets.size(); k += 2) {
      if (!std::isfinite(allocation.steps[k])) continue;
      const QuantizerPoint point = EvaluateUniformQuantizer(sets[k].alpha, allocation.steps[k] / sets[k].sigma, 0.02);
      const double lambda = sets[k].weight * sets[k].sigma * sets[k].sigma * point.slope / sets[k].sample_fraction;
      EXPECT_NEAR(lambda, allocation.lambda, 0.005 * allocation.lambda) << "set " << k << " target " << target;
      EXPECT_LT(allocation.rates[k],
                0.02 * 26 + 0.15);  // the entropy of the zero flag and at most 26 bits of each active sample
    }
  }
}

TEST(BitAllocationTest, LeavesOutSetsWithoutSpreadOrSamples) {
  std::vector<SetStatistics> sets = TypicalSets(3);
  sets[1].sigma = 0.0;
  sets[4].weight = 0.0;
  sets[5].sample_fraction = 0.0;
  const BitAllocation allocation = Allocate(sets, 1.0);
  for (const size_t k : {size_t{1}, size_t{4}, size_t{5}}) {
    EXPECT_EQ(allocation.steps[k], kInfinity);
    EXPECT_EQ(allocation.rates[k], 0.0);
  }
  EXPECT_NEAR(allocation.predicted_rate, 1.0, 1e-4);
}

TEST(BitAllocationTest, NothingToCodeCostsNothing) {
  for (const std::vector<SetStatistics>& sets : {std::vector<SetStatistics>{}, {MakeSet(0.0, 1.0, 1.0, 1.0)}}) {
    const BitAllocation allocation = Allocate(sets, 2.0);
    EXPECT_EQ(allocation.steps.size(), sets.size());
    EXPECT_EQ(allocation.predicted_rate, 0.0);
    EXPECT_EQ(allocation.predicted_distortion, 0.0);
  }
}

TEST(BitAllocationTest, TargetBeyondReachGivesTheFinestSteps) {
  const std::vector<SetStatistics> sets = {MakeSet(1.0, 1.0, 1.0, 0.5), MakeSet(1.0, 1.0, 1.0, 0.5)};
  const BitAllocation allocation = Allocate(sets, 1000.0);
  EXPECT_NEAR(allocation.steps[0], std::ldexp(1.0, -24), 1e-12);
  EXPECT_GT(allocation.predicted_rate, 24.0);
  EXPECT_LT(allocation.predicted_rate, 27.0);
}

TEST(BitAllocationTest, TinyTargetCodesNextToNothing) {
  const BitAllocation allocation = Allocate(TypicalSets(4), 1e-9);
  EXPECT_LE(allocation.predicted_rate, 1e-9);
  EXPECT_EQ(*std::max_element(allocation.steps.begin(), allocation.steps.end()), kInfinity);
}

TEST(BitAllocationTest, FlatDensityIsDroppedRatherThanCodedBadly) {
  // Above alpha = 2 the curve is not convex: some rates cannot be had, and what is given stays below the target.
  const std::vector<SetStatistics> sets = {MakeSet(1.0, 4.0, 1.0, 1.0)};
  const StatusOr<BitAllocator> allocator = BitAllocator::Create(sets, {});
  ASSERT_TRUE(allocator.ok());
  bool coded = false, dropped = false;
  for (double lambda = 0.01; lambda < 2.0; lambda *= 1.02) {
    const BitAllocation allocation = allocator.value().ForSlope(lambda);
    EXPECT_LE(allocation.predicted_distortion + lambda * allocation.predicted_rate, 1.0 + 1e-9);
    (std::isfinite(allocation.steps[0]) ? coded : dropped) = true;
  }
  EXPECT_TRUE(coded && dropped);
  EXPECT_LE(Allocate(sets, 0.05).predicted_rate, 0.05);
  EXPECT_NEAR(Allocate(sets, 2.0).predicted_rate, 2.0, 1e-4);
}

TEST(BitAllocationTest, TangentialStepsKeepTheirDistanceFromNormalSteps) {
  const std::vector<SetStatistics> sets = TypicalSets(5);
  for (const double target : {0.05, 0.5, 2.0, 6.0}) {
    const BitAllocation allocation = Allocate(sets, target, {1.0, 1.5});
    EXPECT_NEAR(allocation.predicted_rate, target, 1e-3 * target);
    int at_floor = 0;
    for (size_t k = 3; k < sets.size(); k += 2) {
      ASSERT_EQ(sets[k].kind, SetKind::kTangential);
      if (!std::isfinite(allocation.steps[k])) continue;
      if (!std::isfinite(allocation.steps[k + 1])) continue;
      EXPECT_GE(allocation.steps[k], 1.5 * allocation.steps[k + 1] * (1 - 1e-12));
      at_floor += allocation.steps[k] < 1.5 * allocation.steps[k + 1] * (1 + 1e-12);
    }
    if (target > 1.0) {
      EXPECT_GE(at_floor, 1);
    }
  }
}

TEST(BitAllocationTest, TangentialFloorHoldsWhereTheNormalSetIsEmpty) {
  // A plane whose vertices slide in it: only tangential parts, peaked ones.
  std::vector<SetStatistics> sets = TypicalSets(2);
  for (size_t k = 4; k < sets.size(); k += 2) sets[k].sigma = 0.0;
  const BitAllocation free = Allocate(sets, 0.5), floored = Allocate(sets, 0.5, {1.0, 1.5});
  EXPECT_NEAR(floored.predicted_rate, 0.5, 1e-3);
  for (const size_t k : {size_t{3}, size_t{5}}) {
    EXPECT_TRUE(std::isfinite(floored.steps[k]));
    EXPECT_TRUE(std::isfinite(free.steps[k]));
  }
}

TEST(BitAllocationTest, NearlyEmptyTangentialSetGetsNoBits) {
  std::vector<SetStatistics> sets = TypicalSets(4);
  for (size_t k = 3; k < sets.size(); k += 2) sets[k].sigma = 1e-12;
  const BitAllocation allocation = Allocate(sets, 1.0, {1.0, 1.5});
  for (size_t k = 3; k < sets.size(); k += 2) EXPECT_EQ(allocation.steps[k], kInfinity);
}

TEST(BitAllocationTest, CommonBaseStepIsTheGeometricMeanOfCodedAxes) {
  const std::vector<SetStatistics> sets = TypicalSets(1);
  BitAllocation allocation;
  allocation.steps = {2.0, 8.0, kInfinity, 100.0, 100.0};
  EXPECT_NEAR(CommonBaseStep(sets, allocation), 4.0, 1e-12);
  allocation.steps = {kInfinity, kInfinity, kInfinity, 100.0, 100.0};
  EXPECT_EQ(CommonBaseStep(sets, allocation), kInfinity);
}

TEST(BitAllocationTest, StepsByLevelAreWhatAStreamHolds) {
  const std::vector<SetStatistics> sets = TypicalSets(2);
  BitAllocation allocation;
  allocation.steps = {9.0, 9.0, 9.0, kInfinity, 0.5, 0.1, kInfinity};  // x y z (1,1) (1,2) (2,1) (2,2)
  const std::vector<LevelSteps> steps = StepsByLevel(sets, allocation, 3);
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[0].tangential_step, 0.0f);
  EXPECT_EQ(steps[0].normal_step, 0.5f);
  EXPECT_NEAR(steps[1].tangential_step, 0.1f, 0.1f / 256);
  EXPECT_EQ(steps[1].tangential_step, RoundStep(steps[1].tangential_step));
  EXPECT_EQ(steps[1].normal_step, 0.0f);
  EXPECT_EQ(steps[2].normal_step, 0.0f);
  EXPECT_EQ(steps[2].tangential_step, 0.0f);
}

TEST(BitAllocationTest, RefusesBadArguments) {
  const auto expect = [](const StatusOr<BitAllocation>& result, const char* message) {
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.status().code(), StatusCode::kInvalidArgument);
    EXPECT_THAT(result.status().message(), HasSubstr(message));
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<SetStatistics> good = TypicalSets(2);
  for (const double target : {0.0, -1.0, nan, kInfinity}) expect(AllocateBits(good, target), "target rate");
  for (const double lambda : {0.0, -1.0, nan, kInfinity}) expect(AllocateForSlope(good, lambda), "lambda");
  expect(AllocateBits(good, 1.0, {-0.1, 0.0}), "weight_exponent");
  expect(AllocateBits(good, 1.0, {nan, 0.0}), "weight_exponent");
  expect(AllocateBits(good, 1.0, {1.0, -1.0}), "min_tangential_ratio");
  for (const double bad : {-1.0, nan, kInfinity}) {
    std::vector<SetStatistics> sets = good;
    sets[3].sigma = bad;
    expect(AllocateBits(sets, 1.0), "sigma of set 3 (level 1)");
    sets = good;
    sets[4].weight = bad;
    expect(AllocateBits(sets, 1.0), "weight of set 4");
    sets = good;
    sets[5].sample_fraction = bad;
    expect(AllocateBits(sets, 1.0), "sample_fraction of set 5");
    sets = good;
    sets[0].alpha = bad;
    expect(AllocateBits(sets, 1.0), "alpha of set 0");
    sets = good;
    sets[6].active = bad;
    expect(AllocateBits(sets, 1.0), "active of set 6");
  }
  std::vector<SetStatistics> sets = good;
  sets[2].sigma = 1e200;
  expect(AllocateBits(sets, 1.0), "sigma of set 2 is too large");
}

TEST(BitAllocationTest, IsQuick) {
  // 23 sets, ten levels: some 20 ms in release; the bound leaves room for sanitizers.
  const std::vector<SetStatistics> sets = TypicalSets(10);
  const std::clock_t start = std::clock();
  EXPECT_NEAR(Allocate(sets, 1.0, {0.4, 1.5}).predicted_rate, 1.0, 1e-3);
  EXPECT_LT(std::clock() - start, CLOCKS_PER_SEC / 2);
}

}  // namespace
}  // namespace lacerta
