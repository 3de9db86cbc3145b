#include "document/scene_poses.h"

#include <gtest/gtest.h>

#include <cmath>

#include "document/animation.h"
#include "gltf/skinned_asset.h"

namespace lacerta {
namespace {

GltfDocument Bent(double degrees) {
  return ParseGltf(testing::SkinnedCylinderAsset(shapes::SkinnedCylinder(6, 6), degrees), "").value();
}

TEST(ScenePoses, BeginAtRestThenAnimatedThenTurned) {
  const std::vector<ScenePose> poses = ScenePoses(Bent(90.0));
  ASSERT_EQ(poses.size(), 1u + 8u + 2u);
  const double third = 2.0943951;
  const auto tip = [](const ScenePose& pose) { return Apply(pose[3], {0, 0, 1}); };
  EXPECT_NEAR(tip(poses[0]).z, 2 * third + 1, 1e-6);
  EXPECT_NEAR(Norm(tip(poses[1]) - tip(poses[0])), 0.0, 1e-6);
  // At the end both joints are turned by 90 degrees: the last piece looks down.
  EXPECT_NEAR(tip(poses[8]).z, third - 1, 1e-5);
  EXPECT_NEAR(std::fabs(tip(poses[8]).y), third, 1e-5);
  for (size_t i = 9; i < 11; ++i) {
    const Vec3d up = Apply(poses[i][1], {0, 0, 1}) - Apply(poses[i][1], {});
    EXPECT_GT(up.z, std::cos(0.53));  // 30 degrees at most
    EXPECT_NEAR(Norm(up), 1.0, 1e-6);
    EXPECT_GT(Norm(tip(poses[i]) - tip(poses[0])), 0.1);
  }
}

TEST(ScenePoses, LoopsAndMissingNodesDoNoHarm) {
  GltfDocument document = Bent(90.0);
  document.json["nodes"][3]["children"] = {1, 77, 3};
  for (const ScenePose& pose : ScenePoses(document)) EXPECT_EQ(pose.size(), 4u);
}

TEST(Animation, TakesTheShorterWayAndStaysAtTheEnds) {
  AnimationTrack track;
  track.part = AnimationTrack::Part::kRotation;
  track.times = {1.0f, 3.0f};
  const float h = std::sqrt(0.5f);
  track.values =
      MakeFloatAccessor({0, 0, 0, 1, -h, 0, 0, -h}, 4);  // the second: 90 degrees about x, the other way written
  NodePlacement placement;
  track.Place(2.0, &placement);
  EXPECT_NEAR(placement.rotation[0], std::sin(0.3926991), 1e-6);
  EXPECT_NEAR(placement.rotation[3], std::cos(0.3926991), 1e-6);
  track.Place(0.0, &placement);
  EXPECT_NEAR(placement.rotation[3], 1.0, 1e-9);
  track.Place(9.0, &placement);
  EXPECT_NEAR(std::fabs(placement.rotation[3]), static_cast<double>(h), 1e-6);
  track.is_stepped = true;
  track.Place(2.9, &placement);
  EXPECT_NEAR(placement.rotation[3], 1.0, 1e-9);
}

TEST(Animation, TracksThatContradictThemselvesAreLeftOut) {
  GltfDocument document = Bent(90.0);
  EXPECT_EQ(ReadAnimations(document)[0].tracks.size(), 2u);
  document.json["animations"][0]["channels"][0]["target"]["path"] = "translation";  // values of four components
  EXPECT_EQ(ReadAnimations(document)[0].tracks.size(), 1u);
  document.json["animations"][0]["channels"][1]["sampler"] = 5;
  EXPECT_TRUE(ReadAnimations(document).empty());
}

}  // namespace
}  // namespace lacerta
