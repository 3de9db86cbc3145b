#include "remesh/error_floor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lacerta {
namespace {

// Of a floor and what 1000 triangles leave beside it.
ErrorAtSize At(double floor, double removable, double triangles) {
  return {std::hypot(floor, removable * 1000 / triangles), triangles};
}

TEST(ErrorFloor, CountsWhatMoreTrianglesTakeAwayAgainstWhatTheFloorLeaves) {
  for (const double floor : {0.0, 0.3, 0.6, 0.9}) {
    const double left = std::sqrt(1 - floor * floor);
    for (const double size : {1500.0, 2000.0, 4000.0}) {
      EXPECT_TRUE(IsNearItsFloor(At(floor, 0.19 * left * size / 1000, 1000), At(floor, 0.19 * left * size / 1000, size), 1, 0.2));
      EXPECT_FALSE(IsNearItsFloor(At(floor, 0.21 * left * size / 1000, 1000), At(floor, 0.21 * left * size / 1000, size), 1, 0.2));
    }
  }
}

TEST(ErrorFloor, OneSizeAloneHasToBeSmall) {
  EXPECT_TRUE(IsNearItsFloor({0.19, 1000}, {0.19, 1000}, 1, 0.2));
  EXPECT_FALSE(IsNearItsFloor({0.21, 1000}, {0.21, 1000}, 1, 0.2));
}

TEST(ErrorFloor, HasToLeaveRoom) {
  EXPECT_TRUE(IsNearItsFloor({0.99, 1000}, {0.99, 2000}, 1, 0.2));
  EXPECT_FALSE(IsNearItsFloor({1.01, 1000}, {1.01, 2000}, 1, 0.2));
  EXPECT_TRUE(IsNearItsFloor({9, 1000}, {9, 2000}, std::numeric_limits<double>::infinity(), 0.2));
}

TEST(ErrorFloor, ErrorsThatGrowWithTheTrianglesAreTheFloor) {
  EXPECT_TRUE(IsNearItsFloor({0.5, 1000}, {0.6, 2000}, 1, 0.2));
  EXPECT_FALSE(IsNearItsFloor({0.9, 1000}, {1.1, 2000}, 1, 0.2));
}

}  // namespace
}  // namespace lacerta
