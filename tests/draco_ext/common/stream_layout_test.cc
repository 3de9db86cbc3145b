#include "common/stream_layout.h"

#include <gtest/gtest.h>

#include "common/crc32.h"

namespace lacerta {
namespace {

TEST(Crc32Test, MatchesTheKnownCheckValue) {
  Crc32 crc;
  EXPECT_EQ(crc.value(), 0u);
  for (const char c : {'1', '2', '3', '4', '5', '6', '7', '8', '9'}) crc.Add(static_cast<uint8_t>(c));
  EXPECT_EQ(crc.value(), 0xcbf43926u);
  EXPECT_EQ(crc.low16(), 0x3926u);
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
