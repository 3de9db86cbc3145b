// Writes those seeds that no golden stream is: fuzz_seeds FOLDER, where FOLDER is tests/fuzz/seeds. To be run anew after a change of the stream.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "gltf/skinned_asset.h"  // first: its enumerators have names that those below have globally
#include "draco/attributed_stream.h"
#include "gltf/torus_asset.h"
#include "lacerta/attributed_base.h"
#include "shapes/attributed_levels.h"
#include "shapes/attributed_shapes.h"
#include "shapes/shapes.h"

namespace {

using namespace lacerta;  // NOLINT: a program of its own

bool Write(const std::filesystem::path& path, const Bytes& bytes) {
  constexpr size_t kMost = 4096;  // what tests/fuzz/run lets fuzzers read
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  std::printf("%s: %zu bytes\n", path.c_str(), bytes.size());
  return std::filesystem::exists(path) && bytes.size() <= kMost;
}

// Without what the tests' assets have to pass through, and with steps and splines among the animations, and a morph target.
Bytes Animated(const Bytes& skinned) {
  testing::AssetBuilder builder;
  GltfDocument& document = builder.document();
  document = ParseGltf(skinned, "").value();
  Json& json = document.json;
  for (const char* name : {"materials", "unknownToEveryone"}) json.erase(name);
  json["asset"].erase("extras");
  json["nodes"][0].erase("extras");
  Json& primitive = json["meshes"][0]["primitives"][0];
  primitive.erase("material");
  primitive["targets"] = Json::array({{{"POSITION", primitive["attributes"]["POSITION"]}}});
  json["meshes"][0]["weights"] = {0.5};
  const uint64_t times = testing::AddData(MakeFloatAccessor(std::vector<float>{0, 1}, 1), &builder);
  const uint64_t scales = testing::AddData(MakeFloatAccessor(std::vector<float>{1, 1, 1, 2, 1, 1}, 3), &builder);
  const uint64_t spline = testing::AddData(MakeFloatAccessor(std::vector<float>(18, 0.5f), 3), &builder);
  Json animation = {{"samplers", {{{"input", times}, {"output", scales}, {"interpolation", "STEP"}},
                                  {{"input", times}, {"output", spline}, {"interpolation", "CUBICSPLINE"}}}},
                    {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "scale"}}}},
                                  {{"sampler", 1}, {"target", {{"node", 3}, {"path", "translation"}}}}}}};
  json["animations"].push_back(std::move(animation));
  return builder.Glb();
}

// An asset of these primitives as a stream of few levels.
Bytes Progressive(const std::vector<VertexSoup>& primitives, int quality_layers, Fallback fallback) {
  testing::AssetBuilder builder;
  Json& json = builder.document().json;
  json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", Json::array()}}}}, {"nodes", Json::array()}, {"meshes", Json::array()}};
  Json drawn = Json::array();
  for (const VertexSoup& soup : primitives) {
    drawn.push_back(testing::AddSoup(soup, &builder));
    drawn.back().erase("material");
  }
  builder.AddMesh("m", std::move(drawn));
  PackOptions options;
  options.encode.target.value = 45;
  options.encode.levels = LevelChoice::kAlways;
  options.encode.quality_layers = quality_layers;
  options.fallback = fallback;
  return PackGltf(builder.Glb(), options).value().glb;
}

VertexSoup BumpyTorus() {
  const TriangleMesh torus = shapes::Torus(31, 21);  // odd, so that it is not taken for a subdivided one
  VertexSoup soup{torus.positions, torus.triangles, {}};
  for (Vec3f& p : soup.positions) p *= 1 + 0.05f * std::sin(9 * p.x) * std::cos(7 * p.y);
  return soup;
}

// As c_abi_fuzzer reads it: choice, length of a piece, counts of groups and attributes, lengths of the bases, the stream.
Bytes GroupsForC() {
  AttributedSemiRegularMesh mesh = shapes::SubdividedSoups(
      shapes::BoxOfTwoGroups(1), 2, [](Vec3f p) { return p * (1 + 0.1f * p.x * p.y); }, [](const LevelAttribute&, float*) {});
  AttributedStreamOptions options;
  options.lambda = 1e-9;
  options.errors = {1e-2, 1.0, 1e-2};
  const AttributedStream stream =
      EncodeAttributedStream({AsNormalMesh(std::move(mesh.surface)).value(), std::move(mesh.base_groups), std::move(mesh.attributes)}, options).value();
  const auto num_groups = static_cast<uint32_t>(stream.bases.size());
  Bytes bytes = {8, 100, static_cast<uint8_t>(num_groups - 1 + 3 * stream.decoded.attributes.size())};
  for (const Bytes& base : stream.bases) bytes.insert(bytes.end(), {static_cast<uint8_t>(base.size()), static_cast<uint8_t>(base.size() >> 8)});
  for (const Bytes& base : stream.bases) bytes.insert(bytes.end(), base.begin(), base.end());
  bytes.insert(bytes.end(), stream.refinement.begin(), stream.refinement.end());
  for (const LevelAttribute& a : stream.decoded.attributes) std::printf("attribute %s\n", a.name.c_str());
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: fuzz_seeds FOLDER\n"), 2;
  const std::filesystem::path folder = argv[1];
  const Bytes plain = testing::SkinnedCylinderAsset(shapes::SkinnedCylinder(4, 2), 60.0);
  const Bytes few = testing::SkinnedCylinderAsset(shapes::SkinnedCylinder(2, 2), 60.0);
  bool written = Write(folder / "gltf_skin_fuzzer" / "skin.glb", Animated(plain));
  written = Write(folder / "gltf_skin_fuzzer" / "skin_of_few_triangles.glb", Animated(few)) && written;
  written = Write(folder / "c_abi_fuzzer" / "groups", GroupsForC()) && written;
  const std::filesystem::path assets = folder / "glb_extension_fuzzer";
  written = Write(assets / "levels.glb", Progressive({BumpyTorus()}, 1, Fallback::kDraco)) && written;
  written = Write(assets / "levels_and_layers.glb", Progressive({BumpyTorus()}, 3, Fallback::kPlain)) && written;
  written = Write(assets / "levels_of_groups.glb", Progressive(shapes::HalvedTorus(24, 12), 1, Fallback::kDraco)) && written;
  return written ? 0 : 1;
}
