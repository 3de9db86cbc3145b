#include "document/scene.h"

#include <algorithm>
#include <string>
#include <utility>

namespace lacerta {
namespace {

// The numbers of node[key], or `standard` where it has none.
template <size_t kCount>
std::array<double, kCount> Numbers(const Json& node, const char* key, std::array<double, kCount> standard) {
  for (size_t i = 0; i < kCount; ++i) {
    const std::optional<double> number = AsNumber(FindElement(node, key, i));
    if (number.has_value()) standard[i] = *number;
  }
  return standard;
}

void PushNodes(const Json& parent, const char* key, const Transform& transform,
               std::vector<std::pair<uint64_t, Transform>>* stack) {
  for (uint64_t i = ArraySize(parent, key); i-- > 0;) {
    stack->push_back({AsIndex(FindElement(parent, key, i)).value_or(~uint64_t{0}), transform});
  }
}

}  // namespace

Vec3d Apply(const Transform& m, const Vec3d& p) {
  return {m[0] * p.x + m[3] * p.y + m[6] * p.z + m[9], m[1] * p.x + m[4] * p.y + m[7] * p.z + m[10],
          m[2] * p.x + m[5] * p.y + m[8] * p.z + m[11]};
}

Transform Multiply(const Transform& a, const Transform& b) {
  Transform result;
  const Vec3d origin = Apply(a, {});
  for (size_t column = 0; column < 4; ++column) {
    const Vec3d image = Apply(a, {b[3 * column], b[3 * column + 1], b[3 * column + 2]});
    const Vec3d moved = column == 3 ? image : image - origin;
    for (int axis = 0; axis < 3; ++axis) result[3 * column + static_cast<size_t>(axis)] = moved[axis];
  }
  return result;
}

NodePlacement ReadPlacement(const Json& node) {
  return {Numbers<3>(node, "translation", {0, 0, 0}), Numbers<4>(node, "rotation", {0, 0, 0, 1}),
          Numbers<3>(node, "scale", {1, 1, 1})};
}

Transform ToTransform(const NodePlacement& placement) {
  const auto& t = placement.translation;
  const auto [x, y, z, w] = placement.rotation;
  const auto& s = placement.scale;
  return {s[0] * (1 - 2 * (y * y + z * z)),
          s[0] * 2 * (x * y + z * w),
          s[0] * 2 * (x * z - y * w),
          s[1] * 2 * (x * y - z * w),
          s[1] * (1 - 2 * (x * x + z * z)),
          s[1] * 2 * (y * z + x * w),
          s[2] * 2 * (x * z + y * w),
          s[2] * 2 * (y * z - x * w),
          s[2] * (1 - 2 * (x * x + y * y)),
          t[0],
          t[1],
          t[2]};
}

Transform LocalTransform(const Json& node) {
  if (ArraySize(node, "matrix") == 16) {
    const auto m = Numbers<16>(node, "matrix", {});
    return {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10], m[12], m[13], m[14]};
  }
  return ToTransform(ReadPlacement(node));
}

double Determinant(const Transform& m) {
  return Dot(Cross(Vec3d{m[0], m[1], m[2]}, Vec3d{m[3], m[4], m[5]}), Vec3d{m[6], m[7], m[8]});
}

double LargestStretch(const Transform& m) {
  double stretch = 0.0;
  for (size_t column = 0; column < 3; ++column) {
    stretch = std::max(stretch, Norm(Vec3d{m[3 * column], m[3 * column + 1], m[3 * column + 2]}));
  }
  return stretch;
}

StatusOr<std::vector<Instance>> CollectInstances(const GltfDocument& document) {
  std::vector<Instance> instances;
  const uint64_t scene_index = AsIndex(Find(document.json, "scene")).value_or(0);
  const Json* scene = FindElement(document.json, "scenes", scene_index);
  if (scene == nullptr) {
    for (uint64_t m = 0; m < ArraySize(document.json, "meshes"); ++m) instances.push_back({m});
    return instances;
  }
  std::vector<std::pair<uint64_t, Transform>> stack;
  std::vector<bool> seen(static_cast<size_t>(ArraySize(document.json, "nodes")), false);
  PushNodes(*scene, "nodes", kIdentity, &stack);
  while (!stack.empty()) {
    const auto [index, parent] = stack.back();
    stack.pop_back();
    const Json* node = FindElement(document.json, "nodes", index);
    if (node == nullptr)
      return InvalidData("a node refers to node " + std::to_string(index) + ", which does not exist");
    if (seen[static_cast<size_t>(index)]) {
      return InvalidData("node " + std::to_string(index) + " has two parents or is its own ancestor");
    }
    seen[static_cast<size_t>(index)] = true;
    const Transform transform = Multiply(parent, LocalTransform(*node));
    if (const Json* mesh = Find(*node, "mesh"); mesh != nullptr) {
      const uint64_t mesh_index = AsIndex(mesh).value_or(~uint64_t{0});
      if (mesh_index >= ArraySize(document.json, "meshes")) {
        return InvalidData("node " + std::to_string(index) + " shows a mesh that does not exist");
      }
      instances.push_back({mesh_index, transform, AsIndex(Find(*node, "skin"))});
    }
    PushNodes(*node, "children", transform, &stack);
  }
  return instances;
}

}  // namespace lacerta
