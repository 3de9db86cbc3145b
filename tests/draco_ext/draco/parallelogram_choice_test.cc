#include "draco/parallelogram_choice.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace lacerta {
namespace {

constexpr uint32_t kNumValues = 1000;

using Prediction = ParallelogramChoice::Prediction;

// Values of three numbers on two straight lines, each the parallelogram of the three before it but for noise.
PredictableValues Strip(int noise, uint32_t num_values = kNumValues) {
  std::mt19937 random(2);
  PredictableValues strip;
  strip.components = 3;
  strip.first_parallelogram = {0};
  for (uint32_t n = 0; n < num_values; ++n) {
    for (int k = 0; k < 3; ++k) {
      const int32_t exact = static_cast<int32_t>(n / 2) * (40 + 7 * k) + static_cast<int32_t>(n % 2) * (900 - 100 * k);
      strip.values.push_back(exact + static_cast<int32_t>(random() % static_cast<uint32_t>(noise + 1)));
    }
    if (n >= 3) strip.parallelograms.push_back({n - 1, n - 2, n - 3});
    strip.first_parallelogram.push_back(static_cast<uint32_t>(strip.parallelograms.size()));
    strip.has_usual.push_back(n >= 3 ? 1 : 0);
  }
  return strip;
}

// `strip` with a second parallelogram for each value, over what make(n) gives, before the first one or after it.
template <typename Make>
PredictableValues WithSecond(const PredictableValues& strip, const Make& make) {
  std::mt19937 random(3);
  PredictableValues result = strip;
  result.parallelograms.clear();
  result.first_parallelogram = {0};
  for (uint32_t n = 0; n < kNumValues; ++n) {
    for (uint32_t i = strip.first_parallelogram[n]; i < strip.first_parallelogram[n + 1]; ++i) {
      std::array<uint32_t, 3> first = strip.parallelograms[i], second = make(n);
      if (random() % 2 == 0) std::swap(first, second);
      result.parallelograms.push_back(first);
      result.parallelograms.push_back(second);
    }
    result.first_parallelogram.push_back(static_cast<uint32_t>(result.parallelograms.size()));
  }
  return result;
}

TEST(CodeByParallelograms, TakesFewBytesWhereAParallelogramIsExact) {
  EXPECT_LT(CodeByParallelograms(Strip(0)).bytes.size(), 80u);
}

TEST(CodeByParallelograms, LeavesOutWhatMisleads) {
  std::mt19937 random(4);
  const PredictableValues misled = WithSecond(Strip(0), [&](uint32_t n) {
    return std::array<uint32_t, 3>{static_cast<uint32_t>(random() % n), static_cast<uint32_t>(random() % n), static_cast<uint32_t>(random() % n)};
  });
  const size_t size = CodeByParallelograms(misled).bytes.size();
  // Two flags tell which of two it is, and Draco's coder does not know that one follows from the other.
  EXPECT_GT(size, kNumValues / 8);
  EXPECT_LT(size, 2 * kNumValues / 8 + 100);
}

TEST(CodeByParallelograms, TakesTheMeanWhereThatIsNearer) {
  // The second one goes two steps back on both lines: as near as the first one, but for other reasons.
  const PredictableValues one = Strip(30);
  const PredictableValues both = WithSecond(one, [](uint32_t n) { return n < 6 ? std::array<uint32_t, 3>{n - 1, n - 2, n - 3} : std::array<uint32_t, 3>{n - 4, n - 2, n - 6}; });
  EXPECT_LT(CodeByParallelograms(both).bytes.size(), 0.98 * static_cast<double>(CodeByParallelograms(one).bytes.size()));
  EXPECT_GT(CodeByParallelograms(both).bytes.size(), 0.85 * static_cast<double>(CodeByParallelograms(one).bytes.size()));
}

TEST(CodeByParallelograms, HasNoFlagsWhereTheUsualParallelogramsWillDo) {
  const CodedValues usual = CodeByParallelograms(Strip(0, 20));
  EXPECT_EQ(usual.choice.prediction, Prediction::kParallelogram);
  EXPECT_EQ(usual.choice.used, Strip(0, 20).has_usual);
  PredictableValues other = Strip(0);
  other.has_usual.assign(kNumValues, 0);
  EXPECT_EQ(CodeByParallelograms(other).choice.prediction, Prediction::kConstrainedMulti);
  EXPECT_LT(CodeByParallelograms(Strip(0)).bytes.size() + 4, CodeByParallelograms(other).bytes.size());
}

TEST(CodeByParallelograms, PredictsFromTheValueBeforeWhereThereIsNone) {
  PredictableValues values = Strip(0);
  values.parallelograms.clear();
  values.first_parallelogram.assign(kNumValues + 1, 0);
  values.has_usual.assign(kNumValues, 0);
  const size_t jumps = CodeByParallelograms(values).bytes.size();
  values.values.assign(values.values.size(), 77);
  EXPECT_LT(CodeByParallelograms(values).bytes.size(), 30u);
  EXPECT_GT(jumps, 300u);
}

TEST(CodeByParallelograms, OneValueWillDo) {
  PredictableValues one;
  one.components = 1;
  one.values = {kMostValue};
  one.first_parallelogram = {0, 0};
  one.has_usual = {0};
  EXPECT_LT(CodeByParallelograms(one).bytes.size(), 30u);
}

}  // namespace
}  // namespace lacerta
