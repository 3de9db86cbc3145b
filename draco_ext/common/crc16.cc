#include "common/crc16.h"

#include "common/formula_table.h"

namespace lacerta {
namespace {

LACERTA_FORMULA_TABLE std::array<uint16_t, 256> MakeTable() {
  std::array<uint16_t, 256> table{};
  for (uint32_t i = 0; i < 256; ++i) {
    uint32_t entry = i << 8;
    for (int k = 0; k < 8; ++k) entry = (entry & 0x8000) != 0 ? 0x1021u ^ (entry << 1) : entry << 1;
    table[i] = static_cast<uint16_t>(entry);
  }
  return table;
}

}  // namespace

LACERTA_FORMULA_TABLE const std::array<uint16_t, 256> Crc16::kTable = MakeTable();

}  // namespace lacerta
