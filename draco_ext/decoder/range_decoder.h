// Binary range decoder. Twin: encoder/range_encoder.h. Specified in docs/format.md, "Range coder".
#ifndef LACERTA_DECODER_RANGE_DECODER_H_
#define LACERTA_DECODER_RANGE_DECODER_H_

#include <cstddef>
#include <cstdint>

#include "common/bit_model.h"
#include "lacerta/mesh.h"

namespace lacerta {

// Decodes the decisions of one payload. Bytes past the end read as zero (the encoder leaves trailing zeros out), so
// every payload decodes to some sequence of decisions, whatever its bytes.
class RangeDecoder {
 public:
  explicit RangeDecoder(Span<const uint8_t> payload) : payload_(payload) {
    for (int i = 0; i < 4; ++i) code_ = code_ << 8 | NextByte();
  }

  // The next decision. The argument `bit` is ignored: encoder and decoder share the code that calls this
  // (common/coefficient_coding.h).
  bool Code(BitModel& model, bool /*bit*/) {
    const uint32_t bound = static_cast<uint32_t>(uint64_t{range_} * model.ProbabilityOfOne() >> kProbabilityBits);
    const bool bit = Split(bound);
    model.Update(bit);
    return bit;
  }

  // A decision of probability 1/2 without a model.
  bool CodeEven(bool /*bit*/) { return Split(range_ >> 1); }

 private:
  bool Split(uint32_t bound) {
    const bool bit = code_ < bound;
    if (bit) {
      range_ = bound;
    } else {
      code_ -= bound;
      range_ -= bound;
    }
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      code_ = code_ << 8 | NextByte();
    }
    return bit;
  }

  uint32_t NextByte() { return next_ < payload_.size() ? payload_[next_++] : 0; }

  Span<const uint8_t> payload_;
  size_t next_ = 0;
  uint32_t range_ = 0xffffffffu;
  uint32_t code_ = 0;
};

}  // namespace lacerta

#endif  // LACERTA_DECODER_RANGE_DECODER_H_
