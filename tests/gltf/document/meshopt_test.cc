#include "document/meshopt.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#ifdef LACERTA_HAVE_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

#include <cstring>
#include <optional>

#include "document/buffer_edit.h"
#include "document/merge_buffers.h"
#include "gltf/test_assets.h"
#include "lacerta/file_io.h"
#include "lacerta/gltf.h"

namespace lacerta {
namespace {

using ::testing::HasSubstr;

#ifdef LACERTA_HAVE_MESHOPTIMIZER

// An asset whose positions and indices are compressed, with the fallback buffer that the extension asks for.
GltfDocument Compressed(const TriangleMesh& mesh, const char* name) {
  std::vector<float> positions;
  for (const Vec3f& p : mesh.positions) positions.insert(positions.end(), {p.x, p.y, p.z});
  std::vector<uint32_t> indices;
  for (const Triangle& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  Bytes vertices(meshopt_encodeVertexBufferBound(mesh.positions.size(), 12));
  vertices.resize(
      meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), positions.data(), mesh.positions.size(), 12));
  Bytes triangles(meshopt_encodeIndexBufferBound(indices.size(), mesh.positions.size()));
  triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), indices.size()));
  GltfDocument document;
  const Json fallback = {{"byteLength", 12 * mesh.positions.size() + 4 * indices.size()},
                         {"extensions", {{name, {{"fallback", true}}}}}};
  document.json = {
      {"asset", {{"version", "2.0"}}},
      {"extensionsUsed", {name}},
      {"extensionsRequired", {name}},
      {"buffers", Json::array({{{"byteLength", vertices.size()}}, {{"byteLength", triangles.size()}}, fallback})},
      {"bufferViews",
       {{{"buffer", 2},
         {"byteOffset", 0},
         {"byteLength", 12 * mesh.positions.size()},
         {"byteStride", 12},
         {"extensions",
          {{name,
            {{"buffer", 0},
             {"byteLength", vertices.size()},
             {"byteStride", 12},
             {"count", mesh.positions.size()},
             {"mode", "ATTRIBUTES"}}}}}},
        {{"buffer", 2},
         {"byteOffset", 12 * mesh.positions.size()},
         {"byteLength", 4 * indices.size()},
         {"extensions",
          {{name,
            {{"buffer", 1},
             {"byteLength", triangles.size()},
             {"byteStride", 4},
             {"count", indices.size()},
             {"mode", "TRIANGLES"}}}}}}}},
      {"accessors",
       {{{"bufferView", 0}, {"componentType", 5126}, {"count", mesh.positions.size()}, {"type", "VEC3"}},
        {{"bufferView", 1}, {"componentType", 5125}, {"count", indices.size()}, {"type", "SCALAR"}}}},
      {"meshes",
       Json::array({{{"primitives", Json::array({{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}})}}})}};
  document.buffers = {vertices, triangles, Bytes()};
  return document;
}

TEST(Meshopt, DecodesViewsAndForgetsTheExtensionWhereACopyIsNotCompressed) {
  const TriangleMesh mesh = testing::WavySphere(8, 12);
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    GltfDocument document = Compressed(mesh, name);
    document.json.erase("extensionsRequired");
    const Status status = DecodeMeshoptViews(&document);
    ASSERT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(document.json.dump().find("meshopt"), std::string::npos);
    EXPECT_FALSE(document.json.contains("extensionsRequired"));
    const AccessorData positions = ReadAccessor(document, 0).value();
    EXPECT_EQ(positions.bytes, MakeFloatAccessor(mesh.positions).bytes);
    EXPECT_EQ(ReadAccessor(document, 1).value().count, 3 * mesh.triangles.size());
  }
}

Bytes CompressedAt(const GltfDocument& document, uint64_t view) {
  const std::optional<CompressedBytes> place = FindCompressedBytes(document, view);
  if (!place.has_value()) return {};
  const auto begin = document.buffers[static_cast<size_t>(place->buffer)].begin() + static_cast<std::ptrdiff_t>(place->offset);
  return Bytes(begin, begin + static_cast<std::ptrdiff_t>(place->length));
}

TEST(Meshopt, WhatStaysIsStoredAsItCame) {
  const TriangleMesh mesh = testing::WavySphere(8, 12);
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    GltfDocument document = Compressed(mesh, name);
    const Bytes positions = CompressedAt(document, 0), indices = CompressedAt(document, 1);
    ASSERT_TRUE(DecodeMeshoptViews(&document).ok());
    EXPECT_LT(CompressedShare(document, 1).value(), 0.5);
    EXPECT_EQ(ReadAccessor(document, 0).value().bytes, MakeFloatAccessor(mesh.positions).bytes);
    for (int round = 0; round < 2; ++round) {
      ASSERT_TRUE(MergeBuffers(&document).ok());
      const Bytes glb = FormatGlb(document);
      EXPECT_LT(glb.size(), positions.size() + indices.size() + 1500);  // JSON
      document = ParseGltf(glb, "").value();
      EXPECT_EQ(CompressedAt(document, 0), positions);
      EXPECT_EQ(CompressedAt(document, 1), indices);
      EXPECT_EQ(document.json["extensionsRequired"], Json::array({name}));
      EXPECT_EQ(ReadAccessor(document, 0).value().bytes, MakeFloatAccessor(mesh.positions).bytes);
      EXPECT_EQ(ReadAccessor(document, 1).value().count, 3 * mesh.triangles.size());
    }
  }
}

TEST(Meshopt, OfWhatIsMostlyGoneTheRestIsStoredUncompressed) {
  const TriangleMesh mesh = testing::WavySphere(8, 12);
  GltfDocument document = Compressed(mesh, "EXT_meshopt_compression");
  ASSERT_TRUE(DecodeMeshoptViews(&document).ok());
  const Bytes before = ReadAccessor(document, 0).value().bytes;
  document.json["accessors"][0]["count"] = 3;
  document.json["accessors"][0]["byteOffset"] = 24;
  ASSERT_TRUE(MergeBuffers(&document).ok());
  const GltfDocument after = ParseGltf(FormatGlb(document), "").value();
  EXPECT_FALSE(FindCompressedBytes(after, 0).has_value());
  EXPECT_TRUE(FindCompressedBytes(after, 1).has_value());
  EXPECT_EQ(after.json["bufferViews"][0]["byteLength"], 36);
  EXPECT_EQ(ReadAccessor(after, 0).value().bytes, Bytes(before.begin() + 24, before.begin() + 60));
}

TEST(Meshopt, NothingIsDeclaredThatNoViewHas) {
  GltfDocument document = Compressed(testing::WavySphere(8, 12), "EXT_meshopt_compression");
  ASSERT_TRUE(DecodeMeshoptViews(&document).ok());
  document.json["accessors"] = Json::array();
  DropUnusedViews({0, 1}, &document);
  ASSERT_TRUE(MergeBuffers(&document).ok());
  EXPECT_EQ(document.json.dump().find("meshopt"), std::string::npos);
}

// A family is held to the bytes that it takes compressed, and what stays is not decoded for good.
TEST(Meshopt, NoAssetGrows) {
  GltfDocument document = Compressed(testing::WavySphere(8, 12), "EXT_meshopt_compression");
  document.json["meshes"][0]["primitives"][0]["mode"] = 0;
  ASSERT_TRUE(DecodeMeshoptViews(&document).ok());
  ASSERT_TRUE(MergeBuffers(&document).ok());
  const Bytes glb = FormatGlb(document);
  const auto packed = PackGltf(glb, {});
  ASSERT_TRUE(packed.ok()) << packed.status().message();
  EXPECT_EQ(packed.value().report.primitives[0].storage, PrimitiveStorage::kUntouched);
  EXPECT_EQ(packed.value().glb, glb);
}

// The buffer that is not written stands between the GLB's and that of the refinements.
TEST(Meshopt, GoesTogetherWithRefinementsInAFileOfTheirOwn) {
  const TriangleMesh stays = testing::WavySphere(8, 12), ball = testing::WavySphere(13, 22);
  GltfDocument document = Compressed(stays, "EXT_meshopt_compression");
  document.json["meshes"][0]["primitives"][0]["mode"] = 0;
  Json primitive = {{"attributes", Json::object()}};
  primitive["attributes"]["POSITION"] =
      AddAccessor(MakeAccessor(MakeFloatAccessor(ball.positions), AccessorUse::kAttribute, true, &document), &document);
  primitive["indices"] = AddAccessor(
      MakeAccessor(MakeIndexAccessor(ball.triangles, ball.positions.size()), AccessorUse::kIndices, false, &document), &document);
  document.json["meshes"].push_back({{"primitives", Json::array({primitive})}});
  ASSERT_TRUE(DecodeMeshoptViews(&document).ok());
  ASSERT_TRUE(MergeBuffers(&document).ok());
  PackOptions options;
  options.encode.target = {EncodeTarget::Kind::kPsnr, 45.0};
  options.encode.levels = LevelChoice::kAlways;
  options.external_uri = "refinements.bin";
  const auto packed = PackGltf(FormatGlb(document), options);
  ASSERT_TRUE(packed.ok()) << packed.status().message();
  EXPECT_FALSE(packed.value().external.empty());
  const Json json = testing::JsonOf(packed.value().glb);
  ASSERT_GE(json["buffers"].size(), 3u);  // and what was decoded to be read
  EXPECT_FALSE(json["buffers"][1].contains("uri"));
  EXPECT_EQ(json["buffers"][2]["uri"], "refinements.bin");
  const GltfDocument after = ParseGltf(packed.value().glb, "").value();
  EXPECT_TRUE(FindCompressedBytes(after, 0).has_value());
  EXPECT_EQ(ReadAccessor(after, 0).value().bytes, MakeFloatAccessor(stays.positions).bytes);
  for (const bool whole : {false, true}) {  // the base alone, and all levels
    UnpackOptions unpack;
    if (whole) {
      unpack.folder = ::testing::TempDir();
      ASSERT_TRUE(WriteFileAtomically(unpack.folder + "/refinements.bin", packed.value().external).ok());
    }
    const auto unpacked = UnpackGltf(packed.value().glb, unpack);
    ASSERT_TRUE(unpacked.ok()) << unpacked.status().message();
    const GltfDocument plain = ParseGltf(unpacked.value().glb, "").value();
    EXPECT_EQ(ReadAccessor(plain, 0).value().bytes, MakeFloatAccessor(stays.positions).bytes);
    const uint64_t count = ReadAccessor(plain, plain.json["meshes"][1]["primitives"][0]["indices"]).value().count;
    EXPECT_EQ(count == 3 * packed.value().report.primitives[1].encode.levels.back().triangles, whole);
  }
}

TEST(Meshopt, RefusesWhatItsStreamCannotHold) {
  const TriangleMesh mesh = testing::WavySphere(8, 12);
  const auto message = [&](size_t view, const char* key, const Json& value) {
    GltfDocument document = Compressed(mesh, "EXT_meshopt_compression");
    document.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"][key] = value;
    const Status status = DecodeMeshoptViews(&document);
    EXPECT_FALSE(status.ok()) << key << value;
    EXPECT_THAT(status.message(), HasSubstr("bufferView " + std::to_string(view)));
    return status.message();
  };
  EXPECT_THAT(message(0, "count", 4000000000u), HasSubstr("cannot hold"));
  EXPECT_THAT(message(0, "count", 18446744073709551615u), HasSubstr("cannot hold"));
  EXPECT_THAT(message(0, "byteStride", 6), HasSubstr("byteStride"));
  EXPECT_THAT(message(0, "byteStride", 0), HasSubstr("byteStride"));
  EXPECT_THAT(message(0, "byteLength", 100000000), HasSubstr("truncated"));
  EXPECT_THAT(message(0, "buffer", 9), HasSubstr("buffer 9"));
  EXPECT_THAT(message(0, "filter", "OCTAHEDRAL"), HasSubstr("filter"));
  EXPECT_THAT(message(0, "mode", "POINTS"), HasSubstr("mode"));
  EXPECT_THAT(message(0, "byteLength", 40), HasSubstr("damaged"));
  EXPECT_THAT(message(1, "count", 100), HasSubstr("multiple of 3"));
  EXPECT_THAT(message(1, "byteStride", 12), HasSubstr("byteStride"));
}

// A small file of many views of the same bytes would fill the memory.
TEST(Meshopt, RefusesViewsThatShareTheirBytes) {
  const auto message = [](size_t num_views) {
    GltfDocument document = Compressed(testing::WavySphere(32, 48), "EXT_meshopt_compression");
    const Json view = document.json["bufferViews"][0];
    while (document.json["bufferViews"].size() < num_views) document.json["bufferViews"].push_back(view);
    return DecodeMeshoptViews(&document).message();
  };
  EXPECT_EQ(message(5), "");  // sharing as such is harmless
  EXPECT_THAT(message(500), HasSubstr("overlap"));
}

#else

TEST(Meshopt, IsRefusedByName) {
  GltfDocument document;
  document.json["bufferViews"] = Json::array({{{"extensions", {{"EXT_meshopt_compression", Json::object()}}}}});
  EXPECT_THAT(DecodeMeshoptViews(&document).message(), HasSubstr("no meshoptimizer"));
}

#endif

}  // namespace
}  // namespace lacerta
