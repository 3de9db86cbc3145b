#include "decoder/attribute_decoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "draco_ext/encoder/attributed_test_streams.h"
#include "lacerta/decoder.h"

namespace lacerta {
namespace {

using ::lacerta::testing::Coefficients;
using ::lacerta::testing::OctahedronWithAttributes;
using ::lacerta::testing::RandomCoefficients;
using ::lacerta::testing::RandomResiduals;
using ::testing::HasSubstr;

// The attributes before the one that fails have taken the level already. Their corners are those of the mesh all the same.
TEST(AttributeDecoderTest, ALevelOnWhichAnAttributeFailsIsNoLevelOfTheOthers) {
  const AttributedBase base = OctahedronWithAttributes();
  const BaseMesh glued = GlueBase(base).value().mesh;
  const Coefficients c = RandomCoefficients(glued, 2, 7);
  WrittenAttributes written = RandomResiduals(base, 2, 8, 2.0);
  CodedAttribute& color = written.coded[2];
  color.header.steps[1] = StepFromBits(0x7f7f);
  color.residuals[1].assign(color.residuals[1].size(), kMaxMagnitude);
  const std::vector<Topology> topologies = BuildTopologies(glued, 2).value();
  const Bytes stream = WriteRefinement(glued, topologies, c.steps, c.levels, {}, BaseStepField::kWritten, &written).value().bytes;

  ProgressiveDecoder decoder = ProgressiveDecoder::Create(base, {}).value();
  EXPECT_THAT(decoder.Append(stream).message(), HasSubstr("COLOR_0 has values that are not finite on level 2"));
  ASSERT_EQ(decoder.level(), 1);
  RefinementOptions one_level;
  one_level.max_level = 1;
  ProgressiveDecoder expected = ProgressiveDecoder::Create(base, one_level).value();
  ASSERT_TRUE(expected.Append(stream).ok());
  for (size_t a = 0; a < base.attributes.size(); ++a) {
    EXPECT_EQ(decoder.attributes()[a].values, expected.attributes()[a].values) << a;
    EXPECT_EQ(decoder.Corners(a), expected.Corners(a)) << a;
  }
}

TEST(AttributeDecoderTest, ColorsAloneAreChained) {
  const AttributedBase base = OctahedronWithAttributes();
  const BaseMesh glued = GlueBase(base).value().mesh;
  const Coefficients c = RandomCoefficients(glued, 2, 7);
  const std::vector<Topology> topologies = BuildTopologies(glued, 2).value();
  const auto write = [&](const WrittenAttributes& written) {
    return WriteRefinement(glued, topologies, c.steps, c.levels, {}, BaseStepField::kWritten, &written);
  };
  const WrittenAttributes plain = RandomResiduals(base, 2, 8, 2.0), chained = RandomResiduals(base, 2, 8, 2.0, true);
  const auto values_of = [&](const WrittenAttributes& written) {
    ProgressiveDecoder decoder = ProgressiveDecoder::Create(base, {}).value();
    EXPECT_TRUE(decoder.Append(write(written).value().bytes).ok());
    EXPECT_EQ(decoder.level(), 2);
    return decoder.attributes()[2].values;
  };
  // The same residuals: the first component is told as before, the others are sums of what is stored.
  const std::vector<float> apart = values_of(plain), summed = values_of(chained);
  ASSERT_EQ(apart.size(), summed.size());
  bool differs = false;
  for (size_t i = 0; i < apart.size(); ++i) {
    if (i % 3 == 0) {
      EXPECT_EQ(apart[i], summed[i]) << i;
    }
    differs = differs || apart[i] != summed[i];
  }
  EXPECT_TRUE(differs);

  for (const size_t other : {0, 1, 3}) {
    WrittenAttributes written = plain;
    written.coded[other].header.is_chained = true;
    EXPECT_THAT(write(written).status().message(), HasSubstr("has no colors to chain"));
  }
}

}  // namespace
}  // namespace lacerta
