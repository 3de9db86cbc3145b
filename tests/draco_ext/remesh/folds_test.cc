#include "remesh/folds.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lacerta {
namespace {

TEST(FoldsTest, NormalsOfTrianglesThatLieOnEachOtherAreOpposite) {
  const auto at_degrees = [](double degrees) { return Vec3d{std::cos(degrees * 0.017453292519943), std::sin(degrees * 0.017453292519943), 0}; };
  EXPECT_TRUE(AreFolded({1, 0, 0}, at_degrees(180) * 1e-9));
  EXPECT_TRUE(AreFolded({1, 0, 0}, at_degrees(155)));
  EXPECT_FALSE(AreFolded({1, 0, 0}, at_degrees(145)));
  EXPECT_FALSE(AreFolded({1, 0, 0}, at_degrees(0)));
  EXPECT_FALSE(AreFolded({1, 0, 0}, {0, 0, 0}));
}

TEST(FoldsTest, AreaOfSpokesIsOfTheSmallerTriangle) {
  FoldedSpokes spokes;
  spokes.Add(1, 2, {0, 0, 2});
  spokes.Add(2, 3, {0, 0, -6});  // back upon the first
  EXPECT_DOUBLE_EQ(spokes.TakeArea(), 1);
  EXPECT_EQ(spokes.TakeArea(), 0);  // it forgot them
}

TEST(FoldsTest, AFanThatLiesFlatHasNoFolds) {
  FoldedSpokes spokes;
  for (uint32_t i = 0; i < 6; ++i) spokes.Add(i, (i + 1) % 6, {0, 0, 1});
  EXPECT_EQ(spokes.TakeArea(), 0);
}

TEST(FoldsTest, OrientationDoesNotMatter) {
  FoldedSpokes spokes;
  spokes.Add(1, 2, {0, 0, 2});
  spokes.Add(3, 2, {0, 0, -6});  // turned over: goes on in the same plane
  EXPECT_EQ(spokes.TakeArea(), 0);
  spokes.Add(1, 2, {0, 0, 2});
  spokes.Add(3, 2, {0, 0, 6});
  EXPECT_DOUBLE_EQ(spokes.TakeArea(), 1);
}

TEST(FoldsTest, EdgesOfThreeTrianglesDoNotCount) {
  FoldedSpokes spokes;
  spokes.Add(1, 2, {0, 0, 2});
  spokes.Add(2, 3, {0, 0, -6});
  spokes.Add(2, 4, {0, 3, 0});
  EXPECT_EQ(spokes.TakeArea(), 0);
}

}  // namespace
}  // namespace lacerta
