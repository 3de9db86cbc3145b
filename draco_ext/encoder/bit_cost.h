// Bits that the adaptive models charge, without coding anything.
#ifndef LACERTA_ENCODER_BIT_COST_H_
#define LACERTA_ENCODER_BIT_COST_H_

#include <array>
#include <cmath>

#include "common/bit_model.h"
#include "common/coefficient_models.h"

namespace lacerta {

// Bits of a decision whose probability is p / 65536.
inline float BitsOfProbability(uint32_t p) {
  static const std::array<float, 4097> kTable = [] {
    std::array<float, 4097> table{};
    for (size_t i = 0; i < table.size(); ++i) table[i] = -std::log2((static_cast<float>(i) + 0.5f) / 4097.0f);
    return table;
  }();
  return kTable[p >> 4];
}

inline float DecisionBits(const BitModel& model, bool bit) {
  const uint32_t one = model.ProbabilityOfOne();
  return BitsOfProbability(bit ? one : 65536 - one);
}

// A Coder for CodeLevel that adapts the models and adds up the bits.
class BitMeter {
 public:
  bool Code(BitModel& model, bool bit) {
    bits_ += DecisionBits(model, bit);
    model.Update(bit);
    return bit;
  }
  bool CodeEven(bool bit) {
    bits_ += 1;
    return bit;
  }
  double bits() const { return bits_; }

 private:
  double bits_ = 0;
};

// Bits of one coefficient; the models stay as they are.
inline float CoefficientBits(SetModels& models, const CoefficientContext& context, int32_t value) {
  struct Probe {
    float bits = 0;
    bool Code(const BitModel& model, bool bit) {
      bits += DecisionBits(model, bit);
      return bit;
    }
    bool CodeEven(bool bit) {
      bits += 1;
      return bit;
    }
  } probe;
  CodeCoefficient(probe, models, context, value);
  return probe.bits;
}

}  // namespace lacerta

#endif  // LACERTA_ENCODER_BIT_COST_H_
