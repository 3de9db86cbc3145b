#include "pack/source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "gltf/test_assets.h"

namespace lacerta {
namespace {

using testing::AssetBuilder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::WavySphere;

TEST(Source, EqualContentIsOneSource) {
  AssetBuilder builder;
  builder.AddMesh("a", Json::array({builder.Primitive(WavySphere(6, 8))}));
  builder.AddMesh("b", Json::array({builder.Primitive(WavySphere(6, 8))}));  // accessors of its own
  builder.AddMesh("c", Json::array({builder.Primitive(WavySphere(6, 8, {1, 0, 0}))}));
  const std::vector<Source> sources = ReadSources(builder.document()).value();
  ASSERT_EQ(sources.size(), 2u);
  EXPECT_EQ(sources[0].places.size(), 2u);
  EXPECT_EQ(sources[0].geometries.size(), 2u);
  EXPECT_EQ(sources[1].places[0].mesh, 2u);
}

// Where an extension, or a skin, may refer to an accessor, it stays beside what takes its place: nothing is saved there.
TEST(Source, WhatOthersHoldIsTold) {
  AssetBuilder builder;
  const TriangleMesh ball = WavySphere(6, 8);
  Json primitive = builder.Primitive(ball);
  builder.AddMesh("a", Json::array({primitive}));
  GltfDocument& document = builder.document();
  document.json.erase("materials");  // one of them has an unknown extension
  const uint64_t positions = sizeof(Vec3f) * ball.positions.size(), all = positions + 2 * 3 * ball.triangles.size();
  const auto held = [&] {
    const Source source = ReadSources(document).value()[0];
    EXPECT_EQ(source.stored_bytes, all);
    return source.held_bytes;
  };
  EXPECT_EQ(held(), 0u);
  document.json["nodes"][0]["extensions"]["KHR_something"]["from"] = primitive["attributes"]["POSITION"];
  EXPECT_EQ(held(), 0u);  // Khronos has none that does
  document.json["nodes"][0]["extensions"]["VENDOR_something"]["from"] = primitive["attributes"]["POSITION"];
  EXPECT_EQ(held(), positions);
  document.json["skins"] = Json::array({{{"inverseBindMatrices", primitive["indices"]}}});
  EXPECT_EQ(held(), all);
}

TEST(Source, ReadsSparseAndQuantizedAccessors) {
  AssetBuilder builder;
  GltfDocument& document = builder.document();
  const TriangleMesh ball = WavySphere(6, 8);
  AccessorData quantized;
  quantized.type = ComponentType::kInt16;
  quantized.components = 3;
  quantized.normalized = true;
  quantized.count = ball.positions.size();
  for (const Vec3f& p : ball.positions) {
    for (const float x : {p.x, p.y, p.z}) {
      const auto k = static_cast<int16_t>(x / 1.2f * 32767.0f);
      quantized.bytes.push_back(static_cast<uint8_t>(k & 0xff));
      quantized.bytes.push_back(static_cast<uint8_t>(k >> 8 & 0xff));
    }
  }
  Json primitive = builder.Primitive(ball);
  const size_t position = primitive["attributes"]["POSITION"];
  document.json["accessors"][position] = MakeAccessor(quantized, AccessorUse::kAttribute, true, &document);
  EXPECT_EQ(document.json["bufferViews"].back()["byteStride"], 8);  // 6 bytes, aligned
  std::vector<Vec3f> offsets(ball.positions.size());
  offsets[3] = {0, 0, 1};
  const AccessorData data = MakeFloatAccessor(offsets);
  const uint64_t target = AddAccessor(MakeSparseAccessors({{&data, true}}, &document)[0], &document);
  primitive["targets"] = Json::array({{{"POSITION", target}}});
  builder.AddMesh("a", Json::array({primitive}));
  const std::vector<Source> sources = ReadSources(document).value();
  ASSERT_TRUE(sources[0].primitive.has_value()) << sources[0].reason;
  const AccessorData& read = sources[0].primitive->attributes[0].data;
  EXPECT_EQ(read.type, ComponentType::kFloat);
  for (uint64_t v = 0; v < read.count; ++v) {
    EXPECT_NEAR(read.Float(v, 0), ball.positions[v].x / 1.2f, 1e-4) << v;
  }
  ASSERT_EQ(sources[0].targets.size(), 1u);
  EXPECT_EQ(sources[0].targets[0][0].data.bytes, MakeFloatAccessor(offsets).bytes);
}

// A ball of triangles that share no vertices, each with its normal at all three corners.
Json FlatBall(AssetBuilder* builder) {
  const TriangleMesh ball = WavySphere(6, 8);
  TriangleMesh soup;
  std::vector<Vec3f> normals;
  for (const Triangle& t : ball.triangles) {
    const auto first = static_cast<uint32_t>(soup.positions.size());
    soup.triangles.push_back({first, first + 1, first + 2});
    const Vec3f &a = ball.positions[t[0]], &b = ball.positions[t[1]], &c = ball.positions[t[2]];
    soup.positions.insert(soup.positions.end(), {a, b, c});
    normals.insert(normals.end(), 3, Normalized(Cross(b - a, c - a)));
  }
  Json primitive = builder->Primitive(soup);
  primitive["attributes"]["NORMAL"] = builder->AddFloats(normals, false);
  return primitive;
}

bool HasNormals(AssetBuilder* builder, Json primitive) {
  builder->AddMesh("a", Json::array({std::move(primitive)}));
  const std::vector<Source> sources = ReadSources(builder->document()).value();
  return sources.back().primitive->Find("NORMAL") != nullptr;
}

TEST(Source, NormalsOfFlatShadingAreTakenOff) {
  AssetBuilder builder;
  EXPECT_FALSE(HasNormals(&builder, FlatBall(&builder)));
}

TEST(Source, NormalsStayWhereAnyMaterialOfThemHasANormalMap) {
  const Json map = {{"normalTexture", {{"index", 0}}}}, clearcoat = {{"extensions", {{"KHR_materials_clearcoat", {{"clearcoatNormalTexture", {{"index", 0}}}}}}}};
  for (const Json& material : {map, clearcoat}) {
    AssetBuilder builder;
    builder.document().json["materials"].push_back(material);
    Json varied = FlatBall(&builder);
    varied["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {0}}}};
    EXPECT_TRUE(HasNormals(&builder, std::move(varied)));
  }
  AssetBuilder builder;
  builder.document().json["materials"].push_back(map);
  Json plain = FlatBall(&builder), mapped = plain;
  mapped["material"] = 1;
  builder.AddMesh("plain", Json::array({plain}));
  builder.AddMesh("mapped", Json::array({mapped}));
  const std::vector<Source> sources = ReadSources(builder.document()).value();
  ASSERT_EQ(sources.size(), 1u);
  EXPECT_NE(sources[0].primitive->Find("NORMAL"), nullptr);
}

TEST(Source, NormalsThatSomethingNeedsStay) {
  {
    AssetBuilder builder;
    Json smooth = builder.Primitive(WavySphere(6, 8));
    smooth["attributes"]["NORMAL"] = builder.AddFloats(WavySphere(6, 8).positions, false);
    EXPECT_TRUE(HasNormals(&builder, std::move(smooth)));
  }
  {
    AssetBuilder builder;
    Json mapped = FlatBall(&builder);
    builder.document().json["materials"][0]["normalTexture"] = {{"index", 0}};
    EXPECT_TRUE(HasNormals(&builder, std::move(mapped)));
  }
  {
    AssetBuilder builder;
    Json moved = FlatBall(&builder);
    moved["targets"] = Json::array({{{"POSITION", moved["attributes"]["POSITION"]}}});
    EXPECT_TRUE(HasNormals(&builder, std::move(moved)));
  }
  {
    AssetBuilder builder;
    Json tangents = FlatBall(&builder);
    const uint64_t count = 3 * WavySphere(6, 8).triangles.size();
    const AccessorData data = MakeFloatAccessor(std::vector<float>(4 * count, 1.0f), 4);
    tangents["attributes"]["TANGENT"] = AddAccessor(MakeAccessor(data, AccessorUse::kAttribute, false, &builder.document()), &builder.document());
    EXPECT_TRUE(HasNormals(&builder, std::move(tangents)));
  }
}

TEST(Source, WhatTargetsDoNotMoveIsTakenOff) {
  const TriangleMesh ball = WavySphere(6, 8);
  std::vector<Vec3f> none(ball.positions.size()), some = none;
  some[5] = {0, 0.5f, 0};
  using Offsets = std::map<std::string, std::vector<Vec3f>>;
  const auto names_of = [&](const std::vector<Offsets>& targets) {
    AssetBuilder builder;
    Json primitive = builder.Primitive(ball);
    primitive["attributes"]["NORMAL"] = builder.AddFloats(ball.positions, false);
    for (const Offsets& target : targets) {
      Json references = Json::object();
      for (const auto& [name, values] : target) references[name] = builder.AddFloats(values, true);
      primitive["targets"].push_back(std::move(references));
    }
    builder.AddMesh("a", Json::array({primitive}));
    std::vector<std::string> names;
    const std::vector<Source> sources = ReadSources(builder.document()).value();
    for (const MorphTarget& target : sources[0].targets) {
      names.emplace_back();
      for (const Attribute& attribute : target) names.back() += attribute.name[0];
    }
    return names;
  };
  EXPECT_THAT(names_of({{{"POSITION", some}, {"NORMAL", none}, {"TANGENT", none}}, {{"POSITION", none}, {"NORMAL", none}}}), ElementsAre("P", "P"));
  EXPECT_THAT(names_of({{{"POSITION", some}, {"NORMAL", none}}, {{"POSITION", some}, {"NORMAL", some}}}), ElementsAre("NP", "NP"));
  EXPECT_THAT(names_of({{{"POSITION", some}, {"NORMAL", none}}, {{"NORMAL", none}}}), ElementsAre("NP", "N"));  // no target may be empty
}

TEST(Source, NamesWhatIsWrongWithATarget) {
  AssetBuilder builder;
  Json primitive = builder.Primitive(WavySphere(6, 8));
  primitive["targets"] = Json::array({{{"POSITION", builder.AddFloats({{}, {}}, true)}}});
  builder.AddMesh("a", Json::array({primitive}));
  EXPECT_THAT(ReadSources(builder.document()).status().message(),
              AllOf(HasSubstr("mesh 0 (a), primitive 0"), HasSubstr("morph target 0: POSITION has 2 elements")));
}

TEST(Source, PointsAndUnknownExtensionsStay) {
  AssetBuilder builder;
  Json points = builder.Primitive(WavySphere(6, 8));
  points["mode"] = 0;
  Json splats = builder.Primitive(WavySphere(6, 8, {1, 0, 0}));
  splats["extensions"] = {{"VENDOR_splats", {{"first", 3}}}};
  builder.AddMesh("a", Json::array({points, splats}));
  const std::vector<Source> sources = ReadSources(builder.document()).value();
  EXPECT_THAT(sources[0].reason, HasSubstr("points"));
  EXPECT_THAT(sources[1].reason, HasSubstr("VENDOR_splats"));
}

}  // namespace
}  // namespace lacerta
