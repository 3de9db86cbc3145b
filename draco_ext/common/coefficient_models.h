// The adaptive models of one coefficient set, and what is known about a coefficient before it is coded.
// Specified in docs/format.md, "Contexts" and "Binarization".
#ifndef LACERTA_COMMON_COEFFICIENT_MODELS_H_
#define LACERTA_COMMON_COEFFICIENT_MODELS_H_

#include <array>
#include <cstdint>
#include <vector>

#include "common/bit_model.h"
#include "common/coefficient_sets.h"
#include "common/subdivision.h"

namespace lacerta {

inline constexpr int kNumActivityClasses = 14;  // of the expected magnitude
inline constexpr int kNumCompanionClasses = 3;
inline constexpr int kUnaryLength = 14;    // magnitudes up to this one are coded in unary
inline constexpr int kMaxExponent = 19;    // of the Exp-Golomb code of the rest

// Class of an expected magnitude given in 1/16: 0 for 0, then growing about logarithmically.
inline int ActivityClass(uint32_t sixteenths) {
  constexpr std::array<uint32_t, kNumActivityClasses - 1> kLowerBounds = {1, 3, 5, 8, 12, 17, 24, 36, 56, 90, 150, 260, 500};
  int c = 0;
  while (c < kNumActivityClasses - 1 && sixteenths >= kLowerBounds[c]) ++c;
  return c;
}

// What the coded neighbors say about the next coefficient.
struct CoefficientContext {
  int activity = 0;  // ActivityClass
  int companion = 0;  // what was coded at the same edge before: 0 nothing or zero .. 2 large
  int sign = 0;      // 0: neighbors say nothing; 1: they are positive; 2: negative
};

// Models of one set. They live on from level to level.
struct SetModels {
  std::array<std::array<BitModel, kNumCompanionClasses>, kNumActivityClasses> nonzero;
  std::array<BitModel, 3> negative;
  std::array<std::array<BitModel, kUnaryLength>, kNumActivityClasses> larger;  // [m - 1]: magnitude > m
  std::array<BitModel, kMaxExponent> exponent;
  std::array<BitModel, kMaxExponent + 1> mantissa_top;
};

inline uint32_t Magnitude(int32_t q) { return static_cast<uint32_t>(q < 0 ? -int64_t{q} : int64_t{q}); }

// Codes one coefficient; returns it. With an encoding coder `value` is what is coded; a decoding coder ignores it.
template <typename Coder>
int32_t CodeCoefficient(Coder& coder, SetModels& models, const CoefficientContext& context, int32_t value) {
  if (!coder.Code(models.nonzero[context.activity][context.companion], value != 0)) return 0;
  const bool negative = coder.Code(models.negative[context.sign], value < 0);
  const uint32_t target = Magnitude(value);
  uint32_t magnitude = 1;
  auto& larger = models.larger[context.activity];
  while (magnitude <= kUnaryLength && coder.Code(larger[magnitude - 1], target > magnitude)) ++magnitude;
  if (magnitude > kUnaryLength) {  // Exp-Golomb code of the rest, first the number of bits below the leading one
    const uint32_t rest = target - kUnaryLength;
    int exponent = 0;
    while (exponent < kMaxExponent && coder.Code(models.exponent[exponent], rest >> (exponent + 1) != 0)) ++exponent;
    uint32_t decoded = 1;
    for (int bit = exponent - 1; bit >= 0; --bit) {
      const bool one = (rest >> bit & 1) != 0;
      const bool top = bit == exponent - 1;
      decoded = decoded << 1 | (top ? coder.Code(models.mantissa_top[exponent], one) : coder.CodeEven(one));
    }
    magnitude = kUnaryLength + decoded;
  }
  return negative ? -static_cast<int32_t>(magnitude) : static_cast<int32_t>(magnitude);
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_COEFFICIENT_MODELS_H_
