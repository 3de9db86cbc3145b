#include "common/stream_layout.h"

#include <cstring>

#include "common/crc32.h"

namespace lacerta {

uint16_t BaseChecksum(const BaseMesh& base) {
  Crc32 crc;
  uint32_t step_bits;
  std::memcpy(&step_bits, &base.step, sizeof(step_bits));
  crc.AddWord(step_bits);
  for (const auto& point : base.lattice) {
    for (const int32_t value : point) crc.AddWord(static_cast<uint32_t>(value));
  }
  for (const Triangle& triangle : base.triangles) {
    for (const uint32_t vertex : triangle) crc.AddWord(vertex);
  }
  return crc.low16();
}

uint16_t SegmentChecksum(int what, Span<const uint8_t> payload) {
  Crc32 crc;
  crc.Add(static_cast<uint8_t>(what));
  crc.Add(payload);
  return crc.low16();
}

}  // namespace lacerta
