// Integers as binary decisions with adaptive models, for encoder and decoder alike. Coder as in common/coefficient_coding.h.
// Specified in docs/format.md, "Binarization" and "Integers of the compact base".
#ifndef LACERTA_COMMON_SYMBOL_CODING_H_
#define LACERTA_COMMON_SYMBOL_CODING_H_

#include <array>
#include <cstdint>

#include "common/bit_model.h"

namespace lacerta {

// Models of a positive integer below 2^(kMostBits + 1), small ones being the likelier, as an Exp-Golomb code: how many bits it has
// below its leading one, by unary decisions, then those bits, the highest of them with a model.
template <int kMostBits>
struct LengthModels {
  std::array<BitModel, kMostBits> longer;      // [k]: there are more than k bits
  std::array<BitModel, kMostBits> second_bit;  // [k - 1]: the highest of k bits
};

template <int kMostBits, typename Coder>
uint32_t CodePositive(LengthModels<kMostBits>& models, uint32_t number, Coder* coder) {
  int bits = 0;
  while (bits < kMostBits && coder->Code(models.longer[bits], number >> bits > 1)) ++bits;
  uint32_t result = 1;
  for (int i = bits - 1; i >= 0; --i) {
    const bool bit = (number >> i & 1) != 0;
    result = result << 1 | uint32_t{i == bits - 1 ? coder->Code(models.second_bit[i], bit) : coder->CodeEven(bit)};
  }
  return result;
}

// Integers of the compact base: value < 2^31 - 1, from 0 on.
using IntegerModels = LengthModels<30>;

template <typename Coder>
uint32_t CodeByLength(IntegerModels& models, uint32_t value, Coder* coder) {
  return CodePositive(models, value + 1, coder) - 1;
}

// Codes value < count, all of them equally likely; count >= 1. Halves the range that is left with probabilities in 1/65536.
template <typename Coder>
uint32_t CodeUniform(uint32_t count, uint32_t value, Coder* coder) {
  uint32_t first = 0;
  while (count > 1) {
    const uint32_t upper = count / 2, lower = count - upper;
    // (upper << 16) / count in 32 bits: one half less the rest of an odd count.
    BitModel share(count % 2 == 0 ? 32768 : 32768 - (32767 + count) / count);
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
