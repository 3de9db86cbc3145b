// Every GLB of the data set, packed and unpacked: nothing is lost that is not geometry, and no crack opens.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <utility>

#include "document/accessor.h"
#include "document/gltf_document.h"
#include "gltf/borders.h"
#include "lacerta/file_io.h"
#include "lacerta/gltf.h"
#include "lacerta/surface_distance.h"

namespace lacerta {
namespace {

using testing::BorderEdges;
using testing::LengthFarFrom;
using testing::LengthOf;
using testing::Segment;

constexpr const char* kAssets[] = {
    "2CylinderEngine", "BoomBox",      "CesiumMan",   "CesiumMilkTruck",       "Corset",          "DamagedHelmet", "FlightHelmet",
    "Fox",             "GlamVelvetSofa", "GlassVaseFlowers", "MaterialsVariantsShoe", "MorphStressTest", "MosquitoInAmber",
    "SheenChair",      "SheenCloth",   "ToyCar",      "WaterBottle",           "pizza_uv",        "spot_textured"};

// Those run where asked for, so that the suite stays quick.
bool IsLarge(const std::string& asset) {
  constexpr const char* kLarge[] = {"2CylinderEngine", "FlightHelmet", "SheenCloth", "ToyCar"};
  return std::find(std::begin(kLarge), std::end(kLarge), asset) != std::end(kLarge);
}

// The JSON without what says where vertices, indices and bytes are.
Json Kept(Json json) {
  for (const char* key : {"accessors", "buffers", "bufferViews"}) json.erase(key);
  for (Json& image : json.contains("images") ? json["images"] : json["none"]) image.erase("bufferView");
  json.erase("none");
  if (json.contains("skins")) {
    for (Json& skin : json["skins"]) skin.erase("inverseBindMatrices");
  }
  for (Json& mesh : json["meshes"]) {
    for (Json& primitive : mesh["primitives"]) {
      for (const char* key : {"attributes", "indices", "targets"}) primitive.erase(key);
      if (primitive.contains("mode") && primitive["mode"] == 4) primitive.erase("mode");  // what its absence says
    }
  }
  if (json.contains("animations")) {
    for (Json& animation : json["animations"]) {
      for (Json& sampler : animation["samplers"]) sampler.erase("input"), sampler.erase("output");
    }
  }
  return json;
}

// The bytes behind what is referred to by index.
std::vector<Bytes> KeptBytes(const GltfDocument& document) {
  std::vector<Bytes> all;
  const auto add_accessor = [&](const Json* index) {
    if (index == nullptr) return;
    const StatusOr<AccessorData> data = ReadAccessor(document, index->get<uint64_t>());
    if (data.ok()) all.push_back(data.value().bytes);
  };
  for (uint64_t i = 0; i < ArraySize(document.json, "images"); ++i) {
    const Json* view = Find(*FindElement(document.json, "images", i), "bufferView");
    if (view == nullptr) continue;
    const Span<const uint8_t> bytes = BufferViewBytes(document, view->get<uint64_t>()).value();
    all.emplace_back(bytes.begin(), bytes.end());
  }
  for (uint64_t i = 0; i < ArraySize(document.json, "animations"); ++i) {
    const Json& animation = *FindElement(document.json, "animations", i);
    for (uint64_t s = 0; s < ArraySize(animation, "samplers"); ++s) {
      add_accessor(Find(*FindElement(animation, "samplers", s), "input"));
      add_accessor(Find(*FindElement(animation, "samplers", s), "output"));
    }
  }
  return all;
}

class AssetTest : public ::testing::TestWithParam<const char*> {};

TEST_P(AssetTest, KeepsEverythingElseAndOpensNoCrack) {
  const std::string path = std::string(LACERTA_TEST_DATA_DIR) + "/" + GetParam() + ".glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  if (IsLarge(GetParam()) && std::getenv("LACERTA_LARGE_ASSETS") == nullptr) {
    GTEST_SKIP() << "takes half a minute or more: set LACERTA_LARGE_ASSETS=1";
  }
  const Bytes asset = ReadFile(path).value();
  const auto packed = PackGltf(asset, {});
  ASSERT_TRUE(packed.ok()) << packed.status().message();
  const auto unpacked = UnpackGltf(packed.value().glb, {});
  ASSERT_TRUE(unpacked.ok()) << unpacked.status().message();
  EXPECT_TRUE(unpacked.value().notes.empty());

  const GltfDocument before = ParseGltf(asset, "").value();
  const GltfDocument after = ParseGltf(unpacked.value().glb, "").value();
  EXPECT_EQ(Kept(after.json), Kept(before.json));
  EXPECT_EQ(KeptBytes(after), KeptBytes(before));

  const TriangleMesh original = FlattenGltf(asset, {}).value().mesh;
  const TriangleMesh decoded = FlattenGltf(unpacked.value().glb, {}).value().mesh;
  const std::vector<Segment> border = BorderEdges(decoded), old_border = BorderEdges(original);
  EXPECT_LE(border.size(), old_border.size());
  // Nor does any lie where the original had none: a crack inside of the surface, closed elsewhere.
  constexpr double kNear = 0.02;  // of the diagonal
  const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(original).value();
  const double diagonal = meter.diagonal();
  // Measured anew, of all that the scene shows; tests/bench/asset_report looks at each mesh and what lies on it.
  EXPECT_GT(Psnr(meter.Measure(decoded, SurfaceDistanceOptions::RmsOnly()).value().Rms(), diagonal), 69.9);
  EXPECT_LE(LengthFarFrom(border, old_border, kNear * diagonal), 1e-3 * LengthOf(old_border));
  uint64_t bytes_before = 0;
  uint64_t bytes_after = 0;
  for (const PrimitiveReport& primitive : packed.value().report.primitives) {
    bytes_before += primitive.bytes_before;
    bytes_after += primitive.bytes_after;
    if (primitive.storage == PrimitiveStorage::kDraco) {
      EXPECT_LE(primitive.error, primitive.target_error);
    }
    for (const AttributeReport& attribute : primitive.attributes) {
      if (attribute.unit.empty()) continue;
      const double target =
          attribute.unit == "texels" ? AttributeTargets().uv_texels : AttributeTargets().normal_degrees;
      EXPECT_LE(attribute.error, target) << attribute.name;
    }
  }
  EXPECT_LT(bytes_after * 4, bytes_before);
  EXPECT_LT(packed.value().glb.size(), asset.size());
}

INSTANTIATE_TEST_SUITE_P(DataSet, AssetTest, ::testing::ValuesIn(kAssets), [](const auto& asset) {
  std::string name = asset.param;
  name.erase(std::remove_if(name.begin(), name.end(), [](char c) { return c == '_'; }), name.end());
  return name;
});

}  // namespace
}  // namespace lacerta
