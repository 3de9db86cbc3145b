#include "document/animation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "gltf/skinned_asset.h"

namespace lacerta {
namespace {

// A document with one animation of the weights of node 3.
GltfDocument WithTrack(const std::vector<float>& times, const std::vector<float>& weights, const std::string& interpolation) {
  testing::AssetBuilder builder;
  const uint64_t input = testing::AddData(MakeFloatAccessor(times, 1), &builder), output = testing::AddData(MakeFloatAccessor(weights, 1), &builder);
  Json& json = builder.document().json;
  const Json sampler = {{"input", input}, {"output", output}, {"interpolation", interpolation}};
  json["animations"] = Json::array({{{"samplers", {sampler}}, {"channels", {{{"sampler", 0}, {"target", {{"node", 3}, {"path", "weights"}}}}}}}});
  return ParseGltf(builder.Glb(), "").value();
}

TEST(WeightTracks, HaveAWeightForEachTargetAtEachKeyframe) {
  const std::vector<WeightTrack> tracks = ReadWeightTracks(WithTrack({0, 1}, {0.1f, 0.2f, 0.3f, 1.1f, 1.2f, 1.3f}, "LINEAR"));
  ASSERT_EQ(tracks.size(), 1u);
  EXPECT_EQ(tracks[0].node, 3u);
  EXPECT_EQ(tracks[0].num_targets, 3u);
  ASSERT_EQ(tracks[0].values.count, 6u);
  EXPECT_EQ(tracks[0].values.Float(4, 0), 1.2f);
}

TEST(WeightTracks, OfCubicSplinesAreWithoutTangents) {
  const std::vector<float> weights = {9, 9, 0.1f, 0.2f, 8, 8, 7, 7, 1.1f, 1.2f, 6, 6};
  const std::vector<WeightTrack> tracks = ReadWeightTracks(WithTrack({0, 1}, weights, "CUBICSPLINE"));
  ASSERT_EQ(tracks.size(), 1u);
  EXPECT_EQ(tracks[0].num_targets, 2u);
  ASSERT_EQ(tracks[0].values.count, 4u);
  const std::vector<float> expected = {0.1f, 0.2f, 1.1f, 1.2f};
  for (uint64_t i = 0; i < 4; ++i) EXPECT_EQ(tracks[0].values.Float(i, 0), expected[i]);
}

TEST(WeightTracks, ThatDoNotFitTheirTimesAreLeftOut) {
  EXPECT_TRUE(ReadWeightTracks(WithTrack({0, 1}, {1, 2, 3}, "LINEAR")).empty());
  EXPECT_TRUE(ReadWeightTracks(WithTrack({0, 1}, {1, 2, 3, 4}, "CUBICSPLINE")).empty());
  EXPECT_TRUE(ReadWeightTracks(WithTrack({1, 0}, {1, 2}, "LINEAR")).empty());
  EXPECT_TRUE(ReadAnimations(WithTrack({0, 1}, {1, 2}, "LINEAR")).empty());  // they move no node
}

}  // namespace
}  // namespace lacerta
