// The adaptive models of one coefficient set and the decisions that make up a coefficient.
// Specified in docs/format.md, "Contexts" and "Binarization".
#ifndef LACERTA_COMMON_COEFFICIENT_MODELS_H_
#define LACERTA_COMMON_COEFFICIENT_MODELS_H_

#include <algorithm>
#include <array>
#include <cstdint>

#include "common/bit_model.h"
#include "common/coefficient_priors.h"
#include "common/symbol_coding.h"

namespace lacerta {

inline constexpr int kNumCompanionClasses = 6;
inline constexpr int kCurveCompanion = 3;  // added to the class of an edge on a curve
inline constexpr int kUnaryLength = 14;  // magnitudes up to this one are coded in unary
inline constexpr int kMaxExponent = 19;  // the rest, m - 14, is below 2^20

// Class of an expected magnitude given in 1/16: 0 for 0, then growing about logarithmically.
inline int ActivityClass(uint32_t sixteenths) {
  constexpr std::array<uint32_t, kNumActivityClasses - 1> kLowerBounds = {1,  3,  5,  8,   12,  17, 24,
                                                                          36, 56, 90, 150, 260, 500};
  int c = 0;
  for (const uint32_t bound : kLowerBounds) c += sixteenths >= bound;  // all of them: no branch to be foreseen wrongly
  return c;
}

// What is known about a coefficient before it is coded.
struct CoefficientContext {
  int activity = 0;    // ActivityClass of the expected magnitude
  int companion = 0;   // normal: LengthClass; tangential: what was coded at the same edge before, 0 nothing or zeros .. 2 much; 3 more on a curve
  int sign_class = 0;  // 0: nothing is known about the sign .. 7: neighbors and parent agree on it
  bool expect_negative = false;
};

// How the models of companions that tell no lengths begin in sets coded like normal ones: all like the first.
enum class Companions { kApart, kAlike };

// Models of one set. They live on from level to level.
struct SetModels {
  SetModels() = default;  // that begin with even odds
  explicit SetModels(const SetPriors& priors, Companions companions = Companions::kApart) {
    const auto begin = [](uint8_t probability) { return BitModel(uint32_t{probability} << 8, kPriorBits); };
    for (int a = 0; a < kNumActivityClasses; ++a) {
      for (int c = 0; c < kNumCompanionClasses; ++c) {
        nonzero[a][c] = begin(priors.nonzero[a][companions == Companions::kAlike ? 0 : c % SetPriors::kNumCompanions]);
      }
      for (int m = 0; m < kUnaryLength; ++m) larger[a][m] = begin(priors.larger[a][std::min(m, SetPriors::kNumSteps - 1)]);
    }
    for (int g = 0; g < kNumSignClasses; ++g) unexpected_sign[g] = begin(priors.unexpected_sign[g]);
  }

  std::array<std::array<BitModel, kNumCompanionClasses>, kNumActivityClasses> nonzero;
  std::array<BitModel, kNumSignClasses> unexpected_sign;
  std::array<std::array<BitModel, kUnaryLength>, kNumActivityClasses> larger;  // [m - 1]: the magnitude exceeds m
  LengthModels<kMaxExponent> rest;  // what the magnitude exceeds kUnaryLength by
};

inline uint32_t Magnitude(int32_t q) { return static_cast<uint32_t>(q < 0 ? -int64_t{q} : int64_t{q}); }

// The rest of a coefficient that is not zero.
template <typename Coder>
#ifdef __GNUC__
__attribute__((noinline))  // few are: the rest of CodeCoefficient is to become part of its callers
#endif
int32_t CodeNonzero(Coder& coder, SetModels& models, const CoefficientContext& context, int32_t value) {
  const bool negative = context.expect_negative !=
                        coder.Code(models.unexpected_sign[context.sign_class], (value < 0) != context.expect_negative);
  const uint32_t target = Magnitude(value);
  uint32_t magnitude = 1;
  auto& larger = models.larger[context.activity];
  while (magnitude <= kUnaryLength && coder.Code(larger[magnitude - 1], target > magnitude)) ++magnitude;
  if (magnitude > kUnaryLength) magnitude = kUnaryLength + CodePositive(models.rest, target - kUnaryLength, &coder);
  return negative ? -static_cast<int32_t>(magnitude) : static_cast<int32_t>(magnitude);
}

// Codes one coefficient; returns it. With an encoding coder `value` is what is coded; a decoding coder ignores it, and
// whatever it answers, the magnitude stays within kMaxMagnitude.
template <typename Coder>
int32_t CodeCoefficient(Coder& coder, SetModels& models, const CoefficientContext& context, int32_t value) {
  if (!coder.Code(models.nonzero[context.activity][context.companion], value != 0)) return 0;
  return CodeNonzero(coder, models, context, value);
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_COEFFICIENT_MODELS_H_
