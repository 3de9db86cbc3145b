// One surface in every form that glTF 2.0 has for it: each is packed within the same error, and all else stays.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <utility>

#include "document/draco_encode.h"
#include "document/gltf_document.h"
#include "document/primitive.h"
#include "gltf/test_assets.h"
#include "lacerta/file_io.h"
#include "lacerta/gltf.h"
#include "lacerta/surface_distance.h"

namespace lacerta {
namespace {

using testing::AssetBuilder;
using testing::JsonOf;
using testing::WavySphere;

const TriangleMesh& Ball() {
  static const TriangleMesh ball = WavySphere(24, 40);
  return ball;
}

PackOptions Fast() {
  PackOptions options;
  options.encode.effort = Effort::kFast;
  options.encode.target = {EncodeTarget::Kind::kPsnr, 60.0};
  return options;
}

// Packs and unpacks; the surface is the ball and takes a fourth of its bytes at most.
Bytes PackBall(const Bytes& asset, const std::string& folder = "") {
  PackOptions options = Fast();
  options.folder = folder;
  const auto packed = PackGltf(asset, options);
  EXPECT_TRUE(packed.ok()) << packed.status().message();
  if (!packed.ok()) return {};
  EXPECT_NE(packed.value().report.primitives[0].storage, PrimitiveStorage::kUntouched) << packed.value().report.primitives[0].reason;
  EXPECT_LT(packed.value().report.primitives[0].bytes_after, 12 * Ball().positions.size() / 4);
  const Bytes plain = UnpackGltf(packed.value().glb, {}).value().glb;
  const TriangleMesh surface = FlattenGltf(plain, {}).value().mesh;
  const double diagonal = SurfaceDistanceMeter::Create(Ball()).value().diagonal();
  EXPECT_GT(Psnr(MeasureSurfaceDistance(Ball(), surface).value().Rms(), diagonal), 59.5);
  return packed.value().glb;
}

Bytes Asset(const Json& primitive, AssetBuilder* builder) {
  builder->AddMesh("ball", Json::array({primitive}));
  return builder->Glb();
}

TEST(InputForms, NotIndexed) {
  std::vector<Vec3f> corners;
  for (const Triangle& t : Ball().triangles) {
    for (const uint32_t v : t) corners.push_back(Ball().positions[v]);
  }
  AssetBuilder builder;
  PackBall(Asset({{"attributes", {{"POSITION", builder.AddFloats(corners, true)}}}}, &builder));
}

// One strip through all triangles, joined by triangles without area.
TEST(InputForms, Strip) {
  TriangleMesh strip;
  strip.positions = Ball().positions;
  std::vector<uint32_t> corners;
  for (const Triangle& t : Ball().triangles) {
    if (!corners.empty()) corners.insert(corners.end(), {corners.back(), t[0]});
    if (corners.size() % 2 != 0) corners.push_back(t[0]);
    corners.insert(corners.end(), {t[0], t[1], t[2]});
  }
  while (corners.size() % 3 != 0) corners.push_back(corners.back());
  for (size_t i = 0; i < corners.size(); i += 3) strip.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  AssetBuilder builder;
  Json primitive = builder.Primitive(strip);
  primitive["mode"] = 5;
  const Bytes asset = Asset(primitive, &builder);
  const GltfDocument document = ParseGltf(asset, "").value();
  const Primitive read = ReadPrimitive(document, document.json["meshes"][0]["primitives"][0], DecodeLimits{}).value();
  size_t found = 0;  // each with its own side out, whichever corner comes first
  for (Triangle t : read.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (int turn = 0; turn < 3; ++turn, std::rotate(t.begin(), t.begin() + 1, t.end())) {
      found += std::find(Ball().triangles.begin(), Ball().triangles.end(), t) != Ball().triangles.end() ? 1 : 0;
    }
  }
  EXPECT_EQ(found, Ball().triangles.size());
  const Bytes packed = PackBall(asset);
  EXPECT_FALSE(JsonOf(packed)["meshes"][0]["primitives"][0].contains("mode"));
}

TEST(InputForms, Fan) {
  constexpr uint32_t kCorners = 6;
  TriangleMesh disc;
  disc.positions.push_back({0, 0, 0});
  for (uint32_t i = 0; i < kCorners; ++i) {
    const double angle = 2 * 3.141592653589793 * i / kCorners;
    disc.positions.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0});
  }
  disc.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 1, 0}};  // 0 to 6, back to 1, and once more to the middle
  AssetBuilder builder;
  Json primitive = builder.Primitive(disc);
  primitive["mode"] = 6;
  const GltfDocument document = ParseGltf(Asset(primitive, &builder), "").value();
  const Primitive read = ReadPrimitive(document, document.json["meshes"][0]["primitives"][0], DecodeLimits{}).value();
  EXPECT_EQ(read.triangles.size(), kCorners + 1);
  for (uint32_t i = 0; i + 1 < kCorners; ++i) EXPECT_EQ(read.triangles[i], (Triangle{i + 1, i + 2, 0}));
}

// Positions and something else in turns, at an offset.
TEST(InputForms, Strided) {
  Bytes interleaved(8, 0);
  for (const Vec3f& p : Ball().positions) {
    const float row[5] = {p.x, p.y, p.z, -7, -7};
    const auto* bytes = reinterpret_cast<const uint8_t*>(row);
    interleaved.insert(interleaved.end(), bytes, bytes + sizeof(row));
  }
  AssetBuilder builder;
  Json primitive = builder.Primitive(Ball());
  GltfDocument& document = builder.document();
  const uint64_t size = interleaved.size();
  const uint64_t view = AddBufferView(AddBuffer(std::move(interleaved), &document), 0, size, &document);
  document.json["bufferViews"][view]["byteStride"] = 20;
  Json& accessor = document.json["accessors"][primitive["attributes"]["POSITION"].get<size_t>()];
  accessor["bufferView"] = view;
  accessor["byteOffset"] = 8;
  PackBall(Asset(primitive, &builder));
}

TEST(InputForms, SparseOverNothing) {
  AssetBuilder builder;
  Json primitive = builder.Primitive(Ball());
  GltfDocument& document = builder.document();
  const AccessorData positions = MakeFloatAccessor(Ball().positions);
  const Json sparse = MakeSparseAccessors({{&positions, true}}, &document)[0];
  document.json["accessors"][primitive["attributes"]["POSITION"].get<size_t>()] = sparse;
  PackBall(Asset(primitive, &builder));
}

// KHR_mesh_quantization, with the scale of the node that undoes it.
TEST(InputForms, Normalized) {
  constexpr float kLargest = 1.2f;
  AccessorData quantized{ComponentType::kInt16, 3, true, Ball().positions.size(), {}};
  for (const Vec3f& p : Ball().positions) {
    for (const float x : {p.x, p.y, p.z}) {
      const auto k = static_cast<int16_t>(std::lround(x / kLargest * 32767.0f));
      quantized.bytes.push_back(static_cast<uint8_t>(k & 0xff));
      quantized.bytes.push_back(static_cast<uint8_t>(k >> 8 & 0xff));
    }
  }
  AssetBuilder builder;
  Json primitive = builder.Primitive(Ball());
  GltfDocument& document = builder.document();
  const Json accessor = MakeAccessor(quantized, AccessorUse::kAttribute, true, &document);
  document.json["accessors"][primitive["attributes"]["POSITION"].get<size_t>()] = accessor;
  document.json["extensionsUsed"] = document.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  builder.AddMesh("ball", Json::array({primitive}));
  document.json["nodes"][0]["scale"] = {kLargest, kLargest, kLargest};
  PackBall(builder.Glb());
}

TEST(InputForms, DracoOfOthers) {
  Primitive ball;
  ball.num_vertices = Ball().positions.size();
  ball.triangles = Ball().triangles;
  ball.attributes.push_back({"POSITION", MakeFloatAccessor(Ball().positions)});
  const DracoEncoded encoded = EncodeDracoPrimitive(ball, {PositionLattice({-2, -2, -2}, {2, 2, 2}, 14), {}, 0}).value();
  AssetBuilder builder;
  GltfDocument& document = builder.document();
  Json positions = DescribeAccessor(encoded.decoded.attributes[0].data, true);
  Json indices = DescribeAccessor(MakeIndexAccessor(encoded.decoded.triangles, encoded.decoded.num_vertices), false);
  const uint64_t view = AddBufferView(AddBuffer(encoded.bytes, &document), 0, encoded.bytes.size(), &document);
  const Json draco = {{"bufferView", view}, {"attributes", {{"POSITION", encoded.ids[0].id}}}};
  document.json["extensionsUsed"] = document.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const Json primitive = {{"attributes", {{"POSITION", AddAccessor(std::move(positions), &document)}}},
                          {"indices", AddAccessor(std::move(indices), &document)},
                          {"extensions", {{"KHR_draco_mesh_compression", draco}}}};
  PackBall(Asset(primitive, &builder));
}

// A .gltf with two buffers and a picture, each a file of its own, one of them of a name that URIs escape.
TEST(InputForms, FilesBesideTheAsset) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "lacerta_input_forms";
  std::filesystem::create_directories(folder);
  AssetBuilder builder;
  builder.AddMesh("ball", Json::array({builder.Primitive(Ball())}));
  GltfDocument& document = builder.document();
  ASSERT_EQ(document.buffers.size(), 2u);
  const char* const names[] = {"its positions.bin", "indices.bin"};
  const char* const uris[] = {"its%20positions.bin", "indices.bin"};
  for (size_t b = 0; b < 2; ++b) {
    ASSERT_TRUE(WriteFileAtomically((folder / names[b]).string(), document.buffers[b]).ok());
    document.json["buffers"][b]["uri"] = uris[b];
  }
  document.json["images"] = {{{"uri", "no picture that anybody reads.png"}}};
  const std::string text = document.json.dump();
  const Bytes packed = PackBall(Bytes(text.begin(), text.end()), folder.string());
  const Json json = JsonOf(packed);
  EXPECT_EQ(json["images"], document.json["images"]);
  EXPECT_EQ(json["buffers"].size(), 1u);
  EXPECT_FALSE(json["buffers"][0].contains("uri"));
  std::filesystem::remove_all(folder);
}

TEST(InputForms, SeveralScenesWithAllThatTheyShow) {
  AssetBuilder builder;
  builder.AddMesh("ball", Json::array({builder.Primitive(Ball())}));
  Json& json = builder.document().json;
  json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
  json["nodes"].push_back({{"camera", 0}, {"translation", {0, 0, 3}}});
  json["nodes"].push_back({{"mesh", 0}, {"translation", {5, 0, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  json["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}}}}}}};
  json["extensionsUsed"] = {"KHR_lights_punctual"};
  json["scenes"] = {{{"nodes", {0}}}, {{"name", "other"}, {"nodes", {1, 2}}}};
  const Json before = JsonOf(builder.Glb());
  const Bytes packed = PackBall(builder.Glb());
  const Json after = JsonOf(UnpackGltf(packed, {}).value().glb);
  for (const char* key : {"scenes", "scene", "nodes", "cameras", "extensions", "extensionsUsed"}) EXPECT_EQ(after[key], before[key]) << key;
}

}  // namespace
}  // namespace lacerta
