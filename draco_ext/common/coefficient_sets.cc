#include "common/coefficient_sets.h"

#include <cmath>
#include <cstring>

namespace lacerta {

QuantizedLevel ZeroLevel(uint32_t num_edges) {
  return {std::vector<int32_t>(num_edges), std::vector<int32_t>(size_t{2} * num_edges)};
}

float RoundStep(float step) {
  if (!std::isnormal(step) || step < 0) return 0.0f;
  uint32_t bits;
  std::memcpy(&bits, &step, sizeof(bits));
  bits += 0x8000u;
  const uint16_t upper = static_cast<uint16_t>(bits >> 16);
  return upper >= 0x7f80u ? StepFromBits(0x7f7fu) : StepFromBits(upper);
}

uint16_t StepToBits(float rounded_step) {
  uint32_t bits;
  std::memcpy(&bits, &rounded_step, sizeof(bits));
  return static_cast<uint16_t>(bits >> 16);
}

float StepFromBits(uint16_t bits) {
  const uint32_t wide = static_cast<uint32_t>(bits) << 16;
  float step;
  std::memcpy(&step, &wide, sizeof(step));
  return step;
}

}  // namespace lacerta
