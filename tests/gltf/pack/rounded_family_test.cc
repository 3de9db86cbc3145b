#include "pack/rounded_family.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "gltf/pack/textured_ball.h"

namespace lacerta {
namespace {

struct Coder {
  Coder()
      : attributes(RoundedAttributesOf(primitives, {}, [](size_t, uint64_t) { return 1024.0; })),
        forecast(primitives, attributes),
        coder(primitives, attributes, &forecast) {}

  RoundedFamily Coded(const RoundingLevels& levels) {
    RoundedFamily family = coder.RoundedAt(levels);
    EXPECT_TRUE(coder.Code(&family).ok());
    return family;
  }

  const Primitive ball = testing::TexturedBall(1.0f);
  const std::vector<const Primitive*> primitives = {&ball, &ball};
  const std::vector<RoundedAttribute> attributes;
  RoundingForecast forecast;
  FamilyCoder coder;
};

// Of normals and texture coordinates.
constexpr int kFine = 12 * kLevelsPerBit, kCoarse = 8 * kLevelsPerBit;

TEST(FamilyCoder, CodesWhatItSays) {
  Coder c;
  const RoundedFamily family = c.Coded({kFine, {kFine, kFine}});
  ASSERT_EQ(family.members.size(), 2u);
  EXPECT_EQ(family.size(), family.members[0].bytes.size() + family.members[1].bytes.size());
  EXPECT_EQ(family.size(), c.coder.BytesAsCoded(family).value());
  for (size_t m = 0; m < 2; ++m) {
    ASSERT_EQ(family.reports[m].size(), 2u);
    for (size_t a = 0; a < 2; ++a) {
      const RoundedAttribute& attribute = c.attributes[a];
      const AttributeReport& report = family.reports[m][a];
      EXPECT_EQ(report.bits, attribute.octahedral ? kFine / kLevelsPerBit : attribute.LatticeAt(attribute.parts[m], kFine).bits) << report.name;
      EXPECT_GT(report.error, 0.0);
      EXPECT_EQ(report.unit, attribute.unit);
    }
    EXPECT_EQ(family.members[m].decoded.triangles.size(), c.ball.triangles.size());
  }
  EXPECT_EQ(family.error, c.forecast.Positions(kFine).distance);
}

TEST(FamilyCoder, CoarserLevelsTakeFewerBytesDownToTheFewest) {
  Coder c;
  const uint64_t fine = c.Coded({kFine, {kFine, kFine}}).size(), coarse_normals = c.Coded({kFine, {kCoarse, kFine}}).size(),
                 coarse = c.Coded({kCoarse, {kCoarse, kCoarse}}).size();
  EXPECT_LT(coarse_normals, fine);
  EXPECT_LT(coarse, coarse_normals);
  const uint64_t fewest = c.coder.FewestBytes(c.forecast.Positions(kFine).distance), fewer = c.coder.FewestBytes(c.forecast.Positions(kCoarse).distance);
  EXPECT_LT(fewest, fine);
  EXPECT_GT(fewest, fine / 10);
  EXPECT_LT(fewer, fewest);
}

TEST(FamilyCoder, ValuesTakeTheirPlaceAndAnotherOrderKeepsThem) {
  Coder c;
  RoundedFamily family = c.Coded({kFine, {kFine, kFine}});
  const uint64_t before = family.size();
  const RoundedAttribute& texture = c.attributes[1];
  ASSERT_EQ(texture.name.rfind("TEXCOORD_0", 0), 0u);
  DescendedValues flat{kCoarse, {}, 7.0};
  for (const RoundedAttribute::Part& part : texture.parts) {
    const AccessorData zeros = MakeFloatAccessor(std::vector<float>(2 * c.ball.num_vertices), 2);
    flat.values.push_back(texture.RoundedAt(zeros, part, kCoarse));
  }
  c.coder.SetValues(1, flat, c.forecast.Positions(kFine), &family);
  ASSERT_TRUE(c.coder.Code(&family).ok());
  EXPECT_LT(family.size(), before * 3 / 4);
  EXPECT_EQ(family.reports[0][1].bits, texture.LatticeAt(texture.parts[0], kCoarse).bits);
  RoundedFamily anew = family;
  ASSERT_TRUE(c.coder.Code(&anew, DracoSearch::kPredictions).ok());
  EXPECT_LE(anew.size(), family.size());
  RoundedFamily other = anew;
  ASSERT_TRUE(c.coder.CodeInOtherOrder(&other).ok());
  EXPECT_LE(other.size(), anew.size());
  for (const RoundedFamily* one : {&anew, &other}) {
    const AccessorData& data = one->members[1].decoded.Find("TEXCOORD_0")->data;
    ASSERT_EQ(data.count, one->members[1].decoded.num_vertices);
    for (uint32_t i = 0; i < 2; ++i) EXPECT_NEAR(data.Float(0, i), 0.0f, 0.02f);
  }
}

}  // namespace
}  // namespace lacerta
