// Integers as binary decisions with adaptive models, for encoder and decoder alike. Coder as in common/coefficient_coding.h.
// Specified in docs/format.md, "Integers of the compact base".
#ifndef LACERTA_COMMON_SYMBOL_CODING_H_
#define LACERTA_COMMON_SYMBOL_CODING_H_

#include <array>
#include <cstdint>

#include "common/bit_model.h"

namespace lacerta {

// Models of an integer of up to 31 bits, small ones being the likelier: the number of its bits by unary decisions, then the bits,
// the highest of them with a model.
struct LengthModels {
  std::array<BitModel, 31> longer;
  std::array<BitModel, 31> second_bit;
};

// Codes value < 2^31 - 1.
template <typename Coder>
uint32_t CodeByLength(LengthModels& models, uint32_t value, Coder* coder) {
  const uint32_t number = value + 1;
  uint32_t bits = 0;
  while (bits < 30 && coder->Code(models.longer[bits], number >> (bits + 1) != 0)) ++bits;
  uint32_t result = 1;
  for (uint32_t i = bits; i-- > 0;) {
    const bool bit = (number >> i & 1) != 0;
    result = result << 1 | uint32_t{i + 1 == bits ? coder->Code(models.second_bit[bits], bit) : coder->CodeEven(bit)};
  }
  return result - 1;
}

// Codes value < count, all of them equally likely; count >= 1. Halves the range that is left with probabilities in 1/65536.
template <typename Coder>
uint32_t CodeUniform(uint32_t count, uint32_t value, Coder* coder) {
  uint32_t first = 0;
  while (count > 1) {
    const uint32_t upper = count / 2, lower = count - upper;
    BitModel share(static_cast<uint32_t>((uint64_t{upper} << kProbabilityBits) / count));
    if (coder->Code(share, value >= first + lower)) {
      first += lower;
      count = upper;
    } else {
      count = lower;
    }
  }
  return first;
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_SYMBOL_CODING_H_
