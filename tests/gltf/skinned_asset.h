// Assets with skins for tests, and what a viewer shows of them in poses.
#ifndef LACERTA_TESTS_GLTF_SKINNED_ASSET_H_
#define LACERTA_TESTS_GLTF_SKINNED_ASSET_H_

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "document/animation.h"
#include "document/place.h"
#include "document/primitive.h"
#include "document/scene.h"
#include "gltf/torus_asset.h"
#include "shapes/attributed_shapes.h"

namespace lacerta::testing {

inline uint64_t AddData(const AccessorData& data, AssetBuilder* builder) {
  return AddAccessor(MakeAccessor(data, AccessorUse::kAttribute, false, &builder->document()), &builder->document());
}

// Inverse bind matrices of joints that stand at `origins`, unturned.
inline uint64_t AddInverseBinds(const std::vector<Vec3f>& origins, AssetBuilder* builder) {
  std::vector<float> columns;
  for (const Vec3f& o : origins)
    columns.insert(columns.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -o.x, -o.y, -o.z, 1});
  const uint64_t accessor = AddData(MakeFloatAccessor(columns, 4), builder);
  Json& json = builder->document().json["accessors"][static_cast<size_t>(accessor)];
  json["type"] = "MAT4";
  json["count"] = origins.size();
  return accessor;
}

// The skinned cylinder. With `bend` (degrees): an animation of one second in which both upper joints turn by so much
// about x. With `halved` in two primitives, left and right.
inline Bytes SkinnedCylinderAsset(const shapes::SkinnedSoup& cylinder, double bend, bool halved = false) {
  AssetBuilder builder;
  Json primitive = AddSoup(cylinder.soup, &builder);
  AccessorData joints;
  joints.type = ComponentType::kUint8;
  joints.components = 4;
  joints.count = cylinder.soup.positions.size();
  joints.bytes = cylinder.joints;
  primitive["attributes"]["JOINTS_0"] = AddData(joints, &builder);
  primitive["attributes"]["WEIGHTS_0"] = AddData(MakeFloatAccessor(cylinder.weights, 4), &builder);
  Json primitives = Json::array({primitive});
  if (halved) {
    TriangleMesh halves[2];
    for (const Triangle& t : cylinder.soup.triangles) {
      float x = 0.0f;
      for (const uint32_t v : t) x += cylinder.soup.positions[v].x;
      halves[x > 0.0f].triangles.push_back(t);
    }
    primitives = Json::array({primitive, primitive});
    for (size_t i = 0; i < 2; ++i) {
      halves[i].positions = cylinder.soup.positions;
      primitives[i]["indices"] = builder.AddIndices(halves[i]);
    }
  }
  builder.AddMesh("arm", std::move(primitives));
  Json& json = builder.document().json;
  const float third = 2.0943951f;
  const uint64_t binds = AddInverseBinds({{0, 0, 0}, {0, 0, third}, {0, 0, 2 * third}}, &builder);
  json["nodes"][0]["skin"] = 0;
  json["nodes"].push_back({{"children", {2}}});
  json["nodes"].push_back({{"children", {3}}, {"translation", {0, 0, third}}});
  json["nodes"].push_back({{"translation", {0, 0, third}}});
  json["scenes"][0]["nodes"].push_back(1);
  json["skins"] = Json::array({{{"joints", {1, 2, 3}}, {"inverseBindMatrices", binds}}});
  if (bend == 0) return builder.Glb();
  const double half = bend * 3.14159265358979 / 360;
  const uint64_t times = AddData(MakeFloatAccessor(std::vector<float>{0, 1}, 1), &builder);
  const uint64_t turns = AddData(
      MakeFloatAccessor({0, 0, 0, 1, static_cast<float>(std::sin(half)), 0, 0, static_cast<float>(std::cos(half))}, 4),
      &builder);
  Json channels = Json::array();
  for (const uint64_t node : {2, 3})
    channels.push_back({{"sampler", 0}, {"target", {{"node", node}, {"path", "rotation"}}}});
  json["animations"] =
      Json::array({{{"samplers", {{{"input", times}, {"output", turns}}}}, {"channels", std::move(channels)}}});
  return builder.Glb();
}

// A primitive of the mesh of the first node with a skin, unpacked, at a time of an animation: linear blend skinning as
// a viewer does it, written anew. World units.
inline TriangleMesh PosedAt(const Bytes& plain_glb, size_t animation, double time, uint64_t primitive_index = 0) {
  const GltfDocument document = ParseGltf(plain_glb, "").value();
  const Json& nodes = document.json["nodes"];
  std::vector<Transform> locals;
  std::vector<NodePlacement> placements;
  for (const Json& node : nodes) placements.push_back(ReadPlacement(node)), locals.push_back(LocalTransform(node));
  const std::vector<Animation> animations = ReadAnimations(document);
  if (animation < animations.size()) {
    for (const AnimationTrack& track : animations[animation].tracks) track.Place(time, &placements[track.node]);
    for (const AnimationTrack& track : animations[animation].tracks)
      locals[track.node] = ToTransform(placements[track.node]);
  }
  const auto world = [&](uint64_t node) {
    Transform result = locals[node];
    for (bool found = true; found;) {
      found = false;
      for (uint64_t parent = 0; parent < nodes.size() && !found; ++parent) {
        for (uint64_t c = 0; c < ArraySize(nodes[parent], "children") && !found; ++c) {
          if (AsIndex(FindElement(nodes[parent], "children", c)) != node) continue;
          result = Multiply(locals[parent], result);
          node = parent;
          found = true;
        }
      }
    }
    return result;
  };
  const auto shown = std::find_if(nodes.begin(), nodes.end(), [](const Json& node) { return node.contains("skin"); });
  const Json& skin = document.json["skins"][shown->at("skin").get<size_t>()];
  const AccessorData binds = ReadMatrices(document, skin["inverseBindMatrices"].get<uint64_t>()).value();
  std::vector<Transform> joints;
  for (size_t j = 0; j < skin["joints"].size(); ++j) {
    Transform bind;
    for (uint32_t i = 0; i < bind.size(); ++i) bind[i] = static_cast<double>(binds.Float(j, i / 3 * 4 + i % 3));
    joints.push_back(Multiply(world(skin["joints"][j].get<uint64_t>()), bind));
  }
  const Primitive primitive =
      ReadPrimitive(document, PrimitiveAt(document, {shown->at("mesh").get<uint64_t>(), primitive_index}), {}).value();
  const AccessorData &of = primitive.Find("JOINTS_0")->data, &by = primitive.Find("WEIGHTS_0")->data;
  TriangleMesh mesh = Surface(primitive);
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    Vec3d sum;
    for (uint32_t c = 0; c < 4; ++c)
      sum += Apply(joints[of.Uint(v, c)], Vec3Cast<double>(mesh.positions[v])) * static_cast<double>(by.Float(v, c));
    mesh.positions[v] = Vec3Cast<float>(sum);
  }
  return mesh;
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_GLTF_SKINNED_ASSET_H_
