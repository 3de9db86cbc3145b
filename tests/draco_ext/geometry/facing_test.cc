#include "geometry/facing.h"

#include <gtest/gtest.h>

#include <utility>

#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

TEST(FacingTest, TheShareIsThatOfTheAreaThatLooksAway) {
  AttributedMesh mesh = WeldSoups({shapes::TexturedBox(4)}).value();  // 192 triangles of one size
  EXPECT_EQ(ShareAgainstNormals(mesh), 0);
  std::swap(mesh.surface.triangles[5][0], mesh.surface.triangles[5][1]);
  std::swap(mesh.surface.triangles[77][1], mesh.surface.triangles[77][2]);
  EXPECT_NEAR(ShareAgainstNormals(mesh), 2.0 / 192, 1e-6);
}

TEST(FacingTest, WithoutNormalsNothingLooksAway) {
  VertexSoup soup = shapes::TexturedBox(2);
  soup.attributes.pop_back();
  AttributedMesh mesh = WeldSoups({soup}).value();
  EXPECT_EQ(FindNormals(mesh), nullptr);
  std::swap(mesh.surface.triangles[5][0], mesh.surface.triangles[5][1]);
  EXPECT_EQ(ShareAgainstNormals(mesh), 0);
  EXPECT_EQ(ShareAgainstNormals(AttributedMesh()), 0);
}

TEST(FacingTest, AFaceThatHasNoNormalsFacesNowhere) {
  VertexSoup bare = shapes::TexturedBox(1);
  bare.attributes.clear();
  const AttributedMesh mesh = WeldSoups({shapes::TexturedBox(1), bare}).value();
  const MeshAttribute* normals = FindNormals(mesh);
  ASSERT_NE(normals, nullptr);
  EXPECT_NEAR(Norm(FacingOf(*normals, 0)), 3, 1e-6);
  EXPECT_EQ(Norm(FacingOf(*normals, 12)), 0);
}

}  // namespace
}  // namespace lacerta
