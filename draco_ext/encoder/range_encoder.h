// Binary range encoder. Twin: decoder/range_decoder.h. Specified in docs/format.md, "Range coder".
#ifndef LACERTA_ENCODER_RANGE_ENCODER_H_
#define LACERTA_ENCODER_RANGE_ENCODER_H_

#include <cstdint>
#include <utility>

#include "common/bit_model.h"
#include "lacerta/mesh.h"

namespace lacerta {

// Encodes decisions into one payload. Bytes leave through a cache that waits for carries [Martin 1979].
class RangeEncoder {
 public:
  bool Code(BitModel& model, bool bit) {
    Narrow(static_cast<uint32_t>(uint64_t{range_} * model.ProbabilityOfOne() >> kProbabilityBits), bit);
    model.Update(bit);
    return bit;
  }

  bool CodeEven(bool bit) {
    Narrow(range_ >> 1, bit);
    return bit;
  }

  // Ends the payload with the fewest bytes that decode right; the encoder must not be used afterwards.
  Bytes Finish() {
    // The number in [low, low + range) with the most trailing zero bits.
    uint64_t end = low_;
    for (int bits = 32; bits >= 0; --bits) {
      const uint64_t unit = uint64_t{1} << bits;
      end = (low_ + unit - 1) & ~(unit - 1);
      if (end < low_ + range_) break;
    }
    low_ = end;
    for (int i = 0; i < 5; ++i) ShiftLow();
    while (!bytes_.empty() && bytes_.back() == 0) bytes_.pop_back();
    return std::move(bytes_);
  }

 private:
  void Narrow(uint32_t bound, bool bit) {
    if (bit) {
      range_ = bound;
    } else {
      low_ += bound;
      range_ -= bound;
    }
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      ShiftLow();
    }
  }

  // Moves the top byte of `low_` out, or, where a carry could still change it, counts it as pending.
  void ShiftLow() {
    const bool carry = low_ >> 32 != 0;
    if (carry || static_cast<uint32_t>(low_) < 0xff000000u) {
      if (started_)
        bytes_.push_back(static_cast<uint8_t>(cache_ + carry));  // the very first byte is always 0: left out
      for (; pending_ > 0; --pending_) bytes_.push_back(static_cast<uint8_t>(0xff + carry));
      started_ = true;
      cache_ = static_cast<uint8_t>(low_ >> 24);
    } else {
      ++pending_;
    }
    low_ = (low_ & 0x00ffffffu) << 8;
  }

  Bytes bytes_;
  uint64_t low_ = 0;
  uint32_t range_ = 0xffffffffu;
  uint8_t cache_ = 0;
  bool started_ = false;
  uint64_t pending_ = 0;
};

}  // namespace lacerta

#endif  // LACERTA_ENCODER_RANGE_ENCODER_H_
