// Quantized detail coefficients of one level and how they turn back into lengths.
#ifndef LACERTA_COMMON_COEFFICIENT_SETS_H_
#define LACERTA_COMMON_COEFFICIENT_SETS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lacerta/vec3.h"

namespace lacerta {

// Largest magnitude that the binarization can express (common/coefficient_coding.h); larger ones cannot be encoded, and
// no stream decodes to them.
inline constexpr int32_t kMaxMagnitude = (1 << 20) + 13;

// Quantized details of level i + 1: one vector per edge of level i, in the local frame of the edge's midpoint.
struct QuantizedLevel {
  std::vector<int32_t> normal;      // #E
  std::vector<int32_t> tangential;  // 2 x #E: t1, t2 of edge 0, t1, t2 of edge 1, ...
};

QuantizedLevel ZeroLevel(uint32_t num_edges);

// Unit of LevelSteps' biases: 1/32 of a step.
inline constexpr int kBiasUnit = 32;
inline constexpr int kMaxBias = 15;

// How one level is predicted, and its two sets quantized. A step is in model units, >= 0, and has at most 8 significant bits
// (RoundStep); 0 means that the set is not coded: all its coefficients are zero and cost nothing.
struct LevelSteps {
  float normal_step = 0.0f;
  float tangential_step = 0.0f;
  // Reconstructed magnitudes are |q| - bias / 32 steps: 0 is the middle of a bin, 15 almost its lower end.
  uint8_t normal_bias = 0;      // 0..15
  uint8_t tangential_bias = 0;  // 0..15
  bool is_curved = false;       // midpoints are predicted by common/curved_prediction.h; so are those of all coarser levels then

  // Whether no set is coded: all details are zero. Such a level has no segment.
  bool is_silent() const { return normal_step == 0 && tangential_step == 0; }
  // The same level without coefficients.
  LevelSteps Silent() const {
    LevelSteps silent;
    silent.is_curved = is_curved;
    return silent;
  }
};

// The step nearest to `step` that a stream can hold: the upper 16 bits of its binary32 form, rounded to nearest.
// Infinite, NaN, negative and very small (< 2^-126) steps become 0.
float RoundStep(float step);

// The upper 16 bits of the binary32 form of a step that RoundStep returned, and back.
uint16_t StepToBits(float rounded_step);
float StepFromBits(uint16_t bits);

// The length that a quantized coefficient stands for: sign(q) (|q| - bias / 32) step, and 0 for q = 0.
inline float Dequantize(int32_t q, float step, uint8_t bias) {
  if (q == 0) return 0.0f;
  const float magnitude =
      (q < 0 ? -static_cast<float>(q) : static_cast<float>(q)) - static_cast<float>(bias) / kBiasUnit;
  return q < 0 ? -magnitude * step : magnitude * step;
}

// Whether an edge has a coefficient that is not zero: few of a fine level have.
inline bool HasDetail(const QuantizedLevel& quantized, uint32_t edge) {
  return quantized.tangential[size_t{2} * edge] != 0 || quantized.tangential[size_t{2} * edge + 1] != 0 || quantized.normal[edge] != 0;
}

// The dequantized detail of an edge, in its local frame.
inline Vec3f LocalDetail(const LevelSteps& steps, const QuantizedLevel& quantized, uint32_t edge) {
  return {Dequantize(quantized.tangential[size_t{2} * edge], steps.tangential_step, steps.tangential_bias),
          Dequantize(quantized.tangential[size_t{2} * edge + 1], steps.tangential_step, steps.tangential_bias),
          Dequantize(quantized.normal[edge], steps.normal_step, steps.normal_bias)};
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_COEFFICIENT_SETS_H_
