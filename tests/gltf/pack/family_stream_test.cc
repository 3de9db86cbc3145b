// Streams that carry attributes and groups, from packing to what readers show.
#include "pack/family_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "document/place.h"
#include "document/primitive.h"
#include "gltf/borders.h"
#include "gltf/test_assets.h"
#include "gltf/torus_asset.h"
#include "lacerta/parsed_gltf.h"
#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

using ::testing::HasSubstr;
using testing::BorderEdges;
using testing::JsonOf;
using testing::Torus;

const PackResult& Packed() { return testing::PackedTorus(); }

std::vector<Primitive> ReadAll(const Bytes& glb) {
  const GltfDocument document = ParseGltf(glb, "").value();
  std::vector<Primitive> primitives;
  for (uint64_t p = 0; p < 2; ++p) primitives.push_back(ReadPrimitive(document, PrimitiveAt(document, {0, p}), {}).value());
  return primitives;
}

TEST(FamilyStream, OneStreamHoldsBothHalves) {
  const PackResult& packed = Packed();
  const Json json = JsonOf(packed.glb);
  ASSERT_EQ(packed.report.primitives[0].storage, PrimitiveStorage::kProgressive) << packed.report.primitives[0].reason;
  const Json& extension = json["extensions"]["LACERTA_mesh_progressive"];
  ASSERT_EQ(extension["streams"].size(), 1u);
  EXPECT_EQ(extension["streams"][0u]["baseLengths"].size(), 2u);
  EXPECT_EQ(extension["streams"][0u]["attributes"].size(), 2u);
  EXPECT_GE(extension["streams"][0u]["errors"].size(), 3u);
  for (uint64_t p = 0; p < 2; ++p) {
    EXPECT_EQ(packed.report.primitives[p].storage, PrimitiveStorage::kProgressive);
    const Json& primitive = json["meshes"][0u]["primitives"][p];
    EXPECT_EQ(primitive["extensions"]["LACERTA_mesh_progressive"]["stream"], 0);
    EXPECT_EQ(primitive["extensions"]["LACERTA_mesh_progressive"]["group"], p);
    EXPECT_EQ(primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"].size(), 3u);
    EXPECT_EQ(primitive["material"], 0);
    for (const AttributeReport& attribute : packed.report.primitives[p].attributes) {
      EXPECT_GT(attribute.error, 0.0);
      EXPECT_LE(attribute.error, attribute.unit == "texels" ? 1.0 : 2.0);
    }
  }
  EXPECT_LT(packed.glb.size() * 5, Torus().size());

  const EncodeReport& encode = packed.report.primitives[0].encode;
  EXPECT_EQ(packed.report.primitives[1].encode.levels.size(), encode.levels.size());
  ASSERT_EQ(encode.levels.size(), extension["streams"][0u]["errors"].size());
  for (size_t level = 1; level < encode.levels.size(); ++level) {
    EXPECT_GE(encode.levels[level].bytes, encode.levels[level - 1].bytes);  // the finest may take none
    EXPECT_GT(encode.levels[level].psnr, encode.levels[level - 1].psnr);
  }
  EXPECT_GT(encode.levels[1].bytes, encode.levels[0].bytes);
  EXPECT_EQ(encode.levels.back().bytes, packed.report.primitives[0].bytes_after + packed.report.primitives[1].bytes_after);
  EXPECT_GT(encode.remesh_psnr, encode.levels.back().psnr);
  EXPECT_LT(encode.remesh_psnr, encode.levels.back().psnr + 40);
  EXPECT_GT(encode.measurements, 1);
}

TEST(FamilyStream, EveryLevelIsWholeAndBetterThanTheOneBefore) {
  const Bytes original = Torus();
  const std::vector<Primitive> before = ReadAll(original);
  const FamilyMeter meter({&before[0], &before[1]}, 1e-3, {}, 1024, [](size_t, uint64_t) { return 1024.0; });
  const int num_levels = ReadProgressive(Packed().glb, {}).value()[0].num_levels;
  double last_error = 1e9;
  for (int level = 0; level <= num_levels; ++level) {
    UnpackOptions options;
    options.level = level;
    const auto unpacked = UnpackGltf(Packed().glb, options);
    ASSERT_TRUE(unpacked.ok()) << unpacked.status().message();
    EXPECT_TRUE(unpacked.value().notes.empty());
    EXPECT_FALSE(JsonOf(unpacked.value().glb).contains("extensionsUsed"));
    // The torus is closed: any crack between the halves or along a seam of the texture would show.
    EXPECT_TRUE(BorderEdges(FlattenGltf(unpacked.value().glb, {}).value().mesh).empty()) << level;
    const std::vector<Primitive> after = ReadAll(unpacked.value().glb);
    const SurfaceErrors errors = meter.Measure({&after[0], &after[1]}).value();
    EXPECT_LT(errors.distance, last_error);
    last_error = errors.distance;
    if (level < num_levels) continue;
    for (size_t a = 0; a < errors.attributes.size(); ++a) EXPECT_LE(errors.attributes[a].rms_99, meter.targets().attributes[a] * 1.02);
  }
}

TEST(FamilyStream, TrimmedAssetsStayLegalAndSmaller) {
  ValidateOptions validate;
  const Bytes original = Torus();
  validate.original = original;
  const ValidationReport whole = ValidateGltf(Packed().glb, validate);
  EXPECT_TRUE(whole.IsValid()) << (whole.issues.empty() ? "" : whole.issues[0].message);
  size_t last = Packed().glb.size() + 1;
  for (int level = ReadProgressive(Packed().glb, {}).value()[0].num_levels; level >= 0; --level) {
    TrimOptions trim;
    trim.level = level;
    const Bytes glb = TrimGltf(Packed().glb, trim).value().glb;
    // A level without bytes comes with the one before.
    const std::vector<LevelReport>& levels = Packed().report.primitives[0].encode.levels;
    auto shown = static_cast<size_t>(level);
    while (shown + 1 < levels.size() && levels[shown + 1].bytes == levels[shown].bytes) ++shown;
    EXPECT_EQ(glb.size() < last, shown == static_cast<size_t>(level));
    last = glb.size();
    const ValidationReport report = ValidateGltf(glb, {});
    EXPECT_TRUE(report.IsValid()) << level << (report.issues.empty() ? "" : report.issues[0].message);
    const auto surfaces = ReadProgressive(glb, {});
    ASSERT_TRUE(surfaces.ok());
    ASSERT_EQ(surfaces.value().size(), 2u);
    EXPECT_EQ(surfaces.value()[1].level, static_cast<int>(shown));
    EXPECT_FALSE(surfaces.value()[1].from_fallback);
    EXPECT_EQ(surfaces.value()[1].attributes.size(), 2u);
  }
}

TEST(FamilyStream, HostsGetTheAttributes) {
  const GltfDocument document = ParseGltf(Packed().glb, "").value();
  std::vector<Span<const uint8_t>> buffers;
  for (const Bytes& buffer : document.buffers) buffers.push_back(buffer);
  const auto geometries = RefineParsedGltf(document.json.dump(), buffers, {});
  ASSERT_TRUE(geometries.ok()) << geometries.status().message();
  ASSERT_EQ(geometries.value().size(), 2u);
  for (const RefinedGeometry& geometry : geometries.value()) {
    EXPECT_FALSE(geometry.from_fallback) << geometry.note;
    EXPECT_EQ(geometry.normals.size(), 12 * geometry.num_vertices);
    ASSERT_EQ(geometry.attributes.size(), 1u);
    EXPECT_EQ(geometry.attributes[0].name, "TEXCOORD_0");
    EXPECT_EQ(geometry.attributes[0].values.size(), 8 * geometry.num_vertices);
  }
}

TEST(FamilyStream, WhatDoesNotFitFallsBackAndSaysSo) {
  const auto with = [&](const std::string& pointer, const Json& value) {
    GltfDocument document = ParseGltf(Packed().glb, "").value();
    document.json[Json::json_pointer(pointer)] = value;
    return ReadProgressive(FormatGlb(document), {});
  };
  const std::string stream = "/extensions/LACERTA_mesh_progressive/streams/0";
  const std::string primitive = "/meshes/0/primitives/1/extensions/LACERTA_mesh_progressive";
  const struct {
    std::string pointer;
    Json value;
    std::string says;
  } kEdits[] = {{primitive + "/group", 2, "group 2"},
                {primitive + "/group", 0, "edited"},
                {stream + "/attributes", Json::array({"NORMAL"}), "attributes"},
                {stream + "/baseLengths", Json::array({1, 2}), "add up"},
                {stream + "/baseLengths", Json::array(), "baseLengths"},
                {stream + "/vertexCounts/1", 5, "size"}};
  for (const auto& edit : kEdits) {
    const auto surfaces = with(edit.pointer, edit.value);
    ASSERT_TRUE(surfaces.ok()) << edit.pointer;
    const ProgressiveSurface& surface = surfaces.value()[1];
    const bool coarse = edit.says == "size";
    EXPECT_TRUE(surface.from_fallback || coarse) << edit.pointer;
    if (!coarse) {
      EXPECT_THAT(surface.note, HasSubstr(edit.says)) << edit.pointer;
    }
  }
}

TEST(FamilyStream, DamagedBytesNeverCrash) {
  std::mt19937 random(7);
  for (int i = 0; i < 60; ++i) {
    Bytes mutant = Packed().glb;
    for (int change = 0; change < 3; ++change) mutant[random() % mutant.size()] ^= static_cast<uint8_t>(1u << random() % 8);
    if (i % 4 == 0) mutant.resize(random() % mutant.size());
    const auto surfaces = ReadProgressive(mutant, {});
    if (!surfaces.ok()) continue;
    for (const ProgressiveSurface& surface : surfaces.value()) {
      for (const VertexSoup::Attribute& attribute : surface.attributes) {
        EXPECT_EQ(attribute.values.size(), attribute.components * surface.surface.positions.size());
      }
    }
  }
}

TEST(FamilyStream, NoStreamWithoutAReason) {
  const VertexSoup box = shapes::TexturedBox(4);  // all seams
  Primitive primitive{box.positions.size(), box.triangles, {{"POSITION", MakeFloatAccessor(box.positions)}}};
  const FamilyMeter meter({&primitive}, 1e-3, {}, 1024, [](size_t, uint64_t) { return 1024.0; });
  const auto small = StreamFamily(meter, Effort::kNormal);
  EXPECT_EQ(small.status().code(), StatusCode::kUnsupported);
  EXPECT_FALSE(small.status().message().empty());
  primitive.attributes.push_back({"_MINE", MakeFloatAccessor(std::vector<float>(primitive.num_vertices, 3.0f), 1)});
  const FamilyMeter with_other({&primitive}, 1e-3, {}, 1024, [](size_t, uint64_t) { return 1024.0; });
  EXPECT_THAT(StreamFamily(with_other, Effort::kNormal).status().message(), HasSubstr("interpolated"));
}

}  // namespace
}  // namespace lacerta
