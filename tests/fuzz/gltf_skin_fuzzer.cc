// Any bytes as an asset with skins, animations and morph targets: what reads keyframes, poses of the scene, joints and weights, and, of assets
// of a few triangles, the packer that rounds them.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "document/animation.h"
#include "document/scene_poses.h"
#include "fuzz/fuzz_input.h"
#include "fuzz/strange_asset.h"
#include "lacerta/gltf.h"
#include "pack/find_skin.h"
#include "pack/source.h"

namespace {

void CheckAnimations(const lacerta::GltfDocument& document) {
  for (const lacerta::Animation& animation : ReadAnimations(document)) {
    FUZZ_CHECK(!animation.tracks.empty());
    for (const lacerta::AnimationTrack& track : animation.tracks) {
      FUZZ_CHECK(!track.times.empty() && track.values.count == track.times.size());
      lacerta::NodePlacement placement;
      for (const double share : {-1.0, 0.0, 0.3, 1.0, 2.0}) {
        track.Place(animation.begin + share * (animation.end - animation.begin), &placement);
      }
    }
  }
}

// Poses are finite, and influences add up to a place in each of them.
void CheckSkin(const lacerta::Source& source, const lacerta::Skin& skin) {
  FUZZ_CHECK(skin.num_joints > 0 && !skin.poses.empty());
  for (size_t pose = 0; pose < skin.poses.size(); ++pose) {
    FUZZ_CHECK(skin.poses[pose].size() == skin.num_joints);
    for (const lacerta::Transform& joint : skin.poses[pose]) {
      for (const double x : joint) FUZZ_CHECK(std::isfinite(x));
    }
    const auto posed = PosedSurface({&*source.primitive}, skin, pose);
    FUZZ_CHECK(posed.ok() && posed.value().positions.size() == source.primitive->num_vertices);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const lacerta::Span<const uint8_t> asset(data, size);
  const auto document = lacerta::ParseGltf(asset, lacerta::fuzz::kNoFolder);
  if (!document.ok()) return 0;
  CheckAnimations(document.value());
  const std::vector<lacerta::ScenePose> poses = ScenePoses(document.value());
  for (const lacerta::ScenePose& pose : poses) FUZZ_CHECK(pose.size() == poses[0].size());
  const auto sources = ReadSources(document.value());
  if (!sources.ok()) return 0;
  size_t num_triangles = 0;
  for (const lacerta::Source& source : sources.value()) {
    if (!source.primitive.has_value()) continue;
    num_triangles += source.primitive->triangles.size();
    const auto skin = FindSkin(document.value(), {&source}, poses);
    FUZZ_CHECK(skin.ok() || !skin.status().message().empty());
    if (skin.ok()) CheckSkin(source, skin.value());
  }
  lacerta::fuzz::CheckPackingOfFew(asset, num_triangles);
  return 0;
}
