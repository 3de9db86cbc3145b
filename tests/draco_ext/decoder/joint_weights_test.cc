#include "decoder/joint_weights.h"

#include <gtest/gtest.h>

namespace lacerta {
namespace {

const JointTable kJoints = {3, 5, 8, 13, 300};

TEST(JointWeights, FourLargestAreKeptWithTheSumOne) {
  const float row[] = {0.1f, 0.5f, -0.2f, 0.3f, 0.1f}, many[] = {0.1f, 0.2f, 0.3f, 0.2f, 0.2f};
  const FourWeights four = LargestFour(row, kJoints);
  EXPECT_EQ(four.joints, (std::array<uint16_t, 4>{5, 13, 3, 300}));
  EXPECT_FLOAT_EQ(four.weights[0], 0.5f);
  EXPECT_FLOAT_EQ(four.weights[3], 0.1f);
  const FourWeights cut = LargestFour(many, kJoints);
  EXPECT_EQ(cut.joints, (std::array<uint16_t, 4>{8, 5, 13, 300}));
  EXPECT_FLOAT_EQ(cut.weights[0] + cut.weights[1] + cut.weights[2] + cut.weights[3], 1.0f);
  EXPECT_FLOAT_EQ(cut.weights[0], 1.0f / 3);
}

TEST(JointWeights, WithoutOneAboveZeroTheFirstTakesAll) {
  const float row[] = {0.0f, -1.0f, 0.0f, 0.0f, 0.0f};
  const FourWeights four = LargestFour(row, kJoints);
  EXPECT_EQ(four.joints, (std::array<uint16_t, 4>{3, 0, 0, 0}));
  EXPECT_EQ(four.weights, (std::array<float, 4>{1, 0, 0, 0}));
}

VertexSoup Soup() {
  VertexSoup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}};
  soup.attributes = {{"WEIGHTS_0", AttributeKind::kGeneric, 4, {0.25f, 0.75f, 0, 0, 0, 0, 0, 1}},
                     {"TEXCOORD_0", AttributeKind::kTextureCoordinates, 2, {0, 0, 1, 1}},
                     {"JOINTS_0", AttributeKind::kGeneric, 4, {13, 5, 0, 0, 0, 0, 0, 300}}};
  return soup;
}

TEST(JointWeights, SpreadAndGatheredTheyAreTheSame) {
  VertexSoup soup = Soup();
  ASSERT_TRUE(SpreadWeights(kJoints, &soup).ok());
  ASSERT_EQ(soup.attributes.size(), 2u);
  EXPECT_EQ(soup.attributes[0].components, 5u);
  EXPECT_EQ(soup.attributes[0].kind, AttributeKind::kWeights);
  EXPECT_EQ(soup.attributes[0].values, (std::vector<float>{0, 0.75f, 0, 0.25f, 0, 0, 0, 0, 0, 1}));
  GatherWeights(kJoints, &soup);
  ASSERT_EQ(soup.attributes.size(), 3u);
  EXPECT_EQ(soup.attributes[0].values, (std::vector<float>{0.75f, 0.25f, 0, 0, 1, 0, 0, 0}));
  EXPECT_EQ(soup.attributes[2].name, "JOINTS_0");
  EXPECT_EQ(soup.attributes[2].values, (std::vector<float>{5, 13, 0, 0, 300, 0, 0, 0}));
}

TEST(JointWeights, JointsWithoutWeightsAreRefused) {
  VertexSoup soup = Soup();
  soup.attributes.erase(soup.attributes.begin());
  EXPECT_EQ(SpreadWeights(kJoints, &soup).code(), StatusCode::kInvalidData);
}

TEST(JointWeights, WhatTheTableHasNotGotIsRefused) {
  VertexSoup soup = Soup();
  EXPECT_EQ(SpreadWeights({3, 5, 13}, &soup).code(), StatusCode::kInvalidData);
  soup = Soup();
  soup.attributes.pop_back();
  EXPECT_EQ(SpreadWeights(kJoints, &soup).code(), StatusCode::kInvalidData);
  soup.attributes.erase(soup.attributes.begin());
  EXPECT_TRUE(SpreadWeights(kJoints, &soup).ok());
}

}  // namespace
}  // namespace lacerta
