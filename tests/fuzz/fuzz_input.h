// Turns the bytes of a fuzzer into numbers and choices; zeros follow after the end.
#ifndef LACERTA_TESTS_FUZZ_FUZZ_INPUT_H_
#define LACERTA_TESTS_FUZZ_FUZZ_INPUT_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "lacerta/mesh.h"

// Ends the process, so that the fuzzer keeps the input, where something that must hold does not.
#define FUZZ_CHECK(condition)                                                            \
  do {                                                                                   \
    if (!(condition)) {                                                                  \
      std::fprintf(stderr, "%s:%d: %s does not hold\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                      \
    }                                                                                    \
  } while (false)

namespace lacerta::fuzz {

class FuzzInput {
 public:
  FuzzInput(const uint8_t* data, size_t size) : rest_(data, size) {}

  bool empty() const { return rest_.empty(); }
  uint8_t Byte() {
    if (rest_.empty()) return 0;
    const uint8_t byte = rest_[0];
    rest_ = rest_.Subspan(1);
    return byte;
  }
  uint16_t Word16() {
    const int low = Byte();
    return static_cast<uint16_t>(low | Byte() << 8);
  }
  // At most `size` bytes.
  Span<const uint8_t> Take(size_t size) {
    const Span<const uint8_t> taken = rest_.First(std::min(size, rest_.size()));
    rest_ = rest_.Subspan(taken.size());
    return taken;
  }
  Span<const uint8_t> Rest() { return Take(rest_.size()); }

 private:
  Span<const uint8_t> rest_;
};

}  // namespace lacerta::fuzz

#endif  // LACERTA_TESTS_FUZZ_FUZZ_INPUT_H_
