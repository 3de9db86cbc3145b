#include "pack/attribute_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "gltf/test_assets.h"

namespace lacerta {
namespace {

TriangleMesh Square() { return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}; }

TEST(AttributeError, IntegratesLinearDifferencesExactly) {
  const TriangleMesh square = Square();
  const AccessorData zero = MakeFloatAccessor({{}, {}, {}, {}});
  const AccessorData constant = MakeFloatAccessor({{3, 4, 0}, {3, 4, 0}, {3, 4, 0}, {3, 4, 0}});
  EXPECT_NEAR(SurfaceRms(square, zero, constant), 5.0, 1e-12);
  // e = x over the unit square: the mean square is 1/3.
  const AccessorData ramp = MakeFloatAccessor({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 0, 0}});
  EXPECT_NEAR(SurfaceRms(square, zero, ramp), std::sqrt(1.0 / 3.0), 1e-12);
}

TEST(AttributeError, WithoutAreaItIsTheMeanOfCorners) {
  const TriangleMesh flat = {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
  EXPECT_NEAR(SurfaceRms(flat, MakeFloatAccessor({{}, {}, {}}), MakeFloatAccessor({{3, 0, 0}, {}, {}})), std::sqrt(3.0), 1e-12);
}

TEST(AttributeError, DirectionsAreInDegrees) {
  const TriangleMesh square = Square();
  const float c = std::cos(0.1f), s = std::sin(0.1f);
  const AccessorData up = MakeFloatAccessor({{0, 0, 1}, {0, 0, 2}, {0, 0, 3}, {0, 0, 1}});
  const AccessorData off = MakeFloatAccessor({{s, 0, c}, {s, 0, c}, {s, 0, c}, {s, 0, c}});
  EXPECT_NEAR(DirectionRms(square, up, off), 0.1 * 180 / 3.14159265358979, 1e-4);
  EXPECT_EQ(DirectionRms(square, MakeFloatAccessor({{}, {}, {}, {}}), off), 0.0);
}

TEST(AttributeError, CountsFlippedArea) {
  const TriangleMesh square = Square();
  EXPECT_EQ(FlippedShare(square, square.positions), 0.0);
  std::vector<Vec3f> moved = square.positions;
  moved[3] = {2, 1, 0};  // beyond the diagonal
  EXPECT_NEAR(FlippedShare(square, moved), 0.5, 1e-12);
}

}  // namespace
}  // namespace lacerta
