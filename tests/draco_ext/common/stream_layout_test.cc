#include "common/stream_layout.h"

#include <gtest/gtest.h>

#include <vector>

#include "common/crc16.h"

namespace lacerta {
namespace {

TEST(Crc16Test, MatchesTheKnownCheckValue) {
  Crc16 crc;
  EXPECT_EQ(crc.value(), 0xffffu);
  for (const char c : {'1', '2', '3', '4', '5', '6', '7', '8', '9'}) crc.Add(static_cast<uint8_t>(c));
  EXPECT_EQ(crc.value(), 0x29b1u);
}

TEST(Crc16Test, WordsComeLowestByteFirst) {
  Crc16 word, bytes;
  word.AddWord(0x04030201u);
  bytes.Add(Bytes{1, 2, 3, 4});
  EXPECT_EQ(word.value(), bytes.value());
}

// No two pairs of bytes lead to the same state, and equal bytes after them keep different states different.
TEST(Crc16Test, NoticesEveryChangeOfTwoNeighboringBytes) {
  std::vector<bool> seen(0x10000);
  for (uint32_t change = 0; change < 0x10000; ++change) {
    Crc16 crc;
    crc.Add(static_cast<uint8_t>(change));
    crc.Add(static_cast<uint8_t>(change >> 8));
    EXPECT_FALSE(seen[crc.value()]) << change;
    seen[crc.value()] = true;
  }
}

TEST(BaseChecksumTest, SeesEveryValueAndTheOrder) {
  const BaseMesh base{1.0f, {{{0, 1, 2}}, {{-3, 4, 5}}, {{6, 7, 8}}}, {{{0, 1, 2}}}};
  BaseMesh moved = base, turned = base, swapped = base, scaled = base;
  moved.lattice[1][2] += 1;
  turned.triangles[0] = {1, 2, 0};
  std::swap(swapped.lattice[0], swapped.lattice[1]);
  EXPECT_NE(BaseChecksum(base), BaseChecksum(moved));
  EXPECT_NE(BaseChecksum(base), BaseChecksum(turned));
  EXPECT_NE(BaseChecksum(base), BaseChecksum(swapped));
  scaled.step = 1.0078125f;
  EXPECT_NE(BaseChecksum(base), BaseChecksum(scaled));
}

TEST(SegmentChecksumTest, DependsOnTheLevel) {
  const Bytes payload = {1, 2, 3};
  EXPECT_NE(SegmentChecksum(1, payload), SegmentChecksum(2, payload));
}

}  // namespace
}  // namespace lacerta
