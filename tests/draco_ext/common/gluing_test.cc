#include "common/gluing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/glued_base.h"
#include "common/subdivision.h"
#include "draco_ext/encoder/attributed_test_streams.h"

namespace lacerta {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Lattice = std::vector<std::array<int32_t, 3>>;

GluedCorners GlueAll(const Lattice& lattice, const std::vector<Triangle>& triangles) {
  return GlueCorners(std::vector<uint8_t>(triangles.size(), 1), PairHalfEdges(lattice, triangles));
}

const Lattice kSquare = {{{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, 0}}, {{0, 1, 0}}, {{0, 0, 0}}, {{1, 1, 0}}, {{5, 5, 5}}};

TEST(GluingTest, VerticesAtOnePlaceAreOneAcrossAnEdge) {
  const GluedCorners glued = GlueAll(kSquare, {{0, 1, 2}, {4, 5, 3}});
  EXPECT_THAT(glued.vertices, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  EXPECT_THAT(glued.first_corner, ElementsAre(0, 1, 2, 5));
}

TEST(GluingTest, ThirdSidesAndTurnedOnesStayApart) {
  EXPECT_EQ(GlueAll(kSquare, {{0, 1, 2}, {4, 5, 3}, {0, 2, 6}}).first_corner.size(), 9u);
  EXPECT_EQ(GlueAll(kSquare, {{0, 1, 2}, {5, 4, 3}}).first_corner.size(), 6u);
}

TEST(GluingTest, TrianglesThatTouchInAPointStayApart) {
  const Lattice lattice = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{-1, 0, 0}}, {{0, -1, 0}}};
  EXPECT_EQ(GlueAll(lattice, {{0, 1, 2}, {0, 3, 4}}).first_corner.size(), 6u);
}

TEST(GluedBaseTest, SurfaceIsWholeAndAttributesHaveTheirSeams) {
  const GluedBase base = GlueBase(testing::OctahedronWithAttributes()).value();
  EXPECT_EQ(base.mesh.lattice.size(), 6u);
  EXPECT_TRUE(BuildTopology(6, base.mesh.triangles).ok());
  EXPECT_THAT(base.groups, ElementsAre(0, 0, 0, 0, 1, 1, 1, 1));
  // Three corners of one triangle stand apart from the rest.
  EXPECT_EQ(base.attributes[0].num_base_values, 9u);
  EXPECT_EQ(base.attributes[2].num_base_values, 5u);  // the color of the upper half alone
  EXPECT_EQ(base.attributes[2].base_corners[4][0], MeshAttribute::kNoValue);
  EXPECT_NE(base.attributes[2].base_corners[3][0], MeshAttribute::kNoValue);
}

TEST(GluedBaseTest, WrongShapesAreRefused) {
  AttributedBase base = testing::OctahedronWithAttributes();
  base.group_sizes[0] = 5;
  EXPECT_THAT(GlueBase(base).status().message(), HasSubstr("add up"));
  base = testing::OctahedronWithAttributes();
  base.attributes[0].values.pop_back();
  EXPECT_THAT(GlueBase(base).status().message(), HasSubstr("TEXCOORD_0"));
  base = testing::OctahedronWithAttributes();
  base.attributes[1].values[0] = 255;
  EXPECT_THAT(GlueBase(base).status().message(), HasSubstr("off its lattice"));
  base = testing::OctahedronWithAttributes();
  base.mesh.triangles[2][1] = 24;
  EXPECT_THAT(GlueBase(base).status().message(), HasSubstr("vertex 24"));
}

}  // namespace
}  // namespace lacerta
