// CRC-16 (polynomial 0x1021, start value 0xFFFF, highest bit first: "CRC-16/IBM-3740", also called CCITT-FALSE). Of bytes that are as many
// as before it notices every change that spans at most 16 bits, thus of any one byte or of two neighbors, and below 4 kB every change
// of up to three bits; others with a probability of 65,535 in 65,536.
#ifndef LACERTA_COMMON_CRC16_H_
#define LACERTA_COMMON_CRC16_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "lacerta/mesh.h"

namespace lacerta {

// A CRC-16 that takes its bytes piece by piece.
class Crc16 {
 public:
  void Add(uint8_t byte) { state_ = static_cast<uint16_t>(kTable[(state_ >> 8) ^ byte] ^ (state_ << 8)); }
  void Add(Span<const uint8_t> bytes) {
    for (const uint8_t byte : bytes) Add(byte);
  }
  // The four bytes of `value`, lowest first.
  void AddWord(uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) Add(static_cast<uint8_t>(value >> shift));
  }
  uint16_t value() const { return state_; }

 private:
  static const std::array<uint16_t, 256> kTable;

  uint16_t state_ = 0xffff;
};

}  // namespace lacerta

#endif  // LACERTA_COMMON_CRC16_H_
