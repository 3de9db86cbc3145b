// Reading the fields of a stream (docs/format.md, "Numbers"). Twin: encoder/byte_writer.h.
#ifndef LACERTA_DECODER_BYTE_CURSOR_H_
#define LACERTA_DECODER_BYTE_CURSOR_H_

#include <cstddef>
#include <cstdint>

#include "lacerta/mesh.h"

namespace lacerta {

// A cursor over bytes that may end too early; after that every read gives 0 and at_end() says so.
class ByteCursor {
 public:
  explicit ByteCursor(Span<const uint8_t> bytes) : bytes_(bytes) {}

  uint8_t Byte() {
    if (position_ < bytes_.size()) return bytes_[position_++];
    at_end_ = true;
    return 0;
  }
  uint16_t Word16() {
    const uint16_t low = Byte();
    return static_cast<uint16_t>(low | Byte() << 8);
  }
  uint32_t Word32() {
    const uint32_t low = Word16();
    return low | static_cast<uint32_t>(Word16()) << 16;
  }
  // Seven bits per byte, lowest first, the top bit set in all bytes but the last.
  uint32_t Varint() {
    uint32_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const uint8_t byte = Byte();
      const uint32_t bits = byte & 0x7f;
      if (shift == 28 && byte > 0x0f) break;
      value |= bits << shift;
      if (byte < 0x80) return value;
    }
    malformed_ = true;
    return 0;
  }

  // 0, -1, 1, -2, 2, ... as the varints 0, 1, 2, 3, 4, ...
  int32_t SignedVarint() {
    const uint32_t folded = Varint();
    return static_cast<int32_t>(folded >> 1) ^ -static_cast<int32_t>(folded & 1);
  }

  // The next bytes; none where there are not so many.
  Span<const uint8_t> Take(size_t size) {
    if (bytes_.size() - position_ < size) {
      at_end_ = true;
      return {};
    }
    position_ += size;
    return bytes_.Subspan(position_ - size).First(size);
  }

  Span<const uint8_t> Rest() const { return bytes_.Subspan(position_); }

  bool at_end() const { return at_end_; }        // a read went past the end
  bool malformed() const { return malformed_; }  // a varint exceeds 32 bits
  size_t position() const { return position_; }

 private:
  Span<const uint8_t> bytes_;
  size_t position_ = 0;
  bool at_end_ = false, malformed_ = false;
};

}  // namespace lacerta

#endif  // LACERTA_DECODER_BYTE_CURSOR_H_
