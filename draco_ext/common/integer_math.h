// Arithmetic of the coding of base positions, where both sides must agree to the last bit: integers only.
#ifndef LACERTA_COMMON_INTEGER_MATH_H_
#define LACERTA_COMMON_INTEGER_MATH_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace lacerta {

// floor(a / b) for b > 0.
inline int64_t DivideDown(int64_t a, int64_t b) { return a / b - (a % b < 0); }

// a / b rounded to nearest, halves up, for b > 0 and |a| < 2^62.
inline int64_t DivideRounded(int64_t a, int64_t b) { return DivideDown(a + b / 2, b); }

// floor(sqrt(x)). A float is where the search begins: what comes out does not depend on how it was rounded.
inline uint32_t SquareRoot(uint64_t x) {
  constexpr uint64_t kLargest = 0xffffffffu;
  uint64_t root = std::min(static_cast<uint64_t>(std::sqrt(static_cast<double>(x))), kLargest);
  while (root * root > x) --root;
  while (root < kLargest && (root + 1) * (root + 1) <= x) ++root;
  return static_cast<uint32_t>(root);
}

// The vector of about the length 2^bits (bits <= 16) in the direction of v, |v| < 2^62; zero for zero.
inline std::array<int64_t, 3> ScaledTo(std::array<int64_t, 3> v, int bits) {
  int64_t largest = 0;
  for (const int64_t x : v) largest = std::max(largest, x < 0 ? -x : x);
  int shift = 0;
  while (largest >> shift >= int64_t{1} << 24) ++shift;
  uint64_t squares = 0;
  for (int64_t& x : v) {
    x = DivideDown(x, int64_t{1} << shift);
    squares += static_cast<uint64_t>(x * x);
  }
  const auto length = static_cast<int64_t>(SquareRoot(squares));
  for (int64_t& x : v) x = length > 0 ? DivideDown(x * (int64_t{1} << bits), length) : 0;
  return v;
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_INTEGER_MATH_H_
