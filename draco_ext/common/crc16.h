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
  static constexpr std::array<uint16_t, 256> MakeTable() {
    std::array<uint16_t, 256> table{};
    for (uint32_t i = 0; i < 256; ++i) {
      uint32_t entry = i << 8;
      for (int k = 0; k < 8; ++k) entry = (entry & 0x8000) != 0 ? 0x1021u ^ (entry << 1) : entry << 1;
      table[i] = static_cast<uint16_t>(entry);
    }
    return table;
  }
  static const std::array<uint16_t, 256> kTable;

  uint16_t state_ = 0xffff;
};

inline constexpr std::array<uint16_t, 256> Crc16::kTable = Crc16::MakeTable();

}  // namespace lacerta

#endif  // LACERTA_COMMON_CRC16_H_
