#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <ostream>
#include <set>
#include <utility>

#include "decoder/smooth_normals.h"
#include "document/gltf_document.h"
#include "extension/progressive.h"
#include "gltf/test_assets.h"
#include "lacerta/file_io.h"
#include "lacerta/gltf.h"
#include "lacerta/surface_distance.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using ::testing::AllOf;
using testing::AssetBuilder;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::JsonOf;
using ::testing::Not;
using testing::WavySphere;

PackOptions Options(Fallback fallback) {
  PackOptions options;
  options.encode.target = {EncodeTarget::Kind::kPsnr, 45.0};
  options.encode.levels = LevelChoice::kAlways;  // small meshes as here are smaller without
  options.attributes.normal_degrees = 30.0;      // which those that readers derive meet, as little as is left of the balls
  options.attributes.turned = 0.1;
  options.fallback = fallback;
  return options;
}

std::vector<std::string> Strings(const Json& json, const char* key) {
  return json.contains(key) ? json[key].get<std::vector<std::string>>() : std::vector<std::string>();
}

// Two smooth balls, one of them with normals, and a pair of primitives.
Bytes MixedAsset() {
  AssetBuilder builder;
  builder.AddMesh("ball", Json::array({builder.Primitive(WavySphere(13, 22))}));
  const TriangleMesh other = WavySphere(13, 22, {3, 0, 0});
  Json with_normals = builder.Primitive(other);
  with_normals["attributes"]["NORMAL"] = builder.AddFloats(SmoothNormals(other.positions, other.triangles), false);
  builder.AddMesh("smooth", Json::array({with_normals}));
  builder.AddMesh("pair", Json::array({builder.Primitive(WavySphere(13, 22, {0, -3, 0})), builder.Primitive(WavySphere(13, 22, {0, 3, 0}))}));
  return builder.Glb();
}

TEST(Pack, LevelsThatAreAlwaysWantedAndMissingAreTold) {
  const PackOptions always = Options(Fallback::kDraco);
  EXPECT_THAT(PackGltf(MixedAsset(), always).value().report.notes, IsEmpty());
  AssetBuilder builder;
  builder.AddMesh("ball", Json::array({builder.Primitive(WavySphere(13, 22))}));
  Json lines = builder.Primitive(WavySphere(13, 22, {3, 0, 0}));
  lines["mode"] = 1;
  builder.AddMesh("lines", Json::array({lines}));
  const Bytes asset = builder.Glb();
  const PackResult packed = PackGltf(asset, always).value();
  ASSERT_EQ(packed.report.primitives.size(), 2u);
  ASSERT_EQ(packed.report.notes.size(), 1u);
  EXPECT_FALSE(packed.report.primitives[1].reason.empty());
  EXPECT_THAT(packed.report.notes[0], AllOf(HasSubstr("1 of 2 primitives"), HasSubstr("mesh 1, primitive 0: " + packed.report.primitives[1].reason)));
  PackOptions where_they_pay = always;
  where_they_pay.encode.levels = LevelChoice::kWhereTheyPay;
  EXPECT_THAT(PackGltf(asset, where_they_pay).value().report.notes, IsEmpty());
}

TEST(Pack, DracoFallbackSharesTheBytesOfTheBase) {
  const auto packed = PackGltf(MixedAsset(), Options(Fallback::kDraco));
  ASSERT_TRUE(packed.ok()) << packed.status().message();
  const GltfDocument document = ParseGltf(packed.value().glb, "").value();
  const Json& json = document.json;
  EXPECT_THAT(Strings(json, "extensionsUsed"), AllOf(Contains(kDracoName), Contains(kProgressiveName)));
  EXPECT_THAT(Strings(json, "extensionsRequired"), AllOf(Contains(kDracoName), Not(Contains(kProgressiveName))));
  const Progressive progressive = ParseProgressive(document).value();
  ASSERT_EQ(progressive.streams.size(), 3u);  // the last one of two primitives
  EXPECT_FALSE(progressive.streams[0].smooth_normals);
  EXPECT_TRUE(progressive.streams[1].smooth_normals);
  const Span<const uint8_t> data = BufferViewBytes(document, progressive.data).value();
  for (uint64_t m = 0; m < 2; ++m) {
    const Json& primitive = json["meshes"][m]["primitives"][0];
    EXPECT_EQ(primitive["attributes"].size(), 1u);
    const Json& extensions = primitive["extensions"];
    EXPECT_EQ(extensions[kProgressiveName], (Json{{"stream", m}, {"group", 0}}));
    const Span<const uint8_t> base = BufferViewBytes(document, extensions[kDracoName]["bufferView"]).value();
    const GatheredStream stream = GatherStream(document, progressive, m).value();
    EXPECT_EQ(base.data(), data.data() + stream.base_offset);  // the very bytes, not a copy
    EXPECT_EQ(base.size(), stream.base_length);
    const Json& position = json["accessors"][primitive["attributes"]["POSITION"].get<size_t>()];
    EXPECT_EQ(position["count"], progressive.streams[m].vertex_counts[0]);
    EXPECT_FALSE(position.contains("bufferView"));
    EXPECT_TRUE(position.contains("min"));
  }
  // The refinements end the file.
  EXPECT_EQ(data.data() + data.size(), document.buffers[0].data() + document.buffers[0].size());
  EXPECT_EQ(progressive.segments[0].stream, 0u);
  EXPECT_EQ(progressive.segments[1].stream, 1u);
}

TEST(Pack, TheOtherFallbacks) {
  const Bytes asset = MixedAsset();
  const auto plain = PackGltf(asset, Options(Fallback::kPlain));
  ASSERT_TRUE(plain.ok()) << plain.status().message();
  Json json = JsonOf(plain.value().glb);
  EXPECT_FALSE(json.contains("extensionsRequired"));
  EXPECT_THAT(Strings(json, "extensionsUsed"), ::testing::ElementsAre(kProgressiveName));
  const Json& position = json["accessors"][json["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<size_t>()];
  EXPECT_TRUE(position.contains("bufferView"));
  EXPECT_TRUE(json["meshes"][1]["primitives"][0]["attributes"].contains("NORMAL"));
  EXPECT_EQ(plain.value().report.primitives[2].storage, PrimitiveStorage::kUntouched);

  const auto none = PackGltf(asset, Options(Fallback::kNone));
  ASSERT_TRUE(none.ok()) << none.status().message();
  json = JsonOf(none.value().glb);
  EXPECT_THAT(Strings(json, "extensionsRequired"), Contains(kProgressiveName));
  EXPECT_FALSE(json["meshes"][0]["primitives"][0]["extensions"].contains(kDracoName));
}

TEST(Pack, ReportsEveryPrimitive) {
  const auto packed = PackGltf(MixedAsset(), Options(Fallback::kDraco));
  ASSERT_TRUE(packed.ok()) << packed.status().message();
  const std::vector<PrimitiveReport>& report = packed.value().report.primitives;
  ASSERT_EQ(report.size(), 4u);
  EXPECT_EQ(report[0].storage, PrimitiveStorage::kProgressive);
  EXPECT_EQ(report[1].storage, PrimitiveStorage::kProgressive);
  EXPECT_EQ(report[1].name, "smooth");
  EXPECT_EQ(report[2].storage, PrimitiveStorage::kProgressive);
  EXPECT_THAT(report[2].reason, HasSubstr("with its attributes in 2 levels"));
  EXPECT_EQ(report[3].primitive, 1u);
  for (const PrimitiveReport& primitive : report) EXPECT_LT(primitive.bytes_after, primitive.bytes_before);
}

// A tetrahedron, for which a description would take more than is saved, and a ball, each with three copies of its accessors.
TEST(Pack, BytesOfCopiesCountAsOftenAsTheyAreThere) {
  TriangleMesh small;
  small.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  small.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const TriangleMesh ball = WavySphere(16, 24, {5, 0, 0});
  AssetBuilder builder;
  for (int copy = 0; copy < 3; ++copy) {
    builder.AddMesh("small", Json::array({builder.Primitive(small)}));
    builder.AddMesh("ball", Json::array({builder.Primitive(ball)}));
  }
  const auto packed = PackGltf(builder.Glb(), {});
  ASSERT_TRUE(packed.ok()) << packed.status().message();
  const std::vector<PrimitiveReport>& report = packed.value().report.primitives;
  ASSERT_EQ(report.size(), 2u);
  const auto size = [](const TriangleMesh& mesh, size_t index) { return 12 * mesh.positions.size() + 3 * index * mesh.triangles.size(); };
  EXPECT_EQ(report[0].storage, PrimitiveStorage::kUntouched) << report[0].reason;
  EXPECT_THAT(report[0].bytes_before, ::testing::AnyOf(3 * size(small, 1), 3 * size(small, 2), 3 * size(small, 4)));
  EXPECT_EQ(report[0].bytes_after, report[0].bytes_before);
  EXPECT_NE(report[1].storage, PrimitiveStorage::kUntouched) << report[1].reason;
  EXPECT_THAT(report[1].bytes_before, ::testing::AnyOf(3 * size(ball, 2), 3 * size(ball, 4)));
  EXPECT_LT(report[1].bytes_after, report[1].bytes_before / 3);
}

Bytes TwoColoredBalls(uint32_t larger, uint32_t smaller) {
  AssetBuilder builder;
  for (const uint32_t size : {larger, smaller}) {
    const TriangleMesh ball = WavySphere(size, 2 * size, {3.0f * static_cast<float>(size), 0, 0});
    Json primitive = builder.Primitive(ball);
    primitive["attributes"]["COLOR_0"] = builder.AddFloats(std::vector<Vec3f>(ball.positions.size(), {0.5f, 0.25f, 1.0f}), false);
    builder.AddMesh("ball", Json::array({primitive}));
  }
  return builder.Glb();
}

TEST(Pack, ABudgetIsTheWholeFilesAndTheLargerMeshGetsMore) {
  const Bytes asset = TwoColoredBalls(60, 20);
  uint64_t larger_before = 0;
  // All of one kind: as a stream the larger one may take fewer bytes.
  for (const double budget : {4000.0, 9000.0}) {
    PackOptions options;
    options.encode.target = {EncodeTarget::Kind::kBytes, budget};
    options.encode.levels = LevelChoice::kNever;
    const auto packed = PackGltf(asset, options);
    ASSERT_TRUE(packed.ok()) << packed.status().message();
    const std::vector<PrimitiveReport>& primitives = packed.value().report.primitives;
    ASSERT_EQ(primitives.size(), 2u);
    const uint64_t bytes = primitives[0].bytes_after + primitives[1].bytes_after;
    EXPECT_LE(static_cast<double>(bytes), budget);
    EXPECT_GE(static_cast<double>(bytes), 0.9 * budget) << "precision comes in whole bits";
    EXPECT_GT(primitives[0].bytes_after, primitives[1].bytes_after);
    EXPECT_GT(primitives[0].bytes_after, larger_before);
    larger_before = primitives[0].bytes_after;
  }
  PackOptions any;
  any.encode.target = {EncodeTarget::Kind::kBytes, 2500};
  const auto packed = PackGltf(TwoColoredBalls(24, 10), any);
  ASSERT_TRUE(packed.ok()) << packed.status().message();
  const std::vector<PrimitiveReport>& primitives = packed.value().report.primitives;
  const uint64_t bytes = primitives[0].bytes_after + primitives[1].bytes_after;
  EXPECT_LE(bytes, 2500u);
  EXPECT_GE(bytes, 1600u) << "bytes jump where a mesh becomes a stream";
}

double ScenePsnr(const Bytes& asset, const Bytes& packed) {
  const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(FlattenGltf(asset, {}).value().mesh).value();
  return Psnr(meter.Measure(FlattenGltf(packed, {}).value().mesh).value().Rms(), meter.diagonal());
}

// Whoever follows the progress gets one family at a time, and the bytes that several at a time give.
TEST(Pack, FamiliesInTurnAndTogetherAreTheSame) {
  const Bytes asset = TwoColoredBalls(24, 10);
  for (const EncodeTarget& target : {EncodeTarget{EncodeTarget::Kind::kPsnr, 60}, EncodeTarget{EncodeTarget::Kind::kBytes, 2500}}) {
    PackOptions options;
    options.encode.target = target;
    const auto together = PackGltf(asset, options);
    options.encode.progress = [](double, const char*) {};
    const auto in_turn = PackGltf(asset, options);
    ASSERT_TRUE(together.ok() && in_turn.ok());
    EXPECT_EQ(together.value().report.primitives.size(), 2u);
    EXPECT_TRUE(together.value().glb == in_turn.value().glb);
  }
}

TEST(Pack, ABudgetGoesWhereItLowersTheErrorOfTheSceneMost) {
  // One surface is smooth, the other rough all over: a byte does more for the first.
  AssetBuilder builder;
  const TriangleMesh smooth = WavySphere(32, 64);
  TriangleMesh rough = shapes::Icosphere(5);
  uint32_t state = 1;
  for (Vec3f& position : rough.positions) {
    state = state * 1664525 + 1013904223;
    position = position * (1.0f + 0.02f * static_cast<float>(state >> 8) / 16777216.0f) + Vec3f{3, 0, 0};
  }
  for (const TriangleMesh& mesh : {smooth, rough}) {
    Json primitive = builder.Primitive(mesh);
    primitive["attributes"]["COLOR_0"] = builder.AddFloats(std::vector<Vec3f>(mesh.positions.size(), {0.5f, 0.25f, 1.0f}), false);
    builder.AddMesh("ball", Json::array({primitive}));
  }
  const Bytes asset = builder.Glb();
  PackOptions even, budget;
  even.encode.target = {EncodeTarget::Kind::kPsnr, 72.0};
  even.encode.levels = budget.encode.levels = LevelChoice::kNever;
  const auto of_one_error = PackGltf(asset, even).value();
  uint64_t bytes = 0, used = 0;
  for (const PrimitiveReport& primitive : of_one_error.report.primitives) bytes += primitive.bytes_after;
  budget.encode.target = {EncodeTarget::Kind::kBytes, static_cast<double>(bytes)};
  const auto shared = PackGltf(asset, budget).value();
  for (const PrimitiveReport& primitive : shared.report.primitives) used += primitive.bytes_after;
  EXPECT_LE(used, bytes);
  EXPECT_GT(static_cast<double>(used), 0.93 * static_cast<double>(bytes));
  const double before = ScenePsnr(asset, of_one_error.glb), after = ScenePsnr(asset, shared.glb);
  EXPECT_GT(after, before + 0.2) << before;
  EXPECT_LT(after, before + 3.0) << before;
}

// Where colors take most of the bytes a finer surface takes few more, which no budget learns from a single trial.
TEST(Pack, ABudgetThatTheFirstTrialNearlySpendsBuysWhatIsCheap) {
  AssetBuilder builder;
  uint32_t state = 1;
  for (const uint32_t size : {30, 6}) {
    TriangleMesh ball = WavySphere(size, 2 * size);
    for (Vec3f& position : ball.positions) position = position * (static_cast<float>(size) / 30) + Vec3f{static_cast<float>(size), 0, 0};
    std::vector<Vec3f> colors(ball.positions.size());
    for (Vec3f& color : colors) {
      for (int k = 0; k < 3; ++k) {
        state = state * 1664525 + 1013904223;
        color[k] = static_cast<float>(state >> 8) / 16777216.0f;
      }
    }
    Json primitive = builder.Primitive(ball);
    primitive["attributes"]["COLOR_0"] = builder.AddFloats(colors, false);
    builder.AddMesh("ball", Json::array({primitive}));
  }
  const Bytes asset = builder.Glb();
  PackOptions options;
  options.encode.levels = LevelChoice::kNever;
  options.attributes.color = 0.0005;
  const auto pack = [&](EncodeTarget target) {
    options.encode.target = target;
    return PackGltf(asset, options).value();
  };
  const auto bytes_of = [](const auto& packed) {
    uint64_t bytes = 0;
    for (const PrimitiveReport& primitive : packed.report.primitives) bytes += primitive.bytes_after;
    return static_cast<double>(bytes);
  };
  const auto first_trial = pack({EncodeTarget::Kind::kPsnr, 70.0});
  const double budget = 1.025 * bytes_of(first_trial);
  const auto shared = pack({EncodeTarget::Kind::kBytes, budget});
  EXPECT_LE(bytes_of(shared), budget);
  const double before = ScenePsnr(asset, first_trial.glb), after = ScenePsnr(asset, shared.glb);
  EXPECT_GT(after, before + 0.7) << before;
  EXPECT_LT(after, before + 4.0) << before;
}

TEST(Pack, ADistanceIsOneOfTheWorld) {
  AssetBuilder builder;
  builder.AddMesh("ball", Json::array({builder.Primitive(WavySphere(13, 22))}));
  constexpr double kScale = 4, kDistance = 0.05;
  builder.document().json["nodes"][0]["scale"] = {kScale, kScale, kScale};
  PackOptions options = Options(Fallback::kDraco);
  options.encode.target = {EncodeTarget::Kind::kDistance, kDistance};
  const auto packed = PackGltf(builder.Glb(), options);
  ASSERT_TRUE(packed.ok()) << packed.status().message();
  const PrimitiveReport& ball = packed.value().report.primitives[0];
  EXPECT_NEAR(ball.target_error, kDistance / kScale, 1e-6);
  ASSERT_FALSE(ball.encode.levels.empty());
  EXPECT_LE(ball.encode.levels.back().error, kDistance / kScale);
  EXPECT_GE(ball.encode.levels.back().error, 0.9 * kDistance / kScale);
}

TEST(Pack, ADistanceNeedsSomethingToBeSeen) {
  AssetBuilder builder;
  builder.AddMesh("ball", Json::array({builder.Primitive(WavySphere(13, 22))}));
  builder.document().json["scenes"][0]["nodes"] = Json::array();
  PackOptions options = Options(Fallback::kDraco);
  options.encode.target = {EncodeTarget::Kind::kDistance, 0.05};
  const Status status = PackGltf(builder.Glb(), options).status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(status.message(), HasSubstr("shows no triangles"));
}

// Its tangents and thin parts decide, not its shape: with the shape let go of, collapses once took more triangles than at 70 dB.
TEST(Pack, ALooserErrorTakesNoMoreBytes) {
  const std::string path = std::string(LACERTA_TEST_DATA_DIR) + "/Corset.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  PackOptions options;
  options.encode.target = {EncodeTarget::Kind::kPsnr, 60.0};
  options.encode.levels = LevelChoice::kNever;
  const uint64_t bytes = PackGltf(ReadFile(path).value(), options).value().report.primitives[0].bytes_after;
  EXPECT_LT(bytes, 17'000u);  // 16,283 at 70 dB
  EXPECT_GT(bytes, 12'000u);
}

TEST(Pack, EverythingElsePassesThrough) {
  const Bytes asset = MixedAsset();
  const Json before = JsonOf(asset);
  const Json after = JsonOf(PackGltf(asset, Options(Fallback::kDraco)).value().glb);
  for (const char* key : {"asset", "scene", "scenes", "nodes", "materials", "animations", "unknownToEveryone"}) {
    EXPECT_EQ(after[key], before[key]) << key;
  }
  EXPECT_EQ(after["meshes"][0]["name"], "ball");
  EXPECT_EQ(after["meshes"][2]["primitives"][1]["material"], 0);
}

TEST(Pack, ImagesAnimationsAndMorphTargetsStayByteForByte) {
  AssetBuilder builder;
  const TriangleMesh ball = WavySphere(13, 22);
  Json morph = builder.Primitive(ball);
  morph["targets"] = Json::array({{{"POSITION", builder.AddFloats(ball.positions, true)}}});
  builder.AddMesh("morph", Json::array({morph}));
  builder.AddMesh("ball", Json::array({builder.Primitive(WavySphere(13, 22))}));
  GltfDocument& document = builder.document();
  const Bytes image = {0x89, 'P', 'N', 'G', 1, 2, 3};
  document.json["images"] =
      Json::array({{{"mimeType", "image/png"},
                    {"bufferView", AddBufferView(AddBuffer(image, &document), 0, image.size(), &document)}}});
  const Bytes glb = builder.Glb();
  PackOptions options = Options(Fallback::kDraco);
  options.simplify = false;  // morph targets would be simplified with their surface,
  options.encode.levels = LevelChoice::kWhereTheyPay;  // or remeshed with it
  const auto packed = PackGltf(glb, options);
  ASSERT_TRUE(packed.ok()) << packed.status().message();
  EXPECT_EQ(packed.value().report.primitives[0].storage, PrimitiveStorage::kDraco) << packed.value().report.primitives[0].reason;
  const GltfDocument before = ParseGltf(glb, "").value();
  const GltfDocument after = ParseGltf(packed.value().glb, "").value();
  // The target holds the positions, so the two go together in whatever order.
  const auto unpacked = UnpackGltf(packed.value().glb, {});
  ASSERT_TRUE(unpacked.ok()) << unpacked.status().message();
  const GltfDocument plain = ParseGltf(unpacked.value().glb, "").value();
  const Json& morphed = plain.json["meshes"][0]["primitives"][0];
  const AccessorData base = ReadAccessor(plain, morphed["attributes"]["POSITION"]).value();
  const AccessorData target = ReadAccessor(plain, morphed["targets"][0]["POSITION"]).value();
  ASSERT_EQ(target.count, base.count);
  std::set<std::vector<float>> offsets;
  for (uint64_t v = 0; v < base.count; ++v) {
    for (uint32_t c = 0; c < 3; ++c) EXPECT_NEAR(target.Float(v, c), base.Float(v, c), 0.05) << v;
    offsets.insert({target.Float(v, 0), target.Float(v, 1), target.Float(v, 2)});
  }
  for (const Vec3f& position : ball.positions) {  // exactly
    EXPECT_EQ(offsets.count({position.x, position.y, position.z}), 1u);
  }
  const Span<const uint8_t> kept = BufferViewBytes(after, after.json["images"][0]["bufferView"]).value();
  EXPECT_EQ(Bytes(kept.begin(), kept.end()), image);
}

TEST(Pack, AllThatSurfacesNeedComesBeforeTheirStreamsAndImagesLast) {
  AssetBuilder builder;
  builder.AddMesh("ball", Json::array({builder.Primitive(WavySphere(13, 22))}));
  GltfDocument& document = builder.document();
  const Bytes image(1000, 7);
  const uint64_t image_view = AddBufferView(AddBuffer(image, &document), 0, image.size(), &document);
  document.json["images"] = Json::array({{{"mimeType", "image/png"}, {"bufferView", image_view}}});
  builder.AddFloats(WavySphere(3, 3).positions, true);  // of an animation, say
  const auto packed = PackGltf(builder.Glb(), Options(Fallback::kDraco));
  ASSERT_TRUE(packed.ok()) << packed.status().message();
  const GltfDocument after = ParseGltf(packed.value().glb, "").value();
  const StatusOr<Progressive> progressive = ParseProgressive(after);
  ASSERT_TRUE(progressive.ok()) << progressive.status().message();
  const auto range_of = [&](const Json& view) {
    const auto begin = view.value("byteOffset", uint64_t{0});
    return std::make_pair(begin, begin + view["byteLength"].get<uint64_t>());
  };
  const Json& views = after.json["bufferViews"];
  const auto [data_begin, data_end] = range_of(views[static_cast<size_t>(progressive.value().data)]);
  const auto kept_image = after.json["images"][0]["bufferView"].get<size_t>();
  size_t before = 0;
  for (size_t view = 0; view < views.size(); ++view) {
    const auto [begin, end] = range_of(views[view]);
    if (view == kept_image) {
      EXPECT_GE(begin, data_end);
    } else if (begin != data_begin) {  // where the base begins, too
      EXPECT_LE(end, data_begin);
      ++before;
    }
  }
  EXPECT_GE(before, 1u);
}

TEST(Pack, SharedAccessorsAndInstances) {
  AssetBuilder builder;
  const Json primitive = builder.Primitive(WavySphere(13, 22));
  builder.AddMesh("one", Json::array({primitive}));
  Json blue = primitive;
  blue["material"] = 1;
  // Any number in an extension that nobody knows might be an accessor, which then stays.
  builder.document().json["materials"] = {{{"name", "red"}}, {{"name", "blue"}}};
  builder.AddMesh("same surface", Json::array({blue}));
  const auto packed = PackGltf(builder.Glb(), Options(Fallback::kDraco));
  ASSERT_TRUE(packed.ok()) << packed.status().message();
  EXPECT_EQ(packed.value().report.primitives.size(), 1u);  // stored once
  const Json json = JsonOf(packed.value().glb);
  EXPECT_EQ(json["meshes"][0]["primitives"][0]["attributes"], json["meshes"][1]["primitives"][0]["attributes"]);
  EXPECT_EQ(json["meshes"][1]["primitives"][0]["material"], 1);
  EXPECT_EQ(json["accessors"].size(), 2u);

  // An accessor that an untouched primitive uses as well must keep its values.
  AssetBuilder sharing;
  Json points = sharing.Primitive(WavySphere(13, 22));
  const Json triangles = points;
  points["mode"] = 0;
  sharing.AddMesh("surface", Json::array({triangles}));
  sharing.AddMesh("points", Json::array({points}));
  const Bytes glb = sharing.Glb();
  const auto shared = PackGltf(glb, Options(Fallback::kDraco));
  ASSERT_TRUE(shared.ok()) << shared.status().message();
  EXPECT_EQ(shared.value().report.primitives[0].storage, PrimitiveStorage::kProgressive);
  const GltfDocument after = ParseGltf(shared.value().glb, "").value();
  EXPECT_EQ(ReadAccessor(after, after.json["meshes"][1]["primitives"][0]["attributes"]["POSITION"]).value().bytes,
            ReadAccessor(ParseGltf(glb, "").value(), 0).value().bytes);
}

// Numbers of an extension that nobody knows may be accessors, those of an avatar's are nodes and the like.
TEST(Pack, AccessorsStayForUnknownExtensionsAlone) {
  for (const bool is_known : {false, true}) {
    AssetBuilder builder;
    builder.AddMesh("ball", Json::array({builder.Primitive(WavySphere(13, 22))}));
    Json& json = builder.document().json;
    json["materials"] = {{{"name", "red"}}};
    const char* const name = is_known ? "VRMC_vrm" : "VENDOR_shapes";
    json["extensionsUsed"] = {name};
    json["extensions"][name] = {{"humanoid", {{"humanBones", {{"hips", {{"node", 0}}}, {"head", {{"node", 1}}}}}}}};
    const Bytes glb = builder.Glb();
    const auto packed = PackGltf(glb, Options(Fallback::kDraco));
    ASSERT_TRUE(packed.ok()) << packed.status().message();
    ASSERT_EQ(packed.value().report.primitives[0].storage, PrimitiveStorage::kProgressive);
    const GltfDocument after = ParseGltf(packed.value().glb, "").value();
    EXPECT_EQ(after.json["accessors"].size(), is_known ? 2u : 4u);
    EXPECT_EQ(after.json["extensions"][name], json["extensions"][name]);
    if (is_known) {
      EXPECT_LT(packed.value().glb.size(), glb.size() / 2);
    } else {
      EXPECT_EQ(ReadAccessor(after, 0).value().bytes, ReadAccessor(ParseGltf(glb, "").value(), 0).value().bytes);
    }
  }
}

// As some programs write them: all positions of an asset in one view, all indices in another. What is replaced is gone although
// points, which stay, hold on to both views.
TEST(Pack, ViewsOfSeveralPrimitivesShrink) {
  AssetBuilder builder;
  for (const float x : {0.0f, 3.0f, 6.0f}) builder.AddMesh("ball", Json::array({builder.Primitive(WavySphere(13, 22, {x, 0, 0}))}));
  Json& json = builder.document().json;
  json["materials"] = {{{"name", "red"}}};  // without extensions whose numbers might be accessors
  json["meshes"][1]["primitives"][0]["mode"] = 0;
  std::vector<Bytes> views(2);  // positions, indices
  for (size_t i = 0; i < json["accessors"].size(); ++i) {
    Json& accessor = json["accessors"][i];
    Bytes& view = views[i % 2];
    const Bytes values = ReadAccessor(builder.document(), i).value().bytes;
    accessor["bufferView"] = i % 2;
    accessor["byteOffset"] = view.size();
    view.insert(view.end(), values.begin(), values.end());
    view.resize((view.size() + 3) / 4 * 4);
  }
  json.erase("bufferViews");
  for (const Bytes& view : views) AddBufferView(AddBuffer(view, &builder.document()), 0, view.size(), &builder.document());
  const Bytes glb = builder.Glb();
  const auto packed = PackGltf(glb, Options(Fallback::kDraco));
  ASSERT_TRUE(packed.ok()) << packed.status().message();
  const GltfDocument before = ParseGltf(glb, "").value(), after = ParseGltf(packed.value().glb, "").value();
  uint64_t kept = 0, stored = 0;
  for (const PrimitiveReport& report : packed.value().report.primitives) {
    if (report.storage != PrimitiveStorage::kUntouched) stored += report.bytes_after;
  }
  for (const char* reference : {"POSITION", "indices"}) {
    const auto values = [&](const GltfDocument& document) {
      const Json& primitive = document.json["meshes"][1]["primitives"][0];
      return ReadAccessor(document, std::string(reference) == "indices" ? primitive["indices"] : primitive["attributes"][reference]).value().bytes;
    };
    EXPECT_EQ(values(after), values(before));
    kept += values(before).size();
  }
  EXPECT_GT(stored, 0u);
  EXPECT_GE(after.buffers[0].size(), kept + stored);
  EXPECT_LE(after.buffers[0].size(), kept + stored + 16);  // aligned
}

// A ball is worth compressing, but not a box, nor a surface whose every place would need a description that takes more than it saves.
TEST(Pack, NothingGrowsByItsDescription) {
  const struct {
    TriangleMesh mesh;
    int places;
    bool is_compressed;
  } kCases[] = {{WavySphere(3, 4), 1, false}, {WavySphere(13, 22), 1, true}, {WavySphere(13, 22), 2, true}, {WavySphere(13, 22), 60, false}};
  for (const auto& a_case : kCases) {
    AssetBuilder builder;
    const Json primitive = builder.Primitive(a_case.mesh);
    for (int i = 0; i < a_case.places; ++i) builder.AddMesh("shared", Json::array({primitive}));
    PackOptions options;
    options.encode.target = {EncodeTarget::Kind::kPsnr, 45.0};
    const Bytes before = builder.Glb();
    const auto packed = PackGltf(before, options);
    ASSERT_TRUE(packed.ok()) << packed.status().message();
    ASSERT_EQ(packed.value().report.primitives.size(), 1u);
    const PrimitiveReport& report = packed.value().report.primitives[0];
    EXPECT_EQ(report.storage != PrimitiveStorage::kUntouched, a_case.is_compressed) << a_case.mesh.triangles.size() << ' ' << a_case.places;
    EXPECT_LE(packed.value().glb.size(), before.size());
    if (!a_case.is_compressed) {
      EXPECT_THAT(report.reason, HasSubstr("compressed it would be larger"));
    }
  }
}

// There is nothing to refine, and stock readers show all of it; but who is to derive normals has to be told so.
TEST(Pack, StreamsWithoutLevelsAreStockDraco) {
  const TriangleMesh ball = WavySphere(40, 64);
  AssetBuilder builder;
  builder.AddMesh("bare", Json::array({builder.Primitive(ball)}));
  Json smooth = builder.Primitive(WavySphere(40, 64, {3, 0, 0}));
  smooth["attributes"]["NORMAL"] = builder.AddFloats(SmoothNormals(ball.positions, ball.triangles), false);
  builder.AddMesh("smooth", Json::array({smooth}));
  PackOptions options;
  options.encode.target = {EncodeTarget::Kind::kPsnr, 60.0};
  options.encode.levels = LevelChoice::kNever;
  options.attributes.normal_degrees = 10.0;
  const PackResult packed = PackGltf(builder.Glb(), options).value();
  const GltfDocument document = ParseGltf(packed.glb, "").value();
  const Json& bare = document.json["meshes"][0]["primitives"][0]["extensions"];
  EXPECT_TRUE(bare.contains(kDracoName));
  EXPECT_FALSE(bare.contains(kProgressiveName));
  const PrimitiveReport& report = packed.report.primitives[0];
  EXPECT_EQ(report.storage, PrimitiveStorage::kDraco);
  ASSERT_EQ(report.encode.levels.size(), 1u);
  EXPECT_EQ(report.error, report.encode.levels[0].error);
  EXPECT_LE(report.error, report.target_error);
  const Json& position = document.json["accessors"][document.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<size_t>()];
  EXPECT_EQ(position["count"], report.encode.levels[0].vertices);
  ASSERT_EQ(packed.report.primitives[1].storage, PrimitiveStorage::kProgressive) << packed.report.primitives[1].reason;
  const Progressive progressive = ParseProgressive(document).value();
  ASSERT_EQ(progressive.streams.size(), 1u);
  EXPECT_TRUE(progressive.streams[0].smooth_normals);
  // Only where Draco shows it.
  options.fallback = Fallback::kPlain;
  EXPECT_EQ(PackGltf(builder.Glb(), options).value().report.primitives[0].storage, PrimitiveStorage::kProgressive);
}

// A stream is asked for, which hosts read with ReadProgressive.
TEST(Pack, WhereLevelsAreAlwaysWantedThereIsAStreamWithoutAnyToo) {
  PackOptions options;
  options.encode.target = {EncodeTarget::Kind::kPsnr, 50.0};
  options.encode.levels = LevelChoice::kAlways;
  const PackResult packed = PackMesh(WavySphere(8, 12), "small", options).value();
  EXPECT_EQ(packed.report.primitives[0].storage, PrimitiveStorage::kProgressive);
  EXPECT_EQ(packed.report.primitives[0].encode.levels.size(), 1u);
  EXPECT_EQ(ParseProgressive(ParseGltf(packed.glb, "").value()).value().streams.size(), 1u);
}

// The same ball with bounds that normals derived from its stream meet, and that they do not.
TEST(Pack, DerivedNormalsAreHeldToTheirTarget) {
  const TriangleMesh ball = WavySphere(40, 64);
  AssetBuilder builder;
  Json primitive = builder.Primitive(ball);
  primitive["attributes"]["NORMAL"] = builder.AddFloats(SmoothNormals(ball.positions, ball.triangles), false);
  builder.AddMesh("ball", Json::array({primitive}));
  const Bytes asset = builder.Glb();
  PackOptions options;
  options.encode.target = {EncodeTarget::Kind::kPsnr, 60.0};
  options.attributes.normal_degrees = 10.0;
  const PackResult loose = PackGltf(asset, options).value();
  ASSERT_EQ(loose.report.primitives[0].storage, PrimitiveStorage::kProgressive);
  EXPECT_TRUE(ParseProgressive(ParseGltf(loose.glb, "").value()).value().streams[0].smooth_normals);
  options.attributes.normal_degrees = 0.5;
  const PackResult tight = PackGltf(asset, options).value();
  const PrimitiveReport& report = tight.report.primitives[0];
  EXPECT_THAT(report.reason, HasSubstr("normals that readers derive would be"));
  EXPECT_GT(tight.glb.size(), loose.glb.size());
  ASSERT_EQ(report.attributes.size(), 1u);
  EXPECT_EQ(report.attributes[0].name, "NORMAL");
  EXPECT_LE(report.attributes[0].error, 0.5);
  EXPECT_GE(report.attributes[0].error, 0.2);

  // Where only a stream of the shape will do, it is taken, and the report says what that means.
  options.fallback = Fallback::kPlain;
  const PackResult plain = PackGltf(asset, options).value();
  EXPECT_EQ(plain.report.primitives[0].storage, PrimitiveStorage::kProgressive);
  EXPECT_THAT(plain.report.primitives[0].reason, HasSubstr("normals that readers derive would be"));
  options.attributes.normal_degrees = 10.0;
  EXPECT_THAT(PackGltf(asset, options).value().report.primitives[0].reason, Not(HasSubstr("normals")));
}

TEST(Pack, BadInputIsNamed) {
  AssetBuilder builder;
  builder.AddMesh("ball", Json::array({builder.Primitive(WavySphere(13, 22))}));
  GltfDocument& document = builder.document();
  const auto message_with = [&](size_t buffer, size_t offset, const void* value, size_t size) {
    const Bytes saved = document.buffers[buffer];
    std::memcpy(document.buffers[buffer].data() + offset, value, size);
    const Status status = PackGltf(builder.Glb(), Options(Fallback::kDraco)).status();
    document.buffers[buffer] = saved;
    EXPECT_EQ(status.code(), StatusCode::kInvalidData);
    return status.message();
  };
  const float infinite = INFINITY;
  EXPECT_THAT(message_with(0, size_t{12} * 7, &infinite, 4),
              AllOf(HasSubstr("mesh 0 (ball), primitive 0"), HasSubstr("vertex 7"), HasSubstr("not finite")));
  const uint16_t far = 60000;
  EXPECT_THAT(message_with(1, size_t{2} * 5, &far, 2),
              AllOf(HasSubstr("accessor 1"), HasSubstr("index 60000"), HasSubstr("position 5")));
  EXPECT_EQ(PackGltf(PackGltf(builder.Glb(), Options(Fallback::kDraco)).value().glb, Options(Fallback::kDraco))
                .status()
                .code(),
            StatusCode::kUnsupported);
  EXPECT_EQ(PackMesh(TriangleMesh(), "", Options(Fallback::kDraco)).status().code(), StatusCode::kInvalidData);
  PackOptions custom = Options(Fallback::kDraco);
  custom.encode.form = StreamForm::kCustom;
  EXPECT_EQ(PackGltf(builder.Glb(), custom).status().code(), StatusCode::kInvalidArgument);
}

// New bufferViews would else be taken for the one that is missing.
TEST(Pack, WhatRefersToNothingIsRefused) {
  AssetBuilder builder;
  builder.AddMesh("ball", Json::array({builder.Primitive(WavySphere(13, 22))}));
  Json& json = builder.document().json;
  json["accessors"].push_back({{"bufferView", json["bufferViews"].size()}, {"componentType", 5126}, {"count", 3}, {"type", "SCALAR"}});
  const Status status = PackGltf(builder.Glb(), Options(Fallback::kDraco)).status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidData);
  EXPECT_THAT(status.message(), HasSubstr("/accessors/2/bufferView refers to /bufferViews/2, which does not exist"));
  json["accessors"][2] = {{"bufferView", 0}, {"componentType", 5126}, {"count", 100000}, {"type", "MAT4"}};
  const Status beyond = PackGltf(builder.Glb(), Options(Fallback::kDraco)).status();
  EXPECT_EQ(beyond.code(), StatusCode::kInvalidData);
  EXPECT_THAT(beyond.message(), AllOf(HasSubstr("accessor 2"), HasSubstr("100000 elements")));
}

// One asset of every class: what is in it, and how its primitives end.
struct AssetClass {
  const char* file;
  PrimitiveStorage storage;
};

void PrintTo(const AssetClass& asset, std::ostream* out) { *out << asset.file; }

class PackAssets : public ::testing::TestWithParam<AssetClass> {};

TEST_P(PackAssets, PacksAndUnpacks) {
  const std::string path = std::string(LACERTA_TEST_DATA_DIR) + "/" + GetParam().file;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << GetParam().file << " is not there";
  const Bytes asset = ReadFile(path).value();
  PackOptions options;
  options.simplify = false;  // AssetTest does
  const auto packed = PackGltf(asset, options);
  ASSERT_TRUE(packed.ok()) << packed.status().message();
  for (const PrimitiveReport& primitive : packed.value().report.primitives) {
    EXPECT_EQ(primitive.storage, GetParam().storage) << primitive.reason;
    EXPECT_FALSE(primitive.reason.empty());
    EXPECT_LE(primitive.bytes_after, primitive.bytes_before);
  }
  EXPECT_LE(packed.value().glb.size(), asset.size());
  const auto unpacked = UnpackGltf(packed.value().glb, {});
  ASSERT_TRUE(unpacked.ok()) << unpacked.status().message();
  EXPECT_THAT(unpacked.value().notes, ::testing::IsEmpty());
  const auto before = FlattenGltf(asset, {});
  const auto after = FlattenGltf(unpacked.value().glb, {});
  ASSERT_TRUE(before.ok() && after.ok());
  EXPECT_LE(after.value().mesh.triangles.size(), before.value().mesh.triangles.size());  // degenerate ones may go
  EXPECT_GE(after.value().mesh.triangles.size(), before.value().mesh.triangles.size() * 8 / 10);
}

INSTANTIATE_TEST_SUITE_P(Classes, PackAssets,
                         ::testing::Values(AssetClass{"BoomBox.glb", PrimitiveStorage::kDraco},    // tangents
                                           AssetClass{"CesiumMan.glb", PrimitiveStorage::kDraco},  // skin
                                           AssetClass{"Fox.glb", PrimitiveStorage::kDraco},        // not indexed
                                           AssetClass{"MorphStressTest.glb", PrimitiveStorage::kDraco},
                                           AssetClass{"CesiumMilkTruck.glb", PrimitiveStorage::kDraco},  // instances
                                           AssetClass{"spot_textured.glb", PrimitiveStorage::kDraco}),
                         [](const auto& asset) {
                           return std::string(asset.param.file, std::strcspn(asset.param.file, "."));
                         });

}  // namespace
}  // namespace lacerta
