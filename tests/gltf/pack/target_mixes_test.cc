#include "pack/target_mixes.h"

#include <gmock/gmock.h>

#include "gltf/skinned_asset.h"

namespace lacerta {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Two meshes with three targets each, the first of which is looked at; node 0 shows it.
class TargetMixesTest : public ::testing::Test {
 protected:
  TargetMixesTest() {
    source_.places = {{0, 0}};
    json()["meshes"] = {{{"primitives", Json::array()}}, {{"primitives", Json::array()}, {"weights", {1, 1, 1}}}};
    json()["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}, {"weights", {5, 5, 5}}}};
  }

  Json& json() { return builder_.document().json; }

  void Animate(uint64_t node, const std::vector<float>& weights) {
    std::vector<float> times(weights.size() / 3);
    for (size_t i = 0; i < times.size(); ++i) times[i] = static_cast<float>(i);
    const uint64_t input = testing::AddData(MakeFloatAccessor(times, 1), &builder_), output = testing::AddData(MakeFloatAccessor(weights, 1), &builder_);
    json()["animations"] = Json::array({{{"samplers", {{{"input", input}, {"output", output}}}},
                                         {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "weights"}}}}}}}});
  }

  std::vector<TargetMix> Found() {
    const GltfDocument document = ParseGltf(builder_.Glb(), "").value();
    return FindTargetMixes(document, ReadWeightTracks(document), {&source_}, 3);
  }

  testing::AssetBuilder builder_;
  Source source_;
};

TEST_F(TargetMixesTest, OneTargetAloneIsNone) {
  EXPECT_THAT(Found(), IsEmpty());
  json()["meshes"][0]["weights"] = {0, 1, 0};
  json()["nodes"][0]["weights"] = {0.5, 0, 0.001};
  EXPECT_THAT(Found(), IsEmpty());
}

TEST_F(TargetMixesTest, AreThoseOfMeshAndNodes) {
  json()["meshes"][0]["weights"] = {0, 0.5, 0.5};
  json()["nodes"][0]["weights"] = {1, 1, 0};
  EXPECT_THAT(Found(), ElementsAre(TargetMix{1, 1, 0}, TargetMix{0, 0.5f, 0.5f}));
}

TEST_F(TargetMixesTest, LargeAndNegativeWeightsAreMixes) {
  json()["meshes"][0]["weights"] = {0, 2, 0};
  json()["nodes"][0]["weights"] = {0, 0, -1};
  EXPECT_THAT(Found(), ElementsAre(TargetMix{0, 2, 0}, TargetMix{0, 0, -1}));
}

TEST_F(TargetMixesTest, OfAnimationsAreThoseThatDifferMost) {
  std::vector<float> weights;
  for (int i = 0; i <= 15; ++i) weights.insert(weights.end(), {static_cast<float>(i) / 15, 1.0f, 0.0f});
  Animate(0, weights);
  const std::vector<TargetMix> found = Found();
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0], (TargetMix{1, 1, 0}));
  EXPECT_NEAR(found[1][0], 1.0f / 15, 1e-6f);  // at 0 it is one target alone
  Animate(1, weights);                         // of the other mesh
  EXPECT_THAT(Found(), IsEmpty());
}

TEST_F(TargetMixesTest, AlikeOnesAreOne) {
  json()["meshes"][0]["weights"] = {1, 1, 0};
  json()["nodes"][0]["weights"] = {1, 1, 0.05};
  EXPECT_EQ(Found().size(), 1u);
}

TEST_F(TargetMixesTest, WhatIsNoMixIsLeftOut) {
  json()["meshes"][0]["weights"] = {1, 1};
  json()["nodes"][0]["weights"] = {1, "1", 1};
  EXPECT_THAT(Found(), IsEmpty());
}

}  // namespace
}  // namespace lacerta
