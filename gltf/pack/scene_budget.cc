#include "pack/scene_budget.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lacerta {
namespace {

constexpr size_t kFarthest = 40;  // steps from what is known
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A way to store a part.
struct Option {
  size_t index = 0;
  double bytes = 0.0;
  double error = 0.0;
};

// Takes for each part the option of the least error + price * bytes.
std::vector<Option> AtPrice(const std::vector<std::vector<Option>>& parts, double price) {
  std::vector<Option> chosen;
  for (const std::vector<Option>& options : parts) {
    const auto cost = [price](const Option& o) { return o.error + price * o.bytes; };
    chosen.push_back(*std::min_element(options.begin(), options.end(), [&](const Option& a, const Option& b) {
      return cost(a) != cost(b) ? cost(a) < cost(b) : a.bytes < b.bytes;
    }));
  }
  return chosen;
}

double BytesOf(const std::vector<Option>& chosen) {
  double sum = 0.0;
  for (const Option& option : chosen) sum += option.bytes;
  return sum;
}

// What is left of the budget goes where it lowers the error most per byte; prices reach the options of the lower convex hull only.
void Fill(const std::vector<std::vector<Option>>& parts, double budget, std::vector<Option>* chosen) {
  constexpr int kMostTimes = 100;  // what is left by then is little
  double left = budget - BytesOf(*chosen);
  for (int time = 0; time < kMostTimes; ++time) {
    const Option* best = nullptr;
    size_t best_part = 0;
    double best_gain = 0.0;
    for (size_t i = 0; i < parts.size(); ++i) {
      for (const Option& option : parts[i]) {
        const double more = option.bytes - (*chosen)[i].bytes, less = (*chosen)[i].error - option.error;
        if (!(less > 0.0) || more > left) continue;
        const double gain = more > 0.0 ? less / more : kInfinity;
        if (!(gain > best_gain)) continue;
        best = &option;
        best_part = i;
        best_gain = gain;
      }
    }
    if (best == nullptr) return;
    left -= best->bytes - (*chosen)[best_part].bytes;
    (*chosen)[best_part] = *best;
  }
}

std::vector<Option> Solve(const std::vector<std::vector<Option>>& parts, double budget) {
  constexpr int kSteps = 60;  // over 40 powers of ten
  std::vector<Option> least;
  least.reserve(parts.size());
  for (const std::vector<Option>& options : parts) {
    least.push_back(*std::min_element(options.begin(), options.end(), [](const Option& a, const Option& b) {
      return a.bytes != b.bytes ? a.bytes < b.bytes : a.error < b.error;
    }));
  }
  if (BytesOf(least) > budget) return least;
  double scale = 0.0;  // of the price that counts: all errors over all bytes
  for (const Option& option : least) scale += option.error;
  scale /= std::max(budget, 1.0);
  double low = -20.0, high = 20.0;  // the decimal logarithm of the price over that scale
  std::vector<Option> chosen = std::move(least);
  for (int i = 0; i < kSteps && scale > 0.0; ++i) {
    const double middle = (low + high) / 2;
    std::vector<Option> at = AtPrice(parts, scale * std::pow(10.0, middle));
    const bool fits = BytesOf(at) <= budget;
    if (fits) chosen = std::move(at);
    (fits ? high : low) = middle;
  }
  Fill(parts, budget, &chosen);
  return chosen;
}

// What was stored for a quality is what any other takes that it still meets.
struct QualityRange {
  size_t first = 0, last = 0;  // steps
  double bytes = 0.0;
  double error = 0.0;
};

std::vector<QualityRange> RangesOf(const RateCurve& curve) {
  std::vector<QualityRange> ranges;
  for (const RatePoint& point : curve.known) {
    QualityRange range{point.step, point.step, point.bytes, point.error};
    while (range.last + 1 < kQualitySteps && point.error <= curve.expected[range.last + 1]) ++range.last;
    ranges.push_back(range);
  }
  std::sort(ranges.begin(), ranges.end(), [](const QualityRange& a, const QualityRange& b) { return a.first < b.first; });
  for (size_t i = 0; i + 1 < ranges.size(); ++i) ranges[i].last = std::min(ranges[i].last, ranges[i + 1].first - 1);
  return ranges;
}

// The first that ends at the step or behind it.
size_t RangeAt(const std::vector<QualityRange>& ranges, size_t step) {
  size_t i = 0;
  while (i < ranges.size() && ranges[i].last < step) ++i;
  return i;
}

// Whether the step lies in that range, of RangeAt.
bool Holds(const std::vector<QualityRange>& ranges, size_t at, size_t step) { return at < ranges.size() && ranges[at].first <= step; }

double ExpectedBytes(const std::vector<QualityRange>& ranges, size_t step) {
  constexpr double kUsual = 0.08, kLeast = 0.01, kMost = 0.3;  // ln(bytes) per dB
  const size_t next = RangeAt(ranges, step);
  if (Holds(ranges, next, step)) return ranges[next].bytes;
  const auto slope = [&](size_t a, size_t b, size_t from, size_t to) {
    return std::log(std::max(ranges[b].bytes, 1.0) / std::max(ranges[a].bytes, 1.0)) / (PsnrOfStep(to) - PsnrOfStep(from));
  };
  if (next == 0) {
    const double per_decibel = ranges.size() > 1 ? std::clamp(slope(0, 1, ranges[0].first, ranges[1].first), kLeast, kMost) : kUsual;
    return ranges[0].bytes * std::exp(per_decibel * (PsnrOfStep(step) - PsnrOfStep(ranges[0].first)));
  }
  const QualityRange& before = ranges[next - 1];
  double per_decibel = kUsual;
  if (next < ranges.size()) {
    per_decibel = slope(next - 1, next, before.last, ranges[next].first);
  } else if (next > 1) {
    per_decibel = std::clamp(slope(next - 2, next - 1, ranges[next - 2].last, before.last), kLeast, kMost);
  }
  return before.bytes * std::exp(per_decibel * (PsnrOfStep(step) - PsnrOfStep(before.last)));
}

double ExpectedError(const RateCurve& curve, const std::vector<QualityRange>& ranges, size_t step) {
  const size_t at = RangeAt(ranges, step);
  return Holds(ranges, at, step) ? ranges[at].error : curve.expected[step];
}

}  // namespace

double ExpectedBytes(const RateCurve& curve, size_t step) { return ExpectedBytes(RangesOf(curve), step); }

double ExpectedError(const RateCurve& curve, size_t step) { return ExpectedError(curve, RangesOf(curve), step); }

bool IsKnown(const RateCurve& curve, size_t step) {
  const std::vector<QualityRange> ranges = RangesOf(curve);
  return Holds(ranges, RangeAt(ranges, step), step);
}

std::vector<size_t> ShareBudget(const std::vector<RateCurve>& curves, double budget) {
  std::vector<std::vector<Option>> parts;
  for (const RateCurve& curve : curves) {
    const std::vector<QualityRange> ranges = RangesOf(curve);
    std::vector<Option> options;
    // From the finest on, so that where several promise the same error for the same bytes the finest stands for them.
    for (size_t step = kQualitySteps; step-- > 0;) {
      if (step + kFarthest < ranges.front().first || step > ranges.back().last + kFarthest) continue;
      options.push_back({step, ExpectedBytes(ranges, step), ExpectedError(curve, ranges, step)});
    }
    parts.push_back(std::move(options));
  }
  std::vector<size_t> steps;
  for (const Option& option : Solve(parts, budget)) steps.push_back(option.index);
  return steps;
}

std::vector<size_t> ChooseKnown(const std::vector<RateCurve>& curves, double budget) {
  std::vector<std::vector<Option>> parts;
  for (const RateCurve& curve : curves) {
    parts.emplace_back();
    for (size_t i = 0; i < curve.known.size(); ++i) parts.back().push_back({i, curve.known[i].bytes, curve.known[i].error});
  }
  std::vector<size_t> indices;
  for (const Option& option : Solve(parts, budget)) indices.push_back(option.index);
  return indices;
}

}  // namespace lacerta
