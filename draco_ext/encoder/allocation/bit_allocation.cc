#include "encoder/allocation/bit_allocation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace lacerta {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLn2 = 0.69314718055994530942;

Status CheckSet(const SetStatistics& set, size_t index) {
  const auto bad = [](double value) { return !std::isfinite(value) || value < 0.0; };
  const char* what = bad(set.sigma)                             ? "sigma"
                     : bad(set.alpha) || set.alpha <= 0.0       ? "alpha"
                     : !(set.active > 0.0 && set.active <= 1.0) ? "active"
                     : bad(set.weight)                          ? "weight"
                     : bad(set.sample_fraction)                 ? "sample_fraction"
                                                                : nullptr;
  if (what == nullptr) return Status();
  return InvalidArgument(std::string(what) + " of set " + std::to_string(index) + " (level " +
                         std::to_string(set.level) + ") is out of range");
}

Status CheckOptions(const AllocationOptions& options) {
  if (!(options.weight_exponent >= 0.0 && options.weight_exponent <= 2.0)) {
    return InvalidArgument("weight_exponent must lie in 0..2, not " + std::to_string(options.weight_exponent));
  }
  if (!(options.min_tangential_ratio >= 0.0 && std::isfinite(options.min_tangential_ratio))) {
    return InvalidArgument("min_tangential_ratio must be 0 or more, not " +
                           std::to_string(options.min_tangential_ratio));
  }
  return Status();
}

// ln(w sigma^2 / a), with the energy of a coefficient, w / (3 a), raised to the exponent.
double LogGain(const SetStatistics& set, double exponent) {
  constexpr double kLn3 = 1.09861228866810969140;
  const double log_energy = std::log(set.weight) - std::log(set.sample_fraction) - kLn3;
  return kLn3 + exponent * log_energy + 2.0 * std::log(set.sigma);
}

}  // namespace

StatusOr<BitAllocator> BitAllocator::Create(Span<SetStatistics> sets, const AllocationOptions& options) {
  LACERTA_RETURN_IF_ERROR(CheckOptions(options));
  BitAllocator allocator(sets.size(), options);
  for (size_t k = 0; k < sets.size(); ++k) {
    const SetStatistics& set = sets[k];
    LACERTA_RETURN_IF_ERROR(CheckSet(set, k));
    const double gain = set.weight * set.sigma * set.sigma;
    if (!std::isfinite(gain))
      return InvalidArgument("sigma of set " + std::to_string(k) + " is too large to be squared");
    if (gain <= 0.0 || set.sample_fraction <= 0.0) continue;
    allocator.problems_.push_back(
        {k, set, LogGain(set, options.weight_exponent), RateDistortionTable(set.alpha, set.active)});
  }
  return allocator;
}

double BitAllocator::FreeStep(const Problem& problem, double log_slope) {
  const RateDistortionTable& table = problem.table;
  if (log_slope >= table.max_log_slope()) return kInfinity;
  const double step = table.StepAtSlope(log_slope);
  const double clamped_slope = std::exp(std::max(log_slope, table.min_log_slope()));
  const double cost = table.DistortionAtStep(step) + clamped_slope * table.RateAtSlope(log_slope);
  return cost < 1.0 ? step : kInfinity;  // not coding costs a distortion of 1 and no bit
}

double BitAllocator::TangentialFloor(const Problem& tangential, double lambda,
                                     const std::vector<double>& free_steps) const {
  double normal_step = kInfinity;
  for (const Problem& other : problems_) {
    if (other.set.kind == SetKind::kNormal && other.set.level == tangential.set.level)
      normal_step = free_steps[other.index];
  }
  if (!std::isfinite(normal_step)) {  // at high rate -h = 2 ln 2 step^2 / (12 sigma^2) whatever the density
    const double slope = lambda / std::exp(tangential.log_gain) * tangential.set.sigma * tangential.set.sigma;
    normal_step = std::sqrt(6.0 * slope / kLn2);
  }
  return options_.min_tangential_ratio * normal_step;
}

BitAllocation BitAllocator::ForSlope(double lambda) const {
  BitAllocation result;
  result.lambda = lambda;
  result.steps.assign(num_sets_, kInfinity);
  result.rates.assign(num_sets_, 0.0);
  std::vector<double> free_steps(num_sets_, kInfinity);
  for (const Problem& problem : problems_) {
    const double log_slope = std::log(lambda) - problem.log_gain;
    free_steps[problem.index] = FreeStep(problem, log_slope) * problem.set.sigma;
  }
  for (const Problem& problem : problems_) {
    const SetStatistics& set = problem.set;
    double step = free_steps[problem.index];
    double rate = std::isfinite(step) ? problem.table.RateAtSlope(std::log(lambda) - problem.log_gain) : 0.0;
    if (set.kind == SetKind::kTangential && options_.min_tangential_ratio > 0.0) {
      const double floor = TangentialFloor(problem, lambda, free_steps);
      if (step < floor) {
        rate = problem.table.RateAtStep(floor / set.sigma);
        step = rate > 0.0 ? floor : kInfinity;
      }
    }
    result.steps[problem.index] = step;
    result.rates[problem.index] = rate;
    result.predicted_rate += set.sample_fraction * rate;
    result.predicted_distortion +=
        set.weight * set.sigma * set.sigma * problem.table.DistortionAtStep(step / set.sigma);
  }
  return result;
}

StatusOr<BitAllocation> BitAllocator::ForRate(double target) const {
  if (!(target > 0.0 && std::isfinite(target))) {
    return InvalidArgument("the target rate must be positive and finite, not " + std::to_string(target));
  }
  double low = kInfinity, high = -kInfinity;  // ln(lambda) from the finest steps of all sets to no coded set
  for (const Problem& problem : problems_) {
    low = std::min(low, problem.table.min_log_slope() + problem.log_gain);
    high = std::max(high, problem.table.max_log_slope() + problem.log_gain);
  }
  if (problems_.empty()) return ForSlope(1.0);
  BitAllocation best = ForSlope(std::exp(high));
  BitAllocation finest = ForSlope(std::exp(low));
  if (finest.predicted_rate <= target) return finest;
  for (int i = 0; i < 100 && best.predicted_rate < target * (1.0 - 1e-9); ++i) {
    const double middle = 0.5 * (low + high);
    BitAllocation candidate = ForSlope(std::exp(middle));
    if (candidate.predicted_rate > target) {
      low = middle;
    } else {
      high = middle;
      best = std::move(candidate);
    }
  }
  return best;
}

StatusOr<BitAllocation> AllocateBits(Span<SetStatistics> sets, double target_bits_per_sample,
                                     const AllocationOptions& options) {
  LACERTA_ASSIGN_OR_RETURN(const BitAllocator allocator, BitAllocator::Create(sets, options));
  return allocator.ForRate(target_bits_per_sample);
}

StatusOr<BitAllocation> AllocateForSlope(Span<SetStatistics> sets, double lambda, const AllocationOptions& options) {
  LACERTA_ASSIGN_OR_RETURN(const BitAllocator allocator, BitAllocator::Create(sets, options));
  if (!(lambda > 0.0 && std::isfinite(lambda))) {
    return InvalidArgument("lambda must be positive and finite, not " + std::to_string(lambda));
  }
  return allocator.ForSlope(lambda);
}

double CommonBaseStep(Span<SetStatistics> sets, const BitAllocation& allocation) {
  double log_sum = 0.0;
  int count = 0;
  for (size_t k = 0; k < sets.size(); ++k) {
    if (sets[k].level != 0 || !std::isfinite(allocation.steps[k])) continue;
    log_sum += std::log(allocation.steps[k]);
    ++count;
  }
  return count == 0 ? kInfinity : std::exp(log_sum / count);
}

std::vector<LevelSteps> StepsByLevel(Span<SetStatistics> sets, const BitAllocation& allocation, int num_levels) {
  std::vector<LevelSteps> levels(num_levels);
  for (size_t k = 0; k < sets.size(); ++k) {
    const SetStatistics& set = sets[k];
    if (set.level < 1 || set.level > num_levels) continue;
    LevelSteps& level = levels[set.level - 1];
    const float step = RoundStep(static_cast<float>(allocation.steps[k]));
    if (set.kind == SetKind::kNormal) level.normal_step = step;
    if (set.kind == SetKind::kTangential) level.tangential_step = step;
  }
  return levels;
}

}  // namespace lacerta
