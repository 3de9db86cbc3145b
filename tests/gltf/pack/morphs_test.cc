#include "pack/morphs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "document/place.h"
#include "gltf/test_assets.h"
#include "lacerta/file_io.h"
#include "lacerta/gltf.h"
#include "lacerta/surface_distance.h"

namespace lacerta {
namespace {

constexpr int kTargets = 4;

// A ball with targets that raise a round hill each; nothing moves elsewhere.
Bytes BallWithHills() {
  const TriangleMesh ball = testing::WavySphere(60, 100);
  testing::AssetBuilder builder;
  Json primitive = builder.Primitive(ball), targets = Json::array();
  for (int t = 0; t < kTargets; ++t) {
    const Vec3f top{std::cos(1.6f * static_cast<float>(t)), std::sin(1.6f * static_cast<float>(t)), 0};
    std::vector<Vec3f> offsets;
    for (const Vec3f& p : ball.positions) {
      const float w = std::max(0.0f, 1 - SquaredNorm(p - top) / 0.36f);
      offsets.push_back(Normalized(p) * (0.3f * w * w));
    }
    targets.push_back({{"POSITION", builder.AddFloats(offsets, true)}});
  }
  primitive["targets"] = std::move(targets);
  builder.document().json["materials"] =
      Json::array({{{"name", "red"}}});  // without numbers that might be an accessor's
  builder.AddMesh("ball", Json::array({std::move(primitive)}));
  return builder.Glb();
}

// The last mesh's last primitive with one of its targets at weight 1.
TriangleMesh MorphedSurface(const Bytes& plain, size_t primitive_index, uint64_t target) {
  const GltfDocument document = ParseGltf(plain, "").value();
  const Json& json = PrimitiveAt(document, {0, primitive_index});
  const Primitive primitive = ReadPrimitive(document, json, {}).value();
  TriangleMesh mesh = Surface(primitive);
  const AccessorData offsets = ReadAccessor(document, json["targets"][target]["POSITION"].get<uint64_t>()).value();
  for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
    mesh.positions[v] += {offsets.Float(v, 0), offsets.Float(v, 1), offsets.Float(v, 2)};
  }
  return mesh;
}

double WorstError(const Bytes& original, const Bytes& unpacked, size_t primitive, uint64_t num_targets) {
  double worst = 0.0;
  for (uint64_t t = 0; t < num_targets; ++t) {
    const auto distance =
        MeasureSurfaceDistance(MorphedSurface(original, primitive, t), MorphedSurface(unpacked, primitive, t));
    worst = std::max(worst, distance.value().Rms());
  }
  return worst;
}

TEST(Morphs, AreSimplifiedWithTheirSurfaceWithinTheError) {
  const Bytes asset = BallWithHills();
  PackOptions options;
  const PackResult simplified = PackGltf(asset, options).value();
  options.simplify = false;
  const PackResult all = PackGltf(asset, options).value();
  EXPECT_GT(2 * all.glb.size(), 3 * simplified.glb.size());
  EXPECT_LT(all.glb.size(), 4 * simplified.glb.size());
  const Bytes unpacked = UnpackGltf(simplified.glb, {}).value().glb;
  const double error = WorstError(asset, unpacked, 0, kTargets), target = simplified.report.primitives[0].target_error;
  EXPECT_LT(error, 1.02 * target);
  EXPECT_GT(error, 0.3 * target);
  EXPECT_LT(WorstError(asset, UnpackGltf(all.glb, {}).value().glb, 0, kTargets), 1.02 * target);
}

TEST(Morphs, OffsetsThatAreMostlyNothingAreSparse) {
  PackOptions options;
  options.simplify = false;
  const Bytes asset = BallWithHills();
  const PackResult packed = PackGltf(asset, options).value();
  const GltfDocument document = ParseGltf(packed.glb, "").value();
  for (const Json& target : PrimitiveAt(document, {0, 0})["targets"]) {
    EXPECT_TRUE(document.json["accessors"][target["POSITION"].get<size_t>()].contains("sparse"));
  }
  EXPECT_LT(packed.glb.size() * 4, asset.size());
  EXPECT_GT(packed.glb.size() * 20, asset.size());
}

TEST(Morphs, GoIntoAPrimitiveAndOutAgain) {
  Primitive primitive{3, {{0, 1, 2}}, {{"POSITION", MakeFloatAccessor(std::vector<float>(9, 0.0f), 3)}}};
  const AccessorData offsets = MakeFloatAccessor({0, 0, 0, 1, 0, 0, 0, 0.001f, 0}, 3);
  const std::vector<MorphTarget> targets = {{{"NORMAL", offsets}, {"POSITION", offsets}}, {{"POSITION", offsets}}};
  Primitive with = WithTargets(primitive, targets).value();
  EXPECT_EQ(with.attributes.size(), 4u);
  EXPECT_TRUE(IsTargetPosition("TARGET_1/POSITION"));
  EXPECT_FALSE(IsTargetPosition("TARGET_0/NORMAL"));
  const std::vector<MorphTarget> back = TakeTargets(targets, 0.01, &with);
  EXPECT_EQ(with.attributes.size(), 1u);
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[0][0].data.bytes, offsets.bytes);
  EXPECT_EQ(back[1][0].data.Float(2, 1), 0.0f);
  EXPECT_EQ(back[1][0].data.Float(1, 0), 1.0f);
  EXPECT_EQ(WithTargets(primitive, {{{"COLOR_0", offsets}}}).status().code(), StatusCode::kUnsupported);
}

TEST(Morphs, MorphStressTestHoldsItsError) {
  const std::string path = std::string(LACERTA_TEST_DATA_DIR) + "/MorphStressTest.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const Bytes asset = ReadFile(path).value();
  const PackResult packed = PackGltf(asset, {}).value();
  EXPECT_LT(packed.glb.size(), 300'000u);
  EXPECT_GT(packed.glb.size(), 150'000u);
  const double error = WorstError(asset, UnpackGltf(packed.glb, {}).value().glb, 1, 8),
               target = packed.report.primitives[1].target_error;
  EXPECT_LT(error, 1.02 * target);
  EXPECT_GT(error, 0.3 * target);
}

}  // namespace
}  // namespace lacerta
