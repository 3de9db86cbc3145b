#include "encoder/allocation/rate_distortion_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "encoder/allocation/generalized_gaussian.h"

namespace lacerta {
namespace {

constexpr double kLn2 = 0.69314718055994530942;
constexpr double kMinLog2Step = -24.0;  // finer than the mantissa of the floats that are coded
// Knots per octave of the step: few where the curve is nearly the straight line of high rate.
constexpr double kFineLog2Step = -5.0;
constexpr double kKnotsPerFineOctave = 2.0;
constexpr double kKnotsPerOctave = 8.0;
constexpr double kNegligibleRate = 1e-8;  // bits per sample

}  // namespace

struct RateDistortionTable::Knots {
  Knots(double shape, double active) : alpha(std::clamp(shape, kMinAlpha, kMaxAlpha)) {
    bool convex = true;
    double log2_step = kMinLog2Step;
    for (;; log2_step += 1.0 / (log2_step < kFineLog2Step ? kKnotsPerFineOctave : kKnotsPerOctave)) {
      const double step = std::exp2(log2_step);
      const QuantizerPoint point = EvaluateUniformQuantizer(alpha, step, active);
      if (point.rate < kNegligibleRate) break;
      log_steps.push_back(std::log(step));
      rates.push_back(point.rate);
      log_distortions.push_back(std::log(point.distortion));
      const double log_slope = std::log(point.slope);
      convex = convex && (log_slopes.empty() || log_slope > log_slopes.back());
      if (convex) log_slopes.push_back(log_slope);
    }
  }

  // The part of `values` that goes with log_slopes.
  std::vector<double> Convex(const std::vector<double>& values) const {
    return {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(log_slopes.size())};
  }

  double alpha;
  std::vector<double> log_steps, rates, log_distortions;
  std::vector<double> log_slopes;  // shorter: as far as the slope grows with the step
};

RateDistortionTable::RateDistortionTable(double alpha, double active) : RateDistortionTable(Knots(alpha, active)) {}

RateDistortionTable::RateDistortionTable(const Knots& knots)
    : alpha_(knots.alpha),
      rate_of_slope_(knots.log_slopes, knots.Convex(knots.rates)),
      log_step_of_slope_(knots.log_slopes, knots.Convex(knots.log_steps)),
      rate_of_log_step_(knots.log_steps, knots.rates),
      log_distortion_of_log_step_(knots.log_steps, knots.log_distortions) {}

double RateDistortionTable::StepAtSlope(double log_slope) const { return std::exp(log_step_of_slope_(log_slope)); }

double RateDistortionTable::RateAtStep(double step) const {
  const double log_step = std::log(step);
  if (log_step > rate_of_log_step_.max_x()) return 0.0;
  // Below the table one bit is one halving of the step.
  return rate_of_log_step_(log_step) + std::max(0.0, rate_of_log_step_.min_x() - log_step) / kLn2;
}

double RateDistortionTable::DistortionAtStep(double step) const {
  const double log_step = std::log(step);
  if (log_step > log_distortion_of_log_step_.max_x()) return 1.0;
  const double below = std::max(0.0, log_distortion_of_log_step_.min_x() - log_step);
  return std::exp(log_distortion_of_log_step_(log_step) - 2.0 * below);
}

}  // namespace lacerta
