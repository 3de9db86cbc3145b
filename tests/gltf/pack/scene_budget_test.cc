#include "pack/scene_budget.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lacerta {
namespace {

// A part whose squared error is weight * 10^(-dB / 10), and whose bytes grow by e for every 1 / slope dB from `bytes` at 70 dB.
struct Part {
  double weight = 1.0;
  double bytes = 1000.0;
  double slope = 0.08;

  double Error(size_t step) const { return weight * std::pow(10.0, -PsnrOfStep(step) / 10.0); }
  double Bytes(size_t step) const { return bytes * std::exp(slope * (PsnrOfStep(step) - 70.0)); }
  RatePoint At(size_t step) const { return {step, Bytes(step), Error(step)}; }
  RateCurve Known(const std::vector<size_t>& steps) const {
    RateCurve curve;
    for (size_t step = 0; step < kQualitySteps; ++step) curve.expected.push_back(Error(step));
    for (const size_t step : steps) curve.known.push_back(At(step));
    return curve;
  }
};

double SumOfBytes(const std::vector<Part>& parts, const std::vector<size_t>& steps) {
  double sum = 0.0;
  for (size_t i = 0; i < parts.size(); ++i) sum += parts[i].Bytes(steps[i]);
  return sum;
}

double SumOfErrors(const std::vector<Part>& parts, const std::vector<size_t>& steps) {
  double sum = 0.0;
  for (size_t i = 0; i < parts.size(); ++i) sum += parts[i].Error(steps[i]);
  return sum;
}

TEST(SceneBudget, FindsTheLeastErrorOfAllPairs) {
  const std::vector<Part> parts = {{1.0, 1000.0, 0.08}, {0.3, 300.0, 0.12}};
  const std::vector<RateCurve> curves = {parts[0].Known({90, 110}), parts[1].Known({90, 110})};
  for (const double budget : {700.0, 1300.0, 2600.0}) {
    double least = 1e300;
    for (size_t a = 50; a < 150; ++a) {
      for (size_t b = 50; b < 150; ++b) {
        if (SumOfBytes(parts, {a, b}) <= budget) least = std::min(least, SumOfErrors(parts, {a, b}));
      }
    }
    const std::vector<size_t> steps = ShareBudget(curves, budget);
    ASSERT_EQ(steps.size(), 2u);
    EXPECT_LE(SumOfBytes(parts, steps), budget);
    EXPECT_LE(SumOfErrors(parts, steps), 1.02 * least) << budget;
    EXPECT_GE(SumOfErrors(parts, steps), 0.999 * least) << budget;
  }
}

TEST(SceneBudget, SlopesAreEqualNotErrors) {
  // The second takes ten times the bytes for the same error: it is left coarser.
  const std::vector<Part> parts = {{1.0, 1000.0, 0.08}, {1.0, 10'000.0, 0.08}};
  const std::vector<size_t> steps = ShareBudget({parts[0].Known({100}), parts[1].Known({100})}, 11'000.0);
  EXPECT_GT(steps[0], steps[1]);
  // -d error / d bytes, from error ~ exp(-0.23 dB) and bytes ~ exp(0.08 dB).
  const auto slope = [&](size_t i) { return parts[i].Error(steps[i]) / parts[i].Bytes(steps[i]); };
  EXPECT_NEAR(std::log(slope(0) / slope(1)), 0.0, 0.4);  // a step is 0.16
  EXPECT_NEAR(SumOfBytes(parts, steps) / 11'000.0, 0.97, 0.03);
}

TEST(SceneBudget, WhatIsCloserThanAskedForStandsForTheQualitiesThatItMeets) {
  const Part part;
  RateCurve curve = part.Known({100});
  curve.known[0].error = part.Error(112);
  for (const size_t step : {100, 106, 112}) {
    EXPECT_TRUE(IsKnown(curve, step));
    EXPECT_EQ(ExpectedError(curve, step), part.Error(112));
    EXPECT_EQ(ExpectedBytes(curve, step), part.Bytes(100));
  }
  EXPECT_FALSE(IsKnown(curve, 99));
  EXPECT_FALSE(IsKnown(curve, 113));
  EXPECT_EQ(ExpectedError(curve, 120), part.Error(120));
  EXPECT_NEAR(ExpectedBytes(curve, 120) / part.Bytes(108), 1.0, 1e-9);  // from 112 on as from 100 on
  curve.known.push_back(part.At(106));  // another trial says more about the qualities behind it
  EXPECT_EQ(ExpectedError(curve, 106), part.Error(106));
  EXPECT_TRUE(IsKnown(curve, 105));
  EXPECT_FALSE(IsKnown(curve, 107));
}

TEST(SceneBudget, OfWhatIsKnownTheBestThatFits) {
  const std::vector<Part> parts = {{1.0, 1000.0, 0.08}, {1.0, 1000.0, 0.08}};
  const std::vector<RateCurve> curves = {parts[0].Known({100, 80, 120}), parts[1].Known({100, 120})};
  EXPECT_EQ(ChooseKnown(curves, 2000.0), (std::vector<size_t>{0, 0}));
  EXPECT_EQ(ChooseKnown(curves, 1e6), (std::vector<size_t>{2, 1}));
  EXPECT_EQ(ChooseKnown(curves, 100.0), (std::vector<size_t>{1, 0}));  // nothing fits: the smallest
  // Enough for one of both at 80 dB.
  const std::vector<size_t> one = ChooseKnown(curves, 1000.0 + parts[0].Bytes(120));
  EXPECT_EQ((one[0] == 2) + (one[1] == 1), 1);
}

TEST(SceneBudget, NothingIsThoughtFartherOffThanTwentyDecibels) {
  const Part part;
  EXPECT_EQ(ShareBudget({part.Known({100})}, 1e9), (std::vector<size_t>{140}));
  EXPECT_EQ(ShareBudget({part.Known({100})}, 1.0), (std::vector<size_t>{60}));
}

TEST(SceneBudget, WithoutErrorOrBytesNothingBreaks) {
  RateCurve exact = Part().Known({100});
  exact.known[0].error = 0.0;
  RateCurve empty = Part{0.0, 0.0, 0.08}.Known({100});
  EXPECT_EQ(ShareBudget({exact, empty}, 1e6).size(), 2u);
  EXPECT_EQ(ChooseKnown({exact, empty}, 1e6), (std::vector<size_t>{0, 0}));
  EXPECT_TRUE(ShareBudget({}, 1000.0).empty());
}

}  // namespace
}  // namespace lacerta
