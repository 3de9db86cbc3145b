// CRC-32 (polynomial 0xEDB88320, reflected, as in zlib and PNG).
#ifndef LACERTA_COMMON_CRC32_H_
#define LACERTA_COMMON_CRC32_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "lacerta/mesh.h"

namespace lacerta {

// A CRC-32 that takes its bytes piece by piece.
class Crc32 {
 public:
  void Add(uint8_t byte) { state_ = kTable[(state_ ^ byte) & 0xff] ^ (state_ >> 8); }
  void Add(Span<const uint8_t> bytes) {
    for (const uint8_t byte : bytes) Add(byte);
  }
  // The four bytes of `value`, lowest first.
  void AddWord(uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) Add(static_cast<uint8_t>(value >> shift));
  }
  uint32_t value() const { return ~state_; }
  // The 16 bits that headers and segments carry.
  uint16_t low16() const { return static_cast<uint16_t>(~state_); }

 private:
  static constexpr std::array<uint32_t, 256> MakeTable() {
    std::array<uint32_t, 256> table{};
    for (uint32_t i = 0; i < 256; ++i) {
      uint32_t entry = i;
      for (int k = 0; k < 8; ++k) entry = (entry & 1) != 0 ? 0xedb88320u ^ (entry >> 1) : entry >> 1;
      table[i] = entry;
    }
    return table;
  }
  static const std::array<uint32_t, 256> kTable;

  uint32_t state_ = 0xffffffffu;
};

inline constexpr std::array<uint32_t, 256> Crc32::kTable = Crc32::MakeTable();

}  // namespace lacerta

#endif  // LACERTA_COMMON_CRC32_H_
