#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "document/buffer_edit.h"
#include "document/draco_encode.h"
#include "document/gltf_document.h"
#include "extension/progressive.h"
#include "document/place.h"
#include "document/primitive.h"
#include "gltf/test_assets.h"
#include "gltf/torus_asset.h"
#include "gltf/test_bytes.h"
#include "lacerta/gltf.h"
#include "lacerta/surface_distance.h"

namespace lacerta {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::JsonOf;
using testing::WavySphere;

// Encoded once per process: the tests change copies of it.
const PackResult& Packed(Fallback fallback) {
  static std::map<Fallback, PackResult> known;
  const auto found = known.find(fallback);
  if (found != known.end()) return found->second;
  PackOptions options;
  options.encode.target = {EncodeTarget::Kind::kPsnr, 62.0};
  options.encode.levels = LevelChoice::kAlways;
  options.fallback = fallback;
  return known.emplace(fallback, PackMesh(WavySphere(24, 36), "ball", options).value()).first->second;
}

ProgressiveSurface Read(const Bytes& glb, std::optional<int> level = std::nullopt) {
  UnpackOptions options;
  options.level = level;
  const auto surfaces = ReadProgressive(glb, options);
  EXPECT_TRUE(surfaces.ok()) << surfaces.status().message();
  return surfaces.ok() && surfaces.value().size() == 1 ? surfaces.value()[0] : ProgressiveSurface();
}

// Weights of two sets, each rounded to steps of its own, add up to 1 again.
TEST(Unpack, WeightsOfAllSetsAddUpToOne) {
  const TriangleMesh ball = WavySphere(8, 12);
  Primitive primitive{ball.positions.size(), ball.triangles, {{"POSITION", MakeFloatAccessor(ball.positions)}}};
  std::vector<float> first, second;
  for (const Vec3f& p : ball.positions) {
    const float share = 0.31f + 0.13f * p.x;
    first.insert(first.end(), {share, 0.2f, 0.1f, 0.05f});
    second.insert(second.end(), {0.65f - share, 0, 0, 0});
  }
  primitive.attributes.push_back({"WEIGHTS_0", MakeFloatAccessor(first, 4)});
  primitive.attributes.push_back({"WEIGHTS_1", MakeFloatAccessor(second, 4)});
  DracoPrecision precision{PositionLattice({-2, -2, -2}, {2, 2, 2}, 10), {}, 0};
  precision.lattices = {{"WEIGHTS_0", LatticeOfStep({{0, 0, 0, 0}, 1.0f, 0}, 1.0f / 30)}, {"WEIGHTS_1", LatticeOfStep({{0, 0, 0, 0}, 1.0f, 0}, 1.0f / 17)}};
  const DracoEncoded encoded = EncodeDracoPrimitive(primitive, precision).value();
  const auto sum_at = [](const Primitive& p, uint64_t v) {
    double sum = 0;
    for (const char* name : {"WEIGHTS_0", "WEIGHTS_1"}) {
      for (uint32_t c = 0; c < 4; ++c) sum += static_cast<double>(p.Find(name)->data.Float(v, c));
    }
    return sum;
  };
  double farthest = 0;
  for (uint64_t v = 0; v < encoded.decoded.num_vertices; ++v) farthest = std::max(farthest, std::fabs(sum_at(encoded.decoded, v) - 1));
  ASSERT_GT(farthest, 1e-3) << "there is something to mend";

  testing::AssetBuilder builder;
  GltfDocument& document = builder.document();
  const uint64_t view = AddBufferView(AddBuffer(encoded.bytes, &document), 0, encoded.bytes.size(), &document);
  Json json = {{"attributes", Json::object()}, {"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", Json::object()}}}}}};
  for (const DracoAttributeId& id : encoded.ids) {
    Json accessor = DescribeAccessor(encoded.decoded.Find(id.name)->data, id.name == "POSITION");
    json["attributes"][id.name] = AddAccessor(std::move(accessor), &document);
    json["extensions"]["KHR_draco_mesh_compression"]["attributes"][id.name] = id.id;
  }
  json["indices"] = AddAccessor({{"componentType", 5125}, {"type", "SCALAR"}, {"count", 3 * encoded.decoded.triangles.size()}}, &document);
  builder.AddMesh("ball", Json::array({json}));
  const StatusOr<UnpackResult> unpacked = UnpackGltf(builder.Glb(), {});
  ASSERT_TRUE(unpacked.ok()) << unpacked.status().message();
  const GltfDocument plain = ParseGltf(unpacked.value().glb, "").value();
  const Primitive read = ReadPrimitive(plain, PrimitiveAt(plain, {0, 0}), DecodeLimits()).value();
  ASSERT_EQ(read.num_vertices, encoded.decoded.num_vertices);
  for (uint64_t v = 0; v < read.num_vertices; ++v) EXPECT_NEAR(sum_at(read, v), 1, 2e-7 * 8) << v;
}

TEST(Unpack, EveryLevelOfEveryFallback) {
  for (const Fallback fallback : {Fallback::kDraco, Fallback::kPlain, Fallback::kNone}) {
    const PackResult& packed = Packed(fallback);
    const EncodeReport& report = packed.report.primitives[0].encode;
    ASSERT_EQ(packed.report.primitives[0].storage, PrimitiveStorage::kProgressive);
    for (size_t level = 0; level < report.levels.size(); ++level) {
      const ProgressiveSurface surface = Read(packed.glb, static_cast<int>(level));
      EXPECT_FALSE(surface.from_fallback);
      EXPECT_THAT(surface.note, IsEmpty());
      EXPECT_EQ(surface.level, static_cast<int>(level));
      EXPECT_EQ(surface.num_levels + 1, static_cast<int>(report.levels.size()));
      EXPECT_EQ(surface.surface.triangles.size(), report.levels[level].triangles);
      UnpackOptions options;
      options.level = static_cast<int>(level);
      const auto plain = UnpackGltf(packed.glb, options);
      ASSERT_TRUE(plain.ok()) << plain.status().message();
      EXPECT_FALSE(JsonOf(plain.value().glb).contains("extensionsUsed"));
      const auto flat = FlattenGltf(plain.value().glb, {});
      ASSERT_TRUE(flat.ok()) << flat.status().message();
      EXPECT_EQ(flat.value().mesh.positions, surface.surface.positions);
      EXPECT_EQ(flat.value().mesh.triangles, surface.surface.triangles);
    }
  }
}

TEST(Unpack, FallbackAndBaseAgree) {
  const ProgressiveSurface base = Read(Packed(Fallback::kDraco).glb, 0);
  GltfDocument document = ParseGltf(Packed(Fallback::kDraco).glb, "").value();
  document.json["extensions"][kProgressiveName]["version"] = 99;  // force the fallback
  const ProgressiveSurface fallback = Read(FormatGlb(document));
  EXPECT_TRUE(fallback.from_fallback);
  EXPECT_THAT(fallback.note, AllOf(HasSubstr("version 99"), HasSubstr("fallback")));
  EXPECT_EQ(fallback.surface.positions, base.surface.positions);
  EXPECT_EQ(fallback.surface.triangles, base.surface.triangles);
}

TEST(Unpack, AnEditedAssetShowsItsFallback) {
  const auto note_after = [](Fallback fallback, const std::string& pointer, const Json& value) {
    GltfDocument document = ParseGltf(Packed(fallback).glb, "").value();
    document.json[Json::json_pointer(pointer)] = value;
    const ProgressiveSurface surface = Read(FormatGlb(document));
    EXPECT_TRUE(surface.from_fallback) << pointer;
    EXPECT_FALSE(surface.surface.triangles.empty());
    return surface.note;
  };
  const std::string extension = std::string("/extensions/") + kProgressiveName;
  const std::string primitive = std::string("/meshes/0/primitives/0/extensions/") + kProgressiveName;
  // A dangling view must not harm unpacking either, also where nothing may be renumbered.
  GltfDocument dangling = ParseGltf(Packed(Fallback::kDraco).glb, "").value();
  dangling.json["extensions"][kProgressiveName]["data"] = 1000;
  dangling.json["extensionsUsed"].push_back("VENDOR_unknown");
  EXPECT_TRUE(UnpackGltf(FormatGlb(dangling), {}).ok());
  EXPECT_THAT(note_after(Fallback::kPlain, "/accessors/0/max/0", 77.0), HasSubstr("edited"));
  EXPECT_THAT(note_after(Fallback::kDraco, "/accessors/0/min/0", -77.0), HasSubstr("edited"));
  EXPECT_THAT(note_after(Fallback::kDraco, extension + "/data", 1000), HasSubstr("bufferView 1000"));
  EXPECT_THAT(note_after(Fallback::kDraco, extension + "/segments/byteLength/0", 3), Not(IsEmpty()));
  EXPECT_THAT(note_after(Fallback::kDraco, extension + "/streams/0/triangleCounts", Json::array()),
              HasSubstr("stream 0"));
  EXPECT_THAT(note_after(Fallback::kDraco, primitive + "/stream", 4), HasSubstr("stream 4"));
  EXPECT_THAT(note_after(Fallback::kDraco, primitive + "/group", 1), HasSubstr("group 1"));
  GltfDocument gone = ParseGltf(Packed(Fallback::kPlain).glb, "").value();
  gone.json.erase("extensions");
  EXPECT_TRUE(Read(FormatGlb(gone)).from_fallback);
}

TEST(Unpack, WithoutFallbackItFailsByName) {
  GltfDocument document = ParseGltf(Packed(Fallback::kNone).glb, "").value();
  document.json["extensions"][kProgressiveName]["data"] = 1000;
  const Status status = UnpackGltf(FormatGlb(document), {}).status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidData);
  EXPECT_THAT(status.message(), AllOf(HasSubstr("mesh 0 (ball)"), HasSubstr("bufferView 1000")));
}

TEST(Unpack, EveryPrefixThatHoldsTheBaseGivesAMesh) {
  const PackResult& packed = Packed(Fallback::kDraco);
  const StreamInfo info = DescribeGltf(packed.glb, "").value().streams[0];
  ASSERT_GE(info.levels.size(), 2u);
  const uint64_t padding = 3;
  const uint64_t data_begin = packed.glb.size() - info.levels.back().bytes;  // up to the padding at the end
  int last_level = -1;
  for (size_t length = 0; length <= packed.glb.size(); length += 1 + length % 7) {
    const Bytes prefix(packed.glb.begin(), packed.glb.begin() + static_cast<std::ptrdiff_t>(length));
    const auto surfaces = ReadProgressive(prefix, {});
    if (length >= data_begin + info.levels[0].bytes) {
      ASSERT_TRUE(surfaces.ok()) << length << surfaces.status().message();
      const ProgressiveSurface& surface = surfaces.value()[0];
      EXPECT_FALSE(surface.from_fallback);
      EXPECT_GE(surface.level, last_level);
      last_level = surface.level;
      EXPECT_EQ(surface.note.empty(), surface.level == surface.num_levels) << surface.note;
    } else if (length + padding < data_begin + info.levels[0].bytes) {
      EXPECT_FALSE(surfaces.ok()) << length;
    }
  }
  EXPECT_EQ(static_cast<size_t>(Read(packed.glb).level) + 1, info.levels.size());
}

TEST(Unpack, DamagedBytesNeverCrash) {
  const Bytes glb = Packed(Fallback::kDraco).glb;
  size_t notes = 0;
  for (size_t i = 0; i < glb.size(); i += 3) {
    Bytes mutant = glb;
    mutant[i] = static_cast<uint8_t>(mutant[i] ^ 0x55);
    const auto surfaces = ReadProgressive(mutant, {});
    if (!surfaces.ok()) {
      EXPECT_FALSE(surfaces.status().message().empty());
    } else {
      for (const ProgressiveSurface& surface : surfaces.value()) {
        notes += surface.note.empty() ? 0 : 1;
        for (const Triangle& triangle : surface.surface.triangles) {
          for (const uint32_t index : triangle) ASSERT_LT(index, surface.surface.positions.size());
        }
      }
    }
  }
  EXPECT_GT(notes, 0u);
}

TEST(Flatten, AppliesTransformsAndMirrors) {
  testing::AssetBuilder builder;
  const TriangleMesh ball = WavySphere(4, 6);
  builder.AddMesh("ball", Json::array({builder.Primitive(ball)}));
  Json& nodes = builder.document().json["nodes"];
  nodes[0]["scale"] = {-1, 2, 1};
  nodes[0]["rotation"] = {0, 0, 0.7071067811865476, 0.7071067811865476};  // x to y, y to -x
  nodes[0]["translation"] = {10, 0, 0};
  nodes.push_back({{"children", {0}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}});
  builder.document().json["scenes"][0]["nodes"] = {1};
  const auto flat = FlattenGltf(builder.Glb(), {});
  ASSERT_TRUE(flat.ok()) << flat.status().message();
  for (size_t v = 0; v < ball.positions.size(); ++v) {
    const Vec3f expected = {10 - 2 * ball.positions[v].y, -ball.positions[v].x, 5 + ball.positions[v].z};
    EXPECT_LT(Norm(flat.value().mesh.positions[v] - expected), 1e-5f);
  }
  const Triangle& before = ball.triangles[0];
  EXPECT_EQ(flat.value().mesh.triangles[0], (Triangle{before[0], before[2], before[1]}));
}

TEST(Flatten, RefusesCyclesAndTooManyInstances) {
  testing::AssetBuilder builder;
  builder.AddMesh("ball", Json::array({builder.Primitive(WavySphere(4, 6))}));
  Json& nodes = builder.document().json["nodes"];
  nodes[0]["children"] = {0};
  EXPECT_THAT(FlattenGltf(builder.Glb(), {}).status().message(), HasSubstr("node 0"));
  nodes[0]["children"] = {9};
  EXPECT_THAT(FlattenGltf(builder.Glb(), {}).status().message(), HasSubstr("node 9"));
  nodes[0].erase("children");
  UnpackOptions options;
  options.limits.max_triangles = 10;
  EXPECT_EQ(FlattenGltf(builder.Glb(), options).status().code(), StatusCode::kLimitExceeded);
}

TEST(Describe, TellsWhatIsInside) {
  const PackResult& packed = Packed(Fallback::kPlain);
  const auto info = DescribeGltf(packed.glb, "");
  ASSERT_TRUE(info.ok()) << info.status().message();
  EXPECT_EQ(info.value().fallback, Fallback::kPlain);
  ASSERT_EQ(info.value().streams.size(), 1u);
  const StreamInfo& stream = info.value().streams[0];
  EXPECT_EQ(stream.name, "ball");
  const EncodeReport& report = packed.report.primitives[0].encode;
  ASSERT_EQ(stream.levels.size(), report.levels.size());
  for (size_t i = 0; i < report.levels.size(); ++i) {
    EXPECT_EQ(stream.levels[i].triangles, report.levels[i].triangles);
    EXPECT_EQ(stream.levels[i].bytes, report.levels[i].bytes);
    EXPECT_TRUE(stream.levels[i].available);
  }
}

TEST(Describe, BareStreamsAgreeWithTheirReport) {
  EncodeOptions options;
  options.target = {EncodeTarget::Kind::kPsnr, 45.0};
  for (const StreamForm form : {StreamForm::kDraco, StreamForm::kCustom}) {
    options.form = form;
    const auto encoded = EncodeMesh(WavySphere(13, 22), options);
    ASSERT_TRUE(encoded.ok()) << encoded.status().message();
    const auto info = DescribeStream(encoded.value().stream, {});
    ASSERT_TRUE(info.ok()) << info.status().message();
    ASSERT_EQ(info.value().levels.size(), encoded.value().report.levels.size());
    for (size_t i = 0; i < info.value().levels.size(); ++i) {
      EXPECT_EQ(info.value().levels[i].vertices, encoded.value().report.levels[i].vertices);
      EXPECT_EQ(info.value().levels[i].triangles, encoded.value().report.levels[i].triangles);
      EXPECT_EQ(info.value().levels[i].bytes, encoded.value().report.levels[i].bytes);
    }
    EXPECT_EQ(info.value().levels.back().bytes, encoded.value().stream.size());
  }
}

TEST(Unpack, LeavesWhatIsEmpty) {
  testing::AssetBuilder builder;
  builder.document().json["extensions"] = Json::object();
  builder.AddMesh("ball", Json::array({builder.Primitive(WavySphere(8, 12))}));
  const Json before = JsonOf(builder.Glb()), after = JsonOf(UnpackGltf(builder.Glb(), {}).value().glb);
  EXPECT_EQ(after["extensions"], Json::object());
  EXPECT_EQ(after["materials"], before["materials"]);
}

// Lattices and fits go beyond the values that were there, which core glTF does not allow.
TEST(Unpack, ColorsOfFloatsAreLegal) {
  testing::AssetBuilder builder;
  Json primitives = Json::array();
  for (VertexSoup half : shapes::HalvedTorus(64, 32)) {
    VertexSoup::Attribute colors{"COLOR_0", AttributeKind::kColor, 3, {}};
    for (const Vec3f& p : half.positions) {
      for (int axis = 0; axis < 3; ++axis) colors.values.push_back(std::clamp(0.5f + 0.9f * p[axis], 0.0f, 1.0f));
    }
    half.attributes.push_back(colors);
    primitives.push_back(testing::AddSoup(half, &builder));
  }
  builder.AddMesh("torus", std::move(primitives));
  for (const LevelChoice levels : {LevelChoice::kNever, LevelChoice::kAlways}) {
    PackOptions options;
    options.encode.target = {EncodeTarget::Kind::kPsnr, 60.0};
    options.encode.levels = levels;
    options.attributes.color = 0.01;
    const auto packed = PackGltf(builder.Glb(), options);
    ASSERT_TRUE(packed.ok()) << packed.status().message();
    const GltfDocument document = ParseGltf(UnpackGltf(packed.value().glb, {}).value().glb, "").value();
    float least = 1.0f, most = 0.0f;
    for (uint64_t part = 0; part < 2; ++part) {
      const Primitive primitive = ReadPrimitive(document, PrimitiveAt(document, {0, part}), {}).value();
      const Attribute* colors = primitive.Find("COLOR_0");
      ASSERT_NE(colors, nullptr);
      for (uint64_t v = 0; v < primitive.num_vertices; ++v) {
        for (uint32_t c = 0; c < 3; ++c) least = std::min(least, colors->data.Float(v, c)), most = std::max(most, colors->data.Float(v, c));
      }
    }
    EXPECT_GE(least, 0.0f) << packed.value().report.primitives[0].reason;
    EXPECT_LT(least, 0.01f);
    EXPECT_LE(most, 1.0f) << packed.value().report.primitives[0].reason;
    EXPECT_GT(most, 0.99f);
  }
}

// Streams interpolate tangents and their signs; glTF wants unit vectors and 1 or -1.
TEST(Unpack, TangentsOfStreamsAreLegal) {
  testing::AssetBuilder builder;
  Json primitives = Json::array();
  for (VertexSoup half : shapes::HalvedTorus(64, 32)) {
    VertexSoup::Attribute tangents{"TANGENT", AttributeKind::kTangent, 4, {}};
    for (const Vec3f& p : half.positions) {
      const Vec3f along = Normalized(Vec3f{-p.y, p.x, 0});
      tangents.values.insert(tangents.values.end(), {along.x, along.y, along.z, primitives.empty() ? 1.0f : -1.0f});
    }
    half.attributes.push_back(tangents);
    primitives.push_back(testing::AddSoup(half, &builder));
  }
  builder.AddMesh("torus", std::move(primitives));
  PackOptions options;
  options.encode.target = {EncodeTarget::Kind::kPsnr, 60.0};
  options.encode.levels = LevelChoice::kAlways;
  const auto packed = PackGltf(builder.Glb(), options);
  ASSERT_TRUE(packed.ok()) << packed.status().message();
  ASSERT_EQ(packed.value().report.primitives[0].storage, PrimitiveStorage::kProgressive) << packed.value().report.primitives[0].reason;
  const GltfDocument document = ParseGltf(UnpackGltf(packed.value().glb, {}).value().glb, "").value();
  for (uint64_t part = 0; part < 2; ++part) {
    const Primitive primitive = ReadPrimitive(document, PrimitiveAt(document, {0, part}), {}).value();
    const Attribute* tangents = primitive.Find("TANGENT");
    ASSERT_NE(tangents, nullptr);
    for (uint64_t v = 0; v < primitive.num_vertices; ++v) {
      const auto at = [&](uint32_t c) { return tangents->data.Float(v, c); };
      ASSERT_NEAR(Norm(Vec3f{at(0), at(1), at(2)}), 1.0f, 1e-5f);
      ASSERT_EQ(at(3), part == 0 ? 1.0f : -1.0f);
    }
  }
}

}  // namespace
}  // namespace lacerta
