// The parallelograms from which a stock Draco stream predicts the values of an attribute, chosen for the fewest bytes.
#ifndef LACERTA_DRACO_PARALLELOGRAM_CHOICE_H_
#define LACERTA_DRACO_PARALLELOGRAM_CHOICE_H_

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "draco/predictable_values.h"
#include "lacerta/mesh.h"

namespace lacerta {

// How values are predicted.
struct ParallelogramChoice {
  enum class Prediction {
    kParallelogram,             // from the usual one, or from the value before
    kConstrainedMulti,          // from the mean of any, with flags that tell which; from the value before where it is none
  };
  enum class Scheme { kTagged, kRaw };  // of symbols

  Prediction prediction = Prediction::kParallelogram;
  Scheme scheme = Scheme::kTagged;
  std::vector<uint8_t> used;  // #N, a bit for each of its parallelograms: whether it takes part
};

// used: of one value.
uint32_t NumUsed(uint32_t used);

// Corrections of predictions as symbols: modulo the range of the values, 0, -1, 1, -2, 2 as 0, 1, 2, 3, 4.
class Wrap {
 public:
  Wrap() = default;
  explicit Wrap(const std::vector<int32_t>& values) {  // not empty
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    low_ = *low;
    high_ = *high;
    range_ = 1 + high_ - low_;
    least_ = -(range_ / 2);
    most_ = (range_ - 1) / 2;
  }

  uint32_t Symbol(int32_t value, int64_t prediction) const {
    int64_t correction = value - std::clamp(prediction, low_, high_);
    if (correction < least_) {
      correction += range_;
    } else if (correction > most_) {
      correction -= range_;
    }
    return static_cast<uint32_t>(correction < 0 ? -2 * correction - 1 : 2 * correction);
  }

  int32_t low() const { return static_cast<int32_t>(low_); }
  int32_t high() const { return static_cast<int32_t>(high_); }

 private:
  int64_t low_ = 0, high_ = 0, range_ = 1, least_ = 0, most_ = 0;
};

// Symbols of values of which parallelograms are chosen.
class ParallelogramPredictor {
 public:
  // values: not empty; must outlive the predictor.
  explicit ParallelogramPredictor(const PredictableValues& values);

  const PredictableValues& values() const { return values_; }
  const Wrap& wrap() const { return wrap_; }

  // Of the n-th value, predicted by the mean of the parallelograms of `used`; by the value before where there are none.
  void Symbols(size_t n, uint32_t used, uint32_t* symbols) const;

 private:
  int32_t At(size_t n, uint32_t k) const { return values_.values[n * values_.components + k]; }

  const PredictableValues& values_;
  const Wrap wrap_;
  std::vector<int32_t> predictions_;  // of each parallelogram
};

// What symbols and flags take in a stream where they are as frequent as they were in one before, bits.
class SymbolCosts {
 public:
  SymbolCosts(const ParallelogramPredictor& predictor, const ParallelogramChoice& choice);

  // Of a value with these symbols, by the mean of num_used of so many parallelograms.
  double Of(const uint32_t* symbols, uint32_t num_used, uint32_t offers) const {
    const double flags = num_used * used_[offers] + (offers - num_used) * left_out_[offers];
    return flags + (is_tagged_ ? Tagged(symbols) : Raw(symbols));
  }

 private:
  void Count(uint32_t symbol);
  double Tagged(const uint32_t* symbols) const;
  double Raw(const uint32_t* symbols) const;

  const bool is_tagged_;
  const uint32_t components_;
  std::vector<double> symbols_;
  double unseen_ = 0;
  std::array<double, 33> lengths_{};  // of all components of a value, with the tag
  std::array<double, kMostParallelograms + 1> used_{}, left_out_{};
};

// Values as a stream holds them: the prediction with its transform, the symbols, which parallelograms are left out of the mean that predicts each, and
// the range of the values.
struct CodedValues {
  ParallelogramChoice choice;
  Bytes bytes;
};

// In the fewest bytes found. Draco's encoder decides as it goes, by the entropy of what it has coded so far; here choices and their costs, of tagged and
// of raw symbols, are found in turns. values: not empty.
CodedValues CodeByParallelograms(const PredictableValues& values);

}  // namespace lacerta

#endif  // LACERTA_DRACO_PARALLELOGRAM_CHOICE_H_
