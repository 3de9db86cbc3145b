#include "remesh/components.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "shapes/shapes.h"

namespace lacerta {
namespace {

TEST(ComponentsTest, HangTogetherByVertices) {
  EXPECT_EQ(CountComponents({}), 0u);
  const std::vector<Vec3f> points(7);
  EXPECT_EQ(CountComponents({points, {{0, 1, 2}}}), 1u);                        // vertices of no triangle count for nothing
  EXPECT_EQ(CountComponents({points, {{0, 1, 2}, {2, 3, 4}}}), 1u);             // by one vertex
  EXPECT_EQ(CountComponents({points, {{0, 1, 2}, {4, 5, 6}}}), 2u);
  EXPECT_EQ(CountComponents({points, {{0, 1, 2}, {4, 5, 6}, {6, 3, 0}}}), 1u);  // joined by the last
  EXPECT_EQ(CountComponents(shapes::BumpySphere(3)), 1u);
  EXPECT_EQ(CountComponents(shapes::TriangleSoup(2)), 320u);
}

TEST(ComponentsTest, AreNumberedByTheirFirstTriangles) {
  const std::vector<Vec3f> points(10);
  EXPECT_TRUE(FindComponents({}).empty());
  EXPECT_EQ(FindComponents({points, {{7, 8, 9}, {0, 1, 2}, {3, 4, 5}, {5, 6, 0}, {9, 8, 7}}}), (std::vector<uint32_t>{0, 1, 1, 1, 0}));
}

TEST(ComponentsTest, AreThoseOfAnyOrder) {
  TriangleMesh mesh = shapes::Scattered(shapes::Icosphere(1), 500);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937(1));
  EXPECT_EQ(CountComponents(mesh), 500u);
}

}  // namespace
}  // namespace lacerta
