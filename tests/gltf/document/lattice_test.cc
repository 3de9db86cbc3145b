#include "document/lattice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lacerta {
namespace {

constexpr float kMost = std::numeric_limits<float>::max(), kInfinity = std::numeric_limits<float>::infinity();

Lattice Over(float origin, float range, int bits) {
  Lattice lattice;
  lattice.bits = bits;
  lattice.origin[0] = origin;
  lattice.range = range;
  return lattice;
}

TEST(LatticeTest, RoundsToTheNearestPointAndStaysInside) {
  const Lattice lattice = Over(-1.0f, 2.0f, 2);  // points at -1, -1/3, 1/3, 1
  EXPECT_EQ(lattice.Round(-0.9f, 0), 0);
  EXPECT_EQ(lattice.Round(0.2f, 0), 2);
  EXPECT_EQ(lattice.Round(-kMost, 0), 0);
  EXPECT_EQ(lattice.Round(kMost, 0), 3);
}

// As in assets whose coordinates are further apart than floats can tell.
TEST(LatticeTest, WhatIsNotFiniteIsAPointOfTheLattice) {
  for (const Lattice& lattice : {Over(-kMost, kInfinity, 12), Over(0.0f, 1.0f, 12)}) {
    for (const float value : {-kMost, 0.0f, kMost, kInfinity, -kInfinity, std::nanf("")}) {
      EXPECT_GE(lattice.Round(value, 0), 0) << value;
      EXPECT_LE(lattice.Round(value, 0), 4095) << value;
    }
  }
}

TEST(LatticeTest, StepsOfAnyRangeTakeALegalNumberOfBits) {
  for (const float range : {1e-30f, 1.0f, kMost, kInfinity}) {
    for (const float step : {0.0f, 1e-30f, 1e-3f, kInfinity}) {
      const int bits = LatticeOfStep(Over(0.0f, range, 1), step).bits;
      EXPECT_GE(bits, 1) << range << " in steps of " << step;
      EXPECT_LE(bits, kMostLatticeBits) << range << " in steps of " << step;
    }
  }
  EXPECT_EQ(LatticeOfStep(Over(0.0f, 1.0f, 1), 0.25f).bits, 3);  // 5 points
}

TEST(LatticeTest, WeightsKeepTheirSum) {
  const Lattice lattice = Over(0.0f, 1.0f, 4);  // steps of 1/15
  const std::vector<float> weights = {0.5f, 0.5f, 0, 0, 0.1f, 0.1f, 0.1f, 0.7f, 0.24f, 0.23f, 0.27f, 0.26f, 1, 0, 0, 0};
  const AccessorData data = MakeFloatAccessor(weights, 4), rounded = RoundKeepingSums(data, lattice);
  for (uint64_t i = 0; i < data.count; ++i) {
    float sum = 0.0f;
    for (uint32_t c = 0; c < 4; ++c) {
      sum += rounded.Float(i, c);
      EXPECT_NEAR(rounded.Float(i, c), data.Float(i, c), 1.0f / 15) << i;
    }
    EXPECT_NEAR(sum, 1.0f, 1e-6f) << i;
  }
  EXPECT_NEAR(rounded.Float(0, 0) + rounded.Float(0, 1), 1.0f, 1e-6f);  // one up, one down
  EXPECT_EQ(RoundKeepingSums(rounded, lattice).bytes, rounded.bytes);
  for (const float value : {kMost, kInfinity, std::nanf("")}) {
    EXPECT_EQ(RoundKeepingSums(MakeFloatAccessor({value, 0.5f}, 2), lattice).count, 1u);
  }
}

}  // namespace
}  // namespace lacerta
