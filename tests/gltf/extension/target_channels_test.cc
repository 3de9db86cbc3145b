#include "extension/target_channels.h"

#include <gtest/gtest.h>

namespace lacerta {
namespace {

TEST(TargetChannels, NamesTellTheFirstTarget) {
  EXPECT_EQ(NameOf({42, "NORMAL"}), "TARGETS_42_NORMAL");
  const auto channels = ParseTargetChannels("TARGETS_42_NORMAL");
  ASSERT_TRUE(channels.has_value());
  EXPECT_EQ(channels->first, 42u);
  EXPECT_EQ(channels->attribute, "NORMAL");
  for (const char* const other :
       {"", "NORMAL", "TARGETS_", "TARGETS_POSITION", "TARGETS_x_POSITION", "TARGETS_0_COLOR_0", "TARGETS_00_NORMAL",
        "TARGETS_-1_NORMAL", "TARGETS_99999999999999999999_NORMAL", "TARGET_0/POSITION", "_TARGETS_0_POSITION"}) {
    EXPECT_FALSE(ParseTargetChannels(other).has_value()) << other;
  }
}

VertexSoup TwoVertices() {
  VertexSoup soup;
  soup.positions.resize(2);
  soup.attributes = {{"TARGETS_0_POSITION", AttributeKind::kGeneric, 6, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}},
                     {"TEXCOORD_0", AttributeKind::kTextureCoordinates, 2, {0, 0, 1, 1}},
                     {"TARGETS_2_POSITION", AttributeKind::kGeneric, 3, {0, 0, 1, 0, 0, 2}},
                     {"TARGETS_0_NORMAL", AttributeKind::kGeneric, 9, std::vector<float>(18, 0.5f)}};
  return soup;
}

TEST(TargetChannels, BecomeTargets) {
  VertexSoup soup = TwoVertices();
  const SoupTargets targets = TakeTargetChannels(&soup).value();
  ASSERT_EQ(soup.attributes.size(), 1u);
  EXPECT_EQ(soup.attributes[0].name, "TEXCOORD_0");
  ASSERT_EQ(targets.size(), 3u);
  for (const auto& target : targets) {
    ASSERT_EQ(target.size(), 2u);
    EXPECT_EQ(target[0].name, "POSITION");
    EXPECT_EQ(target[1].name, "NORMAL");
    EXPECT_EQ(target[1].values, std::vector<float>(6, 0.5f));
  }
  EXPECT_EQ(targets[0][0].values, (std::vector<float>{1, 2, 3, 7, 8, 9}));
  EXPECT_EQ(targets[1][0].values, (std::vector<float>{4, 5, 6, 10, 11, 12}));
  EXPECT_EQ(targets[2][0].values, (std::vector<float>{0, 0, 1, 0, 0, 2}));
}

TEST(TargetChannels, MissingAndRepeatedOnesAreRefused) {
  VertexSoup gap = TwoVertices(), twice = TwoVertices(), fewer_normals = TwoVertices(), odd = TwoVertices();
  gap.attributes[2].name = "TARGETS_3_POSITION";
  twice.attributes[2].name = "TARGETS_1_POSITION";
  fewer_normals.attributes[3].components = 6;
  odd.attributes[2].components = 2;
  for (VertexSoup* soup : {&gap, &twice, &fewer_normals, &odd})
    EXPECT_EQ(TakeTargetChannels(soup).status().code(), StatusCode::kInvalidData);
  VertexSoup none;
  EXPECT_TRUE(TakeTargetChannels(&none).value().empty());
}

}  // namespace
}  // namespace lacerta
