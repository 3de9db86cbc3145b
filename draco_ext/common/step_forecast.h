// What the refinement header expects of quantization steps, level after level, so that few of them must be told
// (docs/format.md, "Refinement header"). Steps are codes of 16 bits here (StepToBits).
#ifndef LACERTA_COMMON_STEP_FORECAST_H_
#define LACERTA_COMMON_STEP_FORECAST_H_

#include <cstdint>

namespace lacerta {

// Codes of positive normal steps.
inline constexpr int kLeastStepBits = 0x0080;
inline constexpr int kMostStepBits = 0x7f7f;
inline constexpr bool IsStepBits(int64_t bits) { return bits >= kLeastStepBits && bits <= kMostStepBits; }

// The normal step expected of the next finer level: 1.2 times as large, rounded, but never over the largest step. Takes and gives
// codes of steps. The default mode's steps follow this law (encoder/step_law.h).
int NextStepBits(int bits);

// The tangential step expected beside a normal one: twice as large. Beside the largest ones it is no code of a step.
inline constexpr int TangentialStepBits(int normal_bits) { return normal_bits + 0x80; }

}  // namespace lacerta

#endif  // LACERTA_COMMON_STEP_FORECAST_H_
