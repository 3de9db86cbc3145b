#include "pack/morphs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "gltf/halved_stream.h"
#include "gltf/morphed_asset.h"
#include "lacerta/file_io.h"
#include "lacerta/gltf.h"
#include "lacerta/surface_distance.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using testing::BallWithHills;
using testing::MorphedSurface;

constexpr int kTargets = 4;

// surface: of an asset with one target at weight 1.
template <typename Surface>
double WorstError(const Bytes& original, const Bytes& unpacked, uint64_t num_targets, const Surface& surface) {
  double worst = 0.0;
  for (uint64_t t = 0; t < num_targets; ++t) {
    worst = std::max(worst, MeasureSurfaceDistance(surface(original, t), surface(unpacked, t)).value().Rms());
  }
  return worst;
}

TriangleMesh First(const Bytes& plain, uint64_t target) { return MorphedSurface(plain, 0, target); }

TEST(Morphs, AreSimplifiedWithTheirSurfaceWithinTheError) {
  const Bytes asset = BallWithHills();
  PackOptions options;
  options.encode.levels = LevelChoice::kNever;
  const PackResult simplified = PackGltf(asset, options).value();
  options.simplify = false;
  const PackResult all = PackGltf(asset, options).value();
  EXPECT_GT(2 * all.glb.size(), 3 * simplified.glb.size());
  EXPECT_LT(all.glb.size(), 4 * simplified.glb.size());
  const Bytes unpacked = UnpackGltf(simplified.glb, {}).value().glb;
  const double error = WorstError(asset, unpacked, kTargets, First), target = simplified.report.primitives[0].target_error;
  EXPECT_LT(error, 1.02 * target);
  EXPECT_GT(error, 0.3 * target);
  EXPECT_LT(WorstError(asset, UnpackGltf(all.glb, {}).value().glb, kTargets, First), 1.02 * target);
}

// Hills one upon the other, and higher than their targets: what each is off adds up.
TEST(Morphs, MixesThatTheAssetShowsAreHeldToo) {
  const std::vector<float> mix(4, 4.0f);
  PackOptions options;
  options.encode.levels = LevelChoice::kNever;
  const auto error_in_targets = [&](const std::vector<float>& shown) {
    const Bytes asset = testing::BallWithHills({60, 100, 4, false, false, 0, true, shown});
    const PackResult packed = PackGltf(asset, options).value();
    const Bytes unpacked = UnpackGltf(packed.glb, {}).value().glb;
    const auto distance = MeasureSurfaceDistance(testing::MixedSurface(asset, 0, mix), testing::MixedSurface(unpacked, 0, mix)).value();
    return distance.Rms() / packed.report.primitives[0].target_error;
  };
  EXPECT_LT(error_in_targets(mix), 1.02);
  EXPECT_GT(error_in_targets(mix), 0.3);
  EXPECT_GT(error_in_targets({}), 1.1);  // else they need not be looked at
}

TEST(Morphs, OffsetsThatAreMostlyNothingAreSparse) {
  PackOptions options;
  options.simplify = false;
  options.float_targets = true;
  const Bytes asset = BallWithHills();
  const PackResult packed = PackGltf(asset, options).value();
  const GltfDocument document = ParseGltf(packed.glb, "").value();
  for (const Json& target : PrimitiveAt(document, {0, 0})["targets"]) {
    EXPECT_TRUE(document.json["accessors"][target["POSITION"].get<size_t>()].contains("sparse"));
  }
  EXPECT_LT(packed.glb.size() * 4, asset.size());
  EXPECT_GT(packed.glb.size() * 20, asset.size());
}

// Legal, and what moves nothing.
TEST(Morphs, UnpackingLeavesTargetsWithoutDataAlone) {
  PackOptions options;
  options.simplify = false;
  GltfDocument document = ParseGltf(PackGltf(BallWithHills(), options).value().glb, "").value();
  Json& accessor = document.json["accessors"][PrimitiveAt(document, {0, 0})["targets"][0]["POSITION"].get<size_t>()];
  accessor.erase("sparse");
  const auto unpacked = UnpackGltf(FormatGlb(document), {});
  ASSERT_TRUE(unpacked.ok()) << unpacked.status().message();
  const GltfDocument after = ParseGltf(unpacked.value().glb, "").value();
  const Json& primitive = PrimitiveAt(after, {0, 0});
  EXPECT_EQ(FindExtension(primitive, "KHR_draco_mesh_compression"), nullptr);
  EXPECT_FALSE(after.json["accessors"][primitive["targets"][0]["POSITION"].get<size_t>()].contains("bufferView"));
}

TEST(Morphs, OffsetsAreIntegersForReadersThatKnowThem) {
  const Bytes asset = testing::BallWithHills({60, 100, 4, true});
  PackOptions options;
  options.encode.levels = LevelChoice::kNever;
  const auto pack = [&](bool simplify, bool float_targets) {
    options.simplify = simplify;
    options.float_targets = float_targets;
    return PackGltf(asset, options).value();
  };
  const auto type_of = [](const Bytes& glb, const char* name) {
    const GltfDocument document = ParseGltf(glb, "").value();
    EXPECT_EQ(UsesExtension(document.json, "KHR_mesh_quantization"), RequiresExtension(document.json, "KHR_mesh_quantization"));
    const Json& target = PrimitiveAt(document, {0, 0})["targets"][0];
    const AccessorData data = ReadAccessor(document, target[name].get<uint64_t>()).value();
    EXPECT_EQ(data.type != ComponentType::kFloat, UsesExtension(document.json, "KHR_mesh_quantization"));
    return data.type;
  };
  for (const bool simplify : {false, true}) {
    const PackResult integers = pack(simplify, false), floats = pack(simplify, true);
    const Bytes unpacked = UnpackGltf(integers.glb, {}).value().glb;
    EXPECT_EQ(type_of(integers.glb, "POSITION"), ComponentType::kInt16);
    EXPECT_EQ(type_of(integers.glb, "NORMAL"), ComponentType::kInt8);
    for (const Bytes& of_floats : {floats.glb, unpacked}) {
      EXPECT_EQ(type_of(of_floats, "POSITION"), ComponentType::kFloat);
      EXPECT_EQ(type_of(of_floats, "NORMAL"), ComponentType::kFloat);
    }
    EXPECT_LT(10 * integers.glb.size(), 8 * floats.glb.size());
    EXPECT_GT(5 * integers.glb.size(), floats.glb.size());
    const double target = integers.report.primitives[0].target_error;
    EXPECT_LT(WorstError(asset, unpacked, kTargets, First), 1.02 * target);
  }
}

// A ball that bursts: each triangle has vertices of its own, which its target alone tells from those of the others.
TEST(Morphs, ThatTellVerticesApartAreNamedAsTheReason) {
  const TriangleMesh ball = testing::WavySphere(10, 14);
  TriangleMesh pieces;
  std::vector<Vec3f> offsets;
  for (const Triangle& t : ball.triangles) {
    const auto first = static_cast<uint32_t>(pieces.positions.size());
    Vec3f middle{};
    for (const uint32_t v : t) pieces.positions.push_back(ball.positions[v]), middle += ball.positions[v];
    pieces.triangles.push_back({first, first + 1, first + 2});
    offsets.insert(offsets.end(), 3, middle * 0.5f);
  }
  testing::AssetBuilder builder;
  Json primitive = builder.Primitive(pieces);
  primitive["targets"] = Json::array({{{"POSITION", builder.AddFloats(offsets, true)}}});
  builder.AddMesh("ball", Json::array({primitive}));
  PackOptions options;
  options.simplify = false;
  const auto packed = PackGltf(builder.Glb(), options);
  ASSERT_TRUE(packed.ok()) << packed.status().message();
  const PrimitiveReport& report = packed.value().report.primitives[0];
  EXPECT_EQ(report.storage, PrimitiveStorage::kUntouched);
  EXPECT_NE(report.reason.find("has morph targets that tell apart what its other attributes do not"), std::string::npos) << report.reason;
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

// Every target is looked at, and every mix of them, whether few samples tell or many have to.
TEST(Morphs, AreWithinAnErrorWhereAllTheyShowIs) {
  const TriangleMesh ball = shapes::Icosphere(4);
  const Primitive primitive{ball.positions.size(), ball.triangles, {{"POSITION", MakeFloatAccessor(ball.positions)}}};
  const auto grown = [&](float first, float second) {
    std::vector<MorphTarget> targets;
    for (const float by : {first, second}) {
      std::vector<Vec3f> offsets = ball.positions;
      for (Vec3f& offset : offsets) offset = offset * by;
      targets.push_back({{"POSITION", MakeFloatAccessor(offsets)}});
    }
    return targets;
  };
  const std::vector<MorphTarget> original = grown(0.1f, 0.2f);
  const auto are_within = [&](double error, const std::vector<MorphTarget>& stored, const std::vector<TargetMix>& mixes = {}) {
    return MorphMeter::Create({{&primitive, &original}}, mixes).value().AreWithin(error, {{&primitive, &stored}}).value();
  };
  EXPECT_TRUE(are_within(1e-6, original));
  for (const auto& stored : {grown(0.13f, 0.2f), grown(0.1f, 0.17f), grown(0.13f, 0.19f)}) {
    EXPECT_TRUE(are_within(0.3, stored));
    EXPECT_TRUE(are_within(0.0305, stored));
    EXPECT_FALSE(are_within(0.0295, stored));
    EXPECT_FALSE(are_within(0.003, stored));
  }
  EXPECT_TRUE(are_within(0.0305, grown(0.12f, 0.22f)));
  EXPECT_FALSE(are_within(0.0305, grown(0.12f, 0.22f), {{1.0f, 1.0f}}));
  EXPECT_TRUE(are_within(0.0405, grown(0.12f, 0.22f), {{1.0f, 1.0f}}));
}

TEST(Morphs, MorphStressTestHoldsItsError) {
  const std::string path = std::string(LACERTA_TEST_DATA_DIR) + "/MorphStressTest.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const Bytes asset = ReadFile(path).value();
  const PackResult packed = PackGltf(asset, {}).value();
  EXPECT_LT(packed.glb.size(), 300'000u);
  EXPECT_GT(packed.glb.size(), 150'000u);
  // Of the mesh, which is its cube and the plate below it: the target is one of both together.
  const Bytes unpacked = UnpackGltf(packed.glb, {}).value().glb;
  const auto both = [](const Bytes& plain, uint64_t t) { return testing::Both(MorphedSurface(plain, 0, t), MorphedSurface(plain, 1, t)); };
  const double error = WorstError(asset, unpacked, 8, both), target = packed.report.primitives[1].target_error;
  EXPECT_LT(error, 1.02 * target);
  EXPECT_GT(error, 0.3 * target);
}

// Normals of the simplified surface leave rounding no room at 60 dB until that is kept closer than at first.
TEST(Morphs, MorphStressTestTakesFewerBytesForLess) {
  const std::string path = std::string(LACERTA_TEST_DATA_DIR) + "/MorphStressTest.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const Bytes asset = ReadFile(path).value();
  PackOptions options;
  options.encode.target.value = 60.0;
  const size_t bytes = PackGltf(asset, options).value().glb.size();
  const size_t bytes_at_70 = PackGltf(asset, {}).value().glb.size();
  EXPECT_LT(bytes, bytes_at_70);
  EXPECT_GT(2 * bytes, bytes_at_70);
}

}  // namespace
}  // namespace lacerta
