#include "lacerta/attributed_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "shapes/attributed_shapes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::SizeIs;

VertexSoup Quad(float x) {
  VertexSoup soup;
  soup.positions = {{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}};
  soup.triangles = {{0, 1, 2}, {0, 2, 3}};
  soup.attributes = {{"TEXCOORD_0", AttributeKind::kTextureCoordinates, 2, {0, 0, 1, 0, 1, 1, 0, 1}}};
  return soup;
}

// Position and values of every corner, in order: what a soup shows whatever its vertices are.
std::vector<std::vector<float>> CornersOf(const VertexSoup& soup) {
  std::vector<std::vector<float>> corners;
  for (const Triangle& t : soup.triangles) {
    for (const uint32_t v : t) {
      const Vec3f& p = soup.positions[v];
      corners.push_back({p.x, p.y, p.z});
      for (const VertexSoup::Attribute& a : soup.attributes) {
        const auto row = a.values.begin() + static_cast<std::ptrdiff_t>(v * a.components);
        corners.back().insert(corners.back().end(), row, row + a.components);
      }
    }
  }
  return corners;
}

void ExpectSameCorners(const std::vector<VertexSoup>& a, const std::vector<VertexSoup>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t g = 0; g < a.size(); ++g) EXPECT_EQ(CornersOf(a[g]), CornersOf(b[g])) << "group " << g;
}

TEST(WeldSoupsTest, SharesTheBorderOfTwoGroups) {
  const auto mesh = WeldSoups({Quad(0), Quad(1)});
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_THAT(mesh.value().surface.positions, SizeIs(6));
  EXPECT_EQ(mesh.value().groups, (std::vector<uint32_t>{0, 0, 1, 1}));
  ASSERT_THAT(mesh.value().attributes, SizeIs(1));
  EXPECT_EQ(mesh.value().attributes[0].num_values(), 4u);  // the same texture on both: a seam between them
  EXPECT_TRUE(CheckAttributedMesh(mesh.value()).ok());
}

TEST(WeldSoupsTest, AndSplittingLoseNothing) {
  std::vector<VertexSoup> soups = {Quad(0), Quad(1), Quad(5)};
  soups[1].attributes.push_back({"COLOR_0", AttributeKind::kColor, 4, {0, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1, 1, 1}});
  soups[2].attributes.clear();
  soups[2].triangles.push_back({1, 1, 2});  // degenerate
  soups[2].triangles.push_back({0, 1, 2});  // repeated
  const auto mesh = WeldSoups(soups);
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  ASSERT_TRUE(CheckAttributedMesh(mesh.value()).ok()) << CheckAttributedMesh(mesh.value()).message();
  const std::vector<VertexSoup> back = SplitIntoSoups(mesh.value(), 3);
  ExpectSameCorners(soups, back);
  for (const VertexSoup& soup : back) EXPECT_THAT(soup.positions, SizeIs(4));
  EXPECT_THAT(back[2].attributes, SizeIs(0));
}

TEST(WeldSoupsTest, FindsTheSeamOfACylinder) {
  // One column of vertices is there twice, for the texture; all is split off again.
  const VertexSoup cylinder = shapes::Cylinder(32, 8);
  const auto mesh = WeldSoups({cylinder});
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_EQ(mesh.value().surface.positions.size() + 9, cylinder.positions.size());
  const std::vector<VertexSoup> back = SplitIntoSoups(mesh.value(), 1);
  ExpectSameCorners({cylinder}, back);
  EXPECT_EQ(back[0].positions.size(), cylinder.positions.size());
}

TEST(WeldSoupsTest, MakesOneVertexOfCopiesAndDropsTheUnused) {
  VertexSoup soup = Quad(0);
  soup.positions.push_back({0, 0, -0.0f});  // vertex 0 again
  soup.positions.push_back({9, 9, 9});
  soup.triangles[1][0] = 4;
  soup.attributes[0].values.insert(soup.attributes[0].values.end(), {0, -0.0f, 7, 7});
  const auto mesh = WeldSoups({soup});
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_THAT(mesh.value().surface.positions, SizeIs(4));
  EXPECT_EQ(mesh.value().attributes[0].num_values(), 4u);
  EXPECT_THAT(SplitIntoSoups(mesh.value(), 1)[0].positions, SizeIs(4));
}

TEST(WeldSoupsTest, EmptyGroupsStay) {
  const auto mesh = WeldSoups({VertexSoup{}, Quad(0)});
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  const std::vector<VertexSoup> back = SplitIntoSoups(mesh.value(), 2);
  EXPECT_THAT(back[0].triangles, SizeIs(0));
  EXPECT_THAT(back[1].triangles, SizeIs(2));
}

TEST(WeldSoupsTest, NamesWhatIsWrong) {
  const auto message_of = [](const VertexSoup& soup) { return WeldSoups({Quad(0), soup}).status().message(); };
  VertexSoup soup = Quad(0);
  soup.positions[2].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(message_of(soup), "group 1: position of vertex 2 is not finite; repair or remove it");
  soup = Quad(0);
  soup.triangles[1][2] = 4;
  EXPECT_EQ(message_of(soup), "group 1: triangle 1 refers to vertex 4 of 4");
  soup = Quad(0);
  soup.attributes[0].values[7] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(message_of(soup), "group 1: TEXCOORD_0: value of vertex 3 is not finite; repair it");
  soup.attributes[0].values.pop_back();
  EXPECT_THAT(message_of(soup), HasSubstr("TEXCOORD_0: has 7 numbers for 4 vertices"));
}

TEST(CheckAttributedMeshTest, FindsBadIndices) {
  const AttributedMesh good = WeldSoups({Quad(0), Quad(1)}).value();
  EXPECT_TRUE(CheckAttributedMesh(good).ok());
  AttributedMesh bad = good;
  bad.surface.triangles[2][1] = 6;
  EXPECT_FALSE(CheckAttributedMesh(bad).ok());
  bad = good;
  bad.attributes[0].corners[1][0] = 4;
  EXPECT_FALSE(CheckAttributedMesh(bad).ok());
  bad = good;
  bad.groups.pop_back();
  EXPECT_FALSE(CheckAttributedMesh(bad).ok());
  bad = good;
  bad.attributes[0].corners[1] = {MeshAttribute::kNoValue, MeshAttribute::kNoValue, MeshAttribute::kNoValue};
  EXPECT_FALSE(CheckAttributedMesh(bad).ok());  // group 0 has and has not the attribute
  bad.attributes[0].corners[0] = bad.attributes[0].corners[1];
  EXPECT_TRUE(CheckAttributedMesh(bad).ok());
}

}  // namespace
}  // namespace lacerta
