// Balls with morph targets, and their surfaces with some of them.
#ifndef LACERTA_TESTS_GLTF_MORPHED_ASSET_H_
#define LACERTA_TESTS_GLTF_MORPHED_ASSET_H_

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "decoder/smooth_normals.h"
#include "document/place.h"
#include "document/primitive.h"
#include "gltf/test_assets.h"

namespace lacerta::testing {

struct HillOptions {
  uint32_t rings = 60, sectors = 100;
  int targets = 4;
  bool normals = false;
  bool halved = false;  // two primitives that touch
  float bumps = 0;
  bool in_one_place = false;    // all hills, so that they add up
  std::vector<float> weights = {};  // that the mesh has by itself
};

inline std::vector<Vec3f> HillOffsets(const TriangleMesh& ball, int target) {
  const Vec3f top{std::cos(1.6f * static_cast<float>(target)), std::sin(1.6f * static_cast<float>(target)), 0};
  std::vector<Vec3f> offsets;
  for (const Vec3f& p : ball.positions) {
    const float w = std::max(0.0f, 1 - SquaredNorm(p - top) / 0.36f);
    offsets.push_back(Normalized(p) * (0.3f * w * w));
  }
  return offsets;
}

// A ball with targets that raise a round hill each; nothing moves elsewhere.
inline Bytes BallWithHills(const HillOptions& options = {}) {
  TriangleMesh ball = WavySphere(options.rings, options.sectors);
  for (Vec3f& p : ball.positions) {
    p *= 1 + options.bumps *
                 (std::sin(5 * p.x + 2 * p.y) + std::sin(7 * p.z - 3 * p.x) + 0.5f * std::sin(15 * p.y + 4 * p.z));
  }
  const std::vector<Vec3f> normals = SmoothNormals(ball.positions, ball.triangles);
  AssetBuilder builder;
  Json primitives = Json::array();
  for (int half = 0; half < (options.halved ? 2 : 1); ++half) {
    std::vector<uint32_t> vertices;  // of the ball
    TriangleMesh part;
    std::vector<int64_t> at(ball.positions.size(), -1);
    for (const Triangle& t : ball.triangles) {
      if (options.halved && (ball.positions[t[0]].x > 0) != (half == 0)) continue;
      for (const uint32_t v : t) {
        if (at[v] >= 0) continue;
        at[v] = static_cast<int64_t>(vertices.size());
        vertices.push_back(v);
        part.positions.push_back(ball.positions[v]);
      }
      part.triangles.push_back(
          {static_cast<uint32_t>(at[t[0]]), static_cast<uint32_t>(at[t[1]]), static_cast<uint32_t>(at[t[2]])});
    }
    const auto pick = [&](const std::vector<Vec3f>& all) {
      std::vector<Vec3f> own;
      own.reserve(vertices.size());
      for (const uint32_t v : vertices) own.push_back(all[v]);
      return own;
    };
    Json primitive = builder.Primitive(part), targets = Json::array();
    if (options.normals) primitive["attributes"]["NORMAL"] = builder.AddFloats(pick(normals), false);
    for (int t = 0; t < options.targets; ++t) {
      const std::vector<Vec3f> offsets = HillOffsets(ball, options.in_one_place ? 0 : t);
      Json target = {{"POSITION", builder.AddFloats(pick(offsets), true)}};
      if (options.normals) {
        std::vector<Vec3f> moved = ball.positions;
        for (size_t v = 0; v < moved.size(); ++v) moved[v] += offsets[v];
        std::vector<Vec3f> turned = SmoothNormals(moved, ball.triangles);
        for (size_t v = 0; v < turned.size(); ++v) turned[v] = turned[v] - normals[v];
        target["NORMAL"] = builder.AddFloats(pick(turned), false);
      }
      targets.push_back(std::move(target));
    }
    primitive["targets"] = std::move(targets);
    primitives.push_back(std::move(primitive));
  }
  builder.document().json["materials"] =
      Json::array({{{"name", "red"}}});  // without numbers that might be an accessor's
  builder.AddMesh("ball", std::move(primitives));
  if (!options.weights.empty()) builder.document().json["meshes"][0]["weights"] = options.weights;
  return builder.Glb();
}

// A primitive of the first mesh, unpacked, with its targets at these weights; as many as there are.
inline TriangleMesh MixedSurface(const Bytes& plain, size_t primitive_index, const std::vector<float>& weights) {
  const GltfDocument document = ParseGltf(plain, "").value();
  const Json& json = PrimitiveAt(document, {0, primitive_index});
  TriangleMesh mesh = Surface(ReadPrimitive(document, json, {}).value());
  for (size_t t = 0; t < weights.size(); ++t) {
    if (weights[t] == 0) continue;
    const AccessorData offsets = ReadAccessor(document, json["targets"][t]["POSITION"].get<uint64_t>()).value();
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
      mesh.positions[v] += VectorAt(offsets, v) * weights[t];
    }
  }
  return mesh;
}

// With one of them at weight 1; none: as it is.
inline TriangleMesh MorphedSurface(const Bytes& plain, size_t primitive_index, std::optional<uint64_t> target) {
  std::vector<float> weights;
  if (target.has_value()) {
    weights.resize(*target + 1);
    weights.back() = 1;
  }
  return MixedSurface(plain, primitive_index, weights);
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_GLTF_MORPHED_ASSET_H_
