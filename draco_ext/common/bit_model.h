// Adaptive probability of one binary decision, shared by range encoder and range decoder (docs/format.md, "Bit
// models").
//
// Two estimates follow the bits, one quickly and one slowly, and the probability in use is their mean. Both begin as
// running averages (the n-th bit weighs 1 / (n + 1)) until their own lower bound of the weight is reached, so
// that a model is useful after a handful of bits: sets of a few hundred coefficients are the rule at coarse levels.
#ifndef LACERTA_COMMON_BIT_MODEL_H_
#define LACERTA_COMMON_BIT_MODEL_H_

#include <array>
#include <cstdint>

namespace lacerta {

inline constexpr int kProbabilityBits = 16;
// Probabilities stay within [kMinProbability, 2^16 - kMinProbability], so that no decision is ever impossible.
inline constexpr uint32_t kMinProbability = 24;

class BitModel {
 public:
  BitModel() = default;
  // one: the probability of a one to begin with, in 1/65536.
  // seen: bits that this is worth, at most 160: how firmly the model begins with it.
  explicit constexpr BitModel(uint32_t one, uint32_t seen = 0) : fast_(one << 8), slow_(one << 8), count_(seen) {}

  // Probability of a one in 1/65536.
  uint32_t ProbabilityOfOne() const {
    const uint32_t mean = (fast_ + slow_) >> 9;
    return mean < kMinProbability ? kMinProbability : mean > 65536 - kMinProbability ? 65536 - kMinProbability : mean;
  }

  void Update(bool bit) {
    fast_ = Toward(fast_, bit, count_ < kFastCount ? kWeight[count_] : kWeight[kFastCount]);
    slow_ = Toward(slow_, bit, kWeight[count_]);
    if (count_ < kSlowCount) ++count_;
  }

 private:
  static constexpr uint32_t kFastCount = 24, kSlowCount = 160;

  static const std::array<uint16_t, kSlowCount + 1> kWeight;  // [n] = floor(65536 / (n + 2))

  // Estimates have 24 fractional bits.
  static uint32_t Toward(uint32_t estimate, bool bit, uint32_t weight) {
    if (!bit) return estimate - static_cast<uint32_t>(uint64_t{estimate} * weight >> 16);
    return estimate + static_cast<uint32_t>(uint64_t{(1u << 24) - estimate} * weight >> 16);
  }

  uint32_t fast_ = 1u << 23, slow_ = 1u << 23;
  uint32_t count_ = 0;  // bits seen, up to kSlowCount
};

}  // namespace lacerta

#endif  // LACERTA_COMMON_BIT_MODEL_H_
