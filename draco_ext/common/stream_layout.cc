#include "common/stream_layout.h"

#include <algorithm>
#include <cstring>

#include "common/crc16.h"

namespace lacerta {
namespace {

Crc16 ChecksumOf(const BaseMesh& base) {
  Crc16 crc;
  uint32_t step_bits;
  std::memcpy(&step_bits, &base.step, sizeof(step_bits));
  crc.AddWord(step_bits);
  for (const auto& point : base.lattice) {
    for (const int32_t value : point) crc.AddWord(static_cast<uint32_t>(value));
  }
  for (const Triangle& triangle : base.triangles) {
    for (const uint32_t vertex : triangle) crc.AddWord(vertex);
  }
  return crc;
}

}  // namespace

bool RefinementHeader::IsSilent(size_t i) const {
  return steps[i].is_silent() && std::all_of(attributes.begin(), attributes.end(), [&](const AttributeHeader& a) { return a.steps[i] == 0; });
}

uint16_t BaseChecksum(const BaseMesh& base) { return ChecksumOf(base).value(); }

uint16_t BaseChecksum(const AttributedBase& base) {
  Crc16 crc = ChecksumOf(base.mesh);
  for (const uint32_t size : base.group_sizes) crc.AddWord(size);
  std::vector<uint8_t> has(base.mesh.lattice.size());
  for (const BaseAttribute& a : base.attributes) {
    std::fill(has.begin(), has.end(), uint8_t{0});
    auto triangle = base.mesh.triangles.begin();
    for (size_t g = 0; g < base.group_sizes.size(); ++g) {
      crc.Add(a.in_group[g]);
      const auto end = triangle + base.group_sizes[g];
      for (; triangle != end; ++triangle) {
        for (const uint32_t v : *triangle) has[v] |= a.in_group[g];
      }
    }
    const uint32_t n = a.numbers_per_value();
    for (size_t v = 0; v < has.size(); ++v) {
      for (uint32_t c = 0; has[v] != 0 && c < n; ++c) crc.AddWord(static_cast<uint32_t>(a.values[v * n + c]));
    }
  }
  return crc.value();
}

uint16_t SegmentChecksum(int what, Span<const uint8_t> payload) {
  Crc16 crc;
  crc.Add(static_cast<uint8_t>(what));
  crc.Add(payload);
  return crc.value();
}

}  // namespace lacerta
