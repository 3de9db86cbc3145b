#include "document/scene_poses.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "document/animation.h"

namespace lacerta {
namespace {

constexpr size_t kMostTimes = 48;        // of all animations
constexpr size_t kTimesOfAnimation = 8;  // at most
constexpr int kTurnedPoses = 2;
constexpr double kTurn = 30.0 * 3.14159265358979323846 / 180.0;

class Nodes {
 public:
  explicit Nodes(const GltfDocument& document) {
    const uint64_t count = ArraySize(document.json, "nodes");
    std::vector<bool> has_parent(static_cast<size_t>(count), false);
    for (uint64_t n = 0; n < count; ++n) {
      const Json& node = *FindElement(document.json, "nodes", n);
      const bool has_matrix = Find(node, "matrix") != nullptr;
      placements_.push_back(has_matrix ? std::nullopt : std::optional<NodePlacement>(ReadPlacement(node)));
      locals_.push_back(LocalTransform(node));
      parents_.push_back(count);
    }
    for (uint64_t n = 0; n < count; ++n) {
      const Json& node = *FindElement(document.json, "nodes", n);
      for (uint64_t c = 0; c < ArraySize(node, "children"); ++c) {
        const uint64_t child = AsIndex(FindElement(node, "children", c)).value_or(count);
        if (child >= count || has_parent[static_cast<size_t>(child)]) continue;
        has_parent[static_cast<size_t>(child)] = true;
        parents_[static_cast<size_t>(child)] = n;
      }
    }
    // What hangs on no root is a loop and stays out.
    std::vector<bool> taken(static_cast<size_t>(count), false);
    for (uint64_t n = 0; n < count; ++n) {
      if (!has_parent[static_cast<size_t>(n)]) order_.push_back(static_cast<size_t>(n));
    }
    for (size_t i = 0; i < order_.size(); ++i) {
      const Json& node = *FindElement(document.json, "nodes", order_[i]);
      for (uint64_t c = 0; c < ArraySize(node, "children"); ++c) {
        const uint64_t child = AsIndex(FindElement(node, "children", c)).value_or(count);
        if (child >= count || parents_[static_cast<size_t>(child)] != order_[i] || taken[static_cast<size_t>(child)])
          continue;
        taken[static_cast<size_t>(child)] = true;
        order_.push_back(static_cast<size_t>(child));
      }
    }
  }

  ScenePose At(const Animation& animation, double time) const {
    std::vector<std::optional<NodePlacement>> placements = placements_;
    for (const AnimationTrack& track : animation.tracks) {
      if (track.node < placements.size() && placements[static_cast<size_t>(track.node)].has_value()) {
        track.Place(time, &*placements[static_cast<size_t>(track.node)]);
      }
    }
    std::vector<Transform> locals = locals_;
    for (const AnimationTrack& track : animation.tracks) {
      if (track.node < placements.size() && placements[static_cast<size_t>(track.node)].has_value()) {
        locals[static_cast<size_t>(track.node)] = ToTransform(*placements[static_cast<size_t>(track.node)]);
      }
    }
    return World(locals);
  }

  // Every joint turned about an axis of its own.
  ScenePose Turned(const std::vector<bool>& is_joint, int which) const {
    std::vector<Transform> locals = locals_;
    for (size_t n = 0; n < locals.size(); ++n) {
      if (!is_joint[n]) continue;
      // Directions evenly spread over the sphere, by two irrational numbers.
      const double step = static_cast<double>(n * kTurnedPoses) + which + 0.5;
      const double z = 2.0 * std::fmod(step * 0.7548776662466927, 1.0) - 1.0;
      const double angle = 6.283185307179586 * std::fmod(step * 0.5698402909980532, 1.0);
      const double ring = std::sqrt(std::max(0.0, 1.0 - z * z)), half = std::sin(kTurn / 2);
      NodePlacement turn;
      turn.rotation = {half * ring * std::cos(angle), half * ring * std::sin(angle), half * z, std::cos(kTurn / 2)};
      locals[n] = Multiply(locals[n], ToTransform(turn));
    }
    return World(locals);
  }

  ScenePose AtRest() const { return World(locals_); }

 private:
  ScenePose World(const std::vector<Transform>& locals) const {
    ScenePose pose(locals.size(), kIdentity);
    for (const size_t n : order_) {
      const auto parent = static_cast<size_t>(parents_[n]);
      pose[n] = parent < locals.size() ? Multiply(pose[parent], locals[n]) : locals[n];
    }
    return pose;
  }

  std::vector<std::optional<NodePlacement>> placements_;  // empty: it has a matrix, which is not animated
  std::vector<Transform> locals_;
  std::vector<uint64_t> parents_;  // beyond the last: none
  std::vector<size_t> order_;      // parents first
};

std::vector<bool> JointsOf(const GltfDocument& document) {
  std::vector<bool> is_joint(static_cast<size_t>(ArraySize(document.json, "nodes")), false);
  for (uint64_t s = 0; s < ArraySize(document.json, "skins"); ++s) {
    const Json& skin = *FindElement(document.json, "skins", s);
    for (uint64_t j = 0; j < ArraySize(skin, "joints"); ++j) {
      const uint64_t node = AsIndex(FindElement(skin, "joints", j)).value_or(is_joint.size());
      if (node < is_joint.size()) is_joint[static_cast<size_t>(node)] = true;
    }
  }
  return is_joint;
}

}  // namespace

ScenePose RestPose(const GltfDocument& document) { return Nodes(document).AtRest(); }

std::vector<ScenePose> ScenePoses(const GltfDocument& document) {
  const Nodes nodes(document);
  std::vector<ScenePose> poses = {nodes.AtRest()};
  const std::vector<Animation> animations = ReadAnimations(document);
  constexpr size_t kMostTransforms = 1'000'000;  // of all nodes in all poses
  const size_t most_times = std::clamp(kMostTransforms / std::max<size_t>(poses[0].size(), 1), size_t{1}, kMostTimes);
  const size_t shown = std::min(animations.size(), most_times);
  for (size_t i = 0; i < shown; ++i) {
    const Animation& animation = animations[i * animations.size() / shown];
    const size_t times = std::clamp(most_times / shown, size_t{1}, kTimesOfAnimation);
    for (size_t k = 0; k < times; ++k) {
      const double share = times == 1 ? 0.5 : static_cast<double>(k) / static_cast<double>(times - 1);
      poses.push_back(nodes.At(animation, animation.begin + share * (animation.end - animation.begin)));
    }
  }
  const std::vector<bool> is_joint = JointsOf(document);
  for (int which = 0; which < kTurnedPoses; ++which) poses.push_back(nodes.Turned(is_joint, which));
  return poses;
}

}  // namespace lacerta
