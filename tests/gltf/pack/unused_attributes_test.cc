#include "pack/unused_attributes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "document/place.h"
#include "gltf/test_assets.h"
#include "lacerta/gltf.h"

namespace lacerta {
namespace {

using testing::AssetBuilder;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::WavySphere;

// A document whose mesh 0 has a primitive of that material, and mesh 1 one of that and a variant.
GltfDocument WithMaterial(const std::string& material) {
  GltfDocument document;
  document.json = Json::parse(R"({"nodes": [{"mesh": 0}, {"mesh": 1}], "materials": [{"name": "plain"}, )" + material + R"(], "meshes": [
      {"primitives": [{"attributes": {"POSITION": 0}, "material": 1}]},
      {"primitives": [{"attributes": {"POSITION": 0}, "material": 0,
                       "extensions": {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}}}]}]})");
  return document;
}

bool IsUnused(const GltfDocument& document, uint64_t mesh, const std::string& name) { return IsUnused(document, {{mesh, 0}}, name); }

TEST(UnusedAttributes, TextureCoordinatesAreUsedByTheTexturesOfTheirSet) {
  for (const char* material :
       {R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}}})", R"({"emissiveTexture": {"index": 3, "texCoord": 1}})",
        R"({"extensions": {"KHR_materials_sheen": {"sheenColorTexture": {"index": 0, "texCoord": 1}}}})",
        R"({"occlusionTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"texCoord": 1}}}})"}) {
    const GltfDocument document = WithMaterial(material);
    for (const uint64_t mesh : {0u, 1u}) {
      EXPECT_FALSE(IsUnused(document, mesh, "TEXCOORD_1")) << material;
      EXPECT_TRUE(IsUnused(document, mesh, "TEXCOORD_0")) << material;
      EXPECT_TRUE(IsUnused(document, mesh, "TEXCOORD_2")) << material;
    }
  }
  EXPECT_TRUE(IsUnused(WithMaterial(R"({"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}})"), 0, "TEXCOORD_0"));
}

TEST(UnusedAttributes, AnyOfThePlacesThatShareVerticesMayUseThem) {
  GltfDocument document = WithMaterial(R"({"emissiveTexture": {"index": 0}})");
  document.json["meshes"][1]["primitives"][0].erase("extensions");
  EXPECT_TRUE(IsUnused(document, 1, "TEXCOORD_0"));
  EXPECT_FALSE(IsUnused(document, {{1, 0}, {0, 0}}, "TEXCOORD_0"));
}

TEST(UnusedAttributes, TangentsAreUsedByNormalMapsAndAnisotropy) {
  for (const char* material : {R"({"normalTexture": {"index": 0}})", R"({"extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.5}}})",
                               R"({"extensions": {"KHR_materials_clearcoat": {"clearcoatNormalTexture": {"index": 1}}}})"}) {
    EXPECT_FALSE(IsUnused(WithMaterial(material), 0, "TANGENT")) << material;
  }
  EXPECT_TRUE(IsUnused(WithMaterial(R"({"emissiveTexture": {"index": 0}})"), 0, "TANGENT"));
}

TEST(UnusedAttributes, TangentsAreDerivableWhereNormalMapsAreLaidByCoordinatesThatAreThere) {
  const auto are_derivable = [](const std::string& material, std::vector<Place> places) {
    GltfDocument document = WithMaterial(material);
    for (Json& mesh : document.json["meshes"]) mesh["primitives"][0]["attributes"]["TEXCOORD_1"] = 1;
    return AreTangentsDerivable(document, places);
  };
  const std::string first = R"({"normalTexture": {"index": 0}})", second = R"({"normalTexture": {"index": 0, "texCoord": 1}})";
  EXPECT_TRUE(are_derivable(second, {{0, 0}}));
  EXPECT_TRUE(are_derivable(second, {{1, 0}}));
  EXPECT_FALSE(are_derivable(first, {{0, 0}}));
  EXPECT_FALSE(are_derivable(first, {{1, 0}})) << "by a variant's material";
  EXPECT_TRUE(are_derivable(R"({"emissiveTexture": {"index": 0}})", {{0, 0}}));
  EXPECT_FALSE(are_derivable(R"({"normalTexture": {"index": 0, "texCoord": 1}, "extensions": {"KHR_materials_anisotropy": {}}})", {{0, 0}}));
}

TEST(UnusedAttributes, NormalsAreUsedByLight) {
  const char* const unlit = R"({"normalTexture": {"index": 0}, "extensions": {"KHR_materials_unlit": {}}})";
  for (const char* name : {"NORMAL", "TANGENT"}) {
    EXPECT_TRUE(IsUnused(WithMaterial(unlit), 0, name)) << name;
    EXPECT_FALSE(IsUnused(WithMaterial(unlit), 1, name)) << "its other material is lit: " << name;
    GltfDocument bare = WithMaterial(unlit);
    bare.json["meshes"][0]["primitives"][0].erase("material");
    EXPECT_EQ(IsUnused(bare, 0, name), name == std::string("TANGENT")) << "the default material is lit, and has no normal map";
  }
  EXPECT_FALSE(IsUnused(WithMaterial(R"({"normalTexture": {"index": 0}})"), 0, "NORMAL"));
  EXPECT_FALSE(IsUnused(WithMaterial(R"({"extensions": {"KHR_materials_unlit": {}, "VRMC_materials_mtoon": {}}})"), 0, "NORMAL"));
  GltfDocument avatar = WithMaterial(unlit);
  avatar.json["extensionsUsed"] = {"VRM"};
  EXPECT_FALSE(IsUnused(avatar, 0, "NORMAL"));
}

TEST(UnusedAttributes, WeightsAreUsedBySkins) {
  GltfDocument document = WithMaterial("{}");
  document.json["nodes"][1]["skin"] = 0;
  for (const char* name : {"JOINTS_0", "WEIGHTS_1"}) {
    EXPECT_TRUE(IsUnused(document, 0, name)) << name;
    EXPECT_FALSE(IsUnused(document, 1, name)) << name;
  }
}

TEST(UnusedAttributes, WhatEveryReaderShowsOrNobodyKnowsIsUsed) {
  const GltfDocument document = WithMaterial("{}");
  for (const char* name : {"POSITION", "NORMAL", "COLOR_0", "_FORCE", "TEXCOORD_", "TEXCOORD_x", "COLOR_99999999999999999999"}) {
    EXPECT_FALSE(IsUnused(document, 0, name)) << name;
  }
  EXPECT_TRUE(IsUnused(document, 0, "COLOR_1"));
}

TEST(UnusedAttributes, AvatarsNameTexturesOutsideOfMaterials) {
  GltfDocument document = WithMaterial("{}");
  document.json["extensionsUsed"] = {"VRM"};
  EXPECT_FALSE(IsUnused(document, 0, "TEXCOORD_0"));
}

// A ball with texture coordinates all over the place, whose material `texture` shows or not; a target moves it where `moves`. With tangents, too, where a
// normal map is laid by `normal_map_set`.
Bytes BallWithTexCoords(bool is_textured, bool moves, int normal_map_set = -1) {
  const TriangleMesh ball = WavySphere(24, 40);
  std::vector<float> texcoords, tangents;
  for (size_t v = 0; v < ball.positions.size(); ++v) {
    const auto number = static_cast<float>(v);
    texcoords.insert(texcoords.end(), {std::fmod(0.37f * number, 1.0f), std::fmod(0.61f * number, 1.0f)});
    tangents.insert(tangents.end(), {std::cos(number), std::sin(number), 0.0f, 1.0f});
  }
  AssetBuilder builder;
  GltfDocument& document = builder.document();
  Json primitive = builder.Primitive(ball);
  primitive["attributes"]["TEXCOORD_0"] = AddAccessor(MakeAccessor(MakeFloatAccessor(texcoords, 2), AccessorUse::kAttribute, false, &document), &document);
  if (normal_map_set >= 0) {
    primitive["attributes"]["TANGENT"] = AddAccessor(MakeAccessor(MakeFloatAccessor(tangents, 4), AccessorUse::kAttribute, false, &document), &document);
  }
  if (moves) {
    const uint64_t offsets = builder.AddFloats(std::vector<Vec3f>(ball.positions.size(), {0, 0, 0.5f}), true);
    primitive["targets"] = Json::array({{{"POSITION", offsets}, {"TEXCOORD_0", primitive["attributes"]["TEXCOORD_0"]}}});
  }
  builder.AddMesh("ball", Json::array({primitive}));
  document.json["materials"][0].erase("extensions");  // any number in there may stand for an accessor, which then is kept
  document.json["textures"] = Json::array({Json::object()});
  if (is_textured) document.json["materials"][0]["emissiveTexture"] = {{"index", 0}};
  if (normal_map_set >= 0) document.json["materials"][0]["normalTexture"] = {{"index", 0}, {"texCoord", normal_map_set}};
  return builder.Glb();
}

PackResult Packed(const Bytes& glb, bool drop_unused) {
  PackOptions options;
  options.drop_unused = drop_unused;
  options.encode.effort = Effort::kFast;
  return PackGltf(glb, options).value();
}

Json Attributes(const Bytes& glb) { return ParseGltf(glb, "").value().json["meshes"][0]["primitives"][0]["attributes"]; }

TEST(UnusedAttributes, GoWhereThatIsAskedFor) {
  const Bytes ball = BallWithTexCoords(false, false);
  const PackResult kept = Packed(ball, false), dropped = Packed(ball, true);
  EXPECT_TRUE(Attributes(kept.glb).contains("TEXCOORD_0"));
  EXPECT_FALSE(Attributes(dropped.glb).contains("TEXCOORD_0"));
  EXPECT_LT(2 * dropped.glb.size(), kept.glb.size());
  EXPECT_THAT(kept.report.notes, Contains(HasSubstr("TEXCOORD_0 of 1 primitive")));
  EXPECT_THAT(dropped.report.notes, Contains(HasSubstr("dropped")));
}

TEST(UnusedAttributes, TangentsGoWhereThatIsAskedFor) {
  const auto packed = [](int set, bool drop_tangents) {
    PackOptions options;
    options.drop_tangents = drop_tangents;
    options.encode.effort = Effort::kFast;
    return PackGltf(BallWithTexCoords(true, false, set), options).value().glb;
  };
  const Bytes kept = packed(0, false), dropped = packed(0, true);
  EXPECT_TRUE(Attributes(kept).contains("TANGENT"));
  EXPECT_FALSE(Attributes(dropped).contains("TANGENT"));
  EXPECT_TRUE(Attributes(dropped).contains("TEXCOORD_0"));
  EXPECT_LT(1.2 * static_cast<double>(dropped.size()), kept.size());
  EXPECT_TRUE(Attributes(packed(1, true)).contains("TANGENT")) << "nothing says how to compute them";
}

TEST(UnusedAttributes, WhatTexturesShowStays) {
  const Bytes ball = BallWithTexCoords(true, false);
  const PackResult asked = Packed(ball, true);
  EXPECT_EQ(asked.glb, Packed(ball, false).glb);
  EXPECT_TRUE(Attributes(asked.glb).contains("TEXCOORD_0"));
  EXPECT_THAT(asked.report.notes, IsEmpty());
}

TEST(UnusedAttributes, GoFromMorphTargetsToo) {
  const Bytes dropped = Packed(BallWithTexCoords(false, true), true).glb;
  const Json primitive = ParseGltf(dropped, "").value().json["meshes"][0]["primitives"][0];
  EXPECT_FALSE(primitive["attributes"].contains("TEXCOORD_0"));
  ASSERT_EQ(primitive["targets"].size(), 1u);
  EXPECT_FALSE(primitive["targets"][0].contains("TEXCOORD_0"));
  EXPECT_TRUE(primitive["targets"][0].contains("POSITION"));
}

}  // namespace
}  // namespace lacerta
