// Writing the fields of a stream (docs/format.md, "Numbers"). Twin: decoder/byte_cursor.h.
#ifndef LACERTA_ENCODER_BYTE_WRITER_H_
#define LACERTA_ENCODER_BYTE_WRITER_H_

#include <cstddef>
#include <cstdint>

#include "lacerta/mesh.h"

namespace lacerta {

inline void PutWord16(uint32_t value, Bytes* bytes) {
  bytes->push_back(static_cast<uint8_t>(value));
  bytes->push_back(static_cast<uint8_t>(value >> 8));
}

inline void PutWord32(uint32_t value, Bytes* bytes) {
  PutWord16(value & 0xffff, bytes);
  PutWord16(value >> 16, bytes);
}

inline void PutVarint(size_t value, Bytes* bytes) {
  for (; value >= 0x80; value >>= 7) bytes->push_back(static_cast<uint8_t>(value | 0x80));
  bytes->push_back(static_cast<uint8_t>(value));
}

// 0, -1, 1, -2, 2, ... as the varints 0, 1, 2, 3, 4, ...
inline void PutSignedVarint(int32_t value, Bytes* bytes) {
  PutVarint(value < 0 ? 2 * static_cast<uint32_t>(-(value + 1)) + 1 : 2 * static_cast<uint32_t>(value), bytes);
}

}  // namespace lacerta

#endif  // LACERTA_ENCODER_BYTE_WRITER_H_
