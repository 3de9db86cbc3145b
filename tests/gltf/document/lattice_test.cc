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

}  // namespace
}  // namespace lacerta
