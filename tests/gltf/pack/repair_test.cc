#include "pack/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "gltf/test_assets.h"
#include "lacerta/gltf.h"

namespace lacerta {
namespace {

using ::testing::AllOf;
using testing::AssetBuilder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::WavySphere;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

AccessorData Accessor(const std::vector<std::vector<float>>& rows) {
  std::vector<float> values;
  for (const std::vector<float>& row : rows) values.insert(values.end(), row.begin(), row.end());
  return MakeFloatAccessor(values, static_cast<uint32_t>(rows[0].size()));
}

std::vector<float> Row(const AccessorData& data, uint64_t element) {
  std::vector<float> row;
  for (uint32_t c = 0; c < data.components; ++c) row.push_back(data.Float(element, c));
  return row;
}

// Two triangles over the square from (0, 0) to (1, 1) in the xy plane, wound so that they look along z.
Primitive Square() {
  Primitive square;
  square.num_vertices = 4;
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  square.attributes.push_back({"POSITION", Accessor({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}})});
  return square;
}

PackOptions Repairing() {
  PackOptions options;
  options.repair = true;
  options.encode.effort = Effort::kFast;
  return options;
}

// A ball whose `name` at vertex 7 is not finite. POSITION is accessor 0, indices 1, all else comes after.
Bytes BallWith(const std::string& name, float value) {
  TriangleMesh ball = WavySphere(13, 22);
  std::vector<Vec3f> other(ball.positions.size(), {0.5f, 0.5f, 0.5f});
  (name == "POSITION" ? ball.positions : other)[7].y = value;
  AssetBuilder builder;
  Json primitive = builder.Primitive(ball);
  if (name == "target") {
    primitive["targets"] = Json::array({{{"POSITION", builder.AddFloats(other, true)}}});
  } else if (name != "POSITION") {
    primitive["attributes"][name] = builder.AddFloats(other, false);
  }
  builder.AddMesh("ball", Json::array({primitive}));
  return builder.Glb();
}

TEST(Repair, WhatIsNotFiniteIsRefusedByName) {
  for (const float value : {kNan, kInfinity, -kInfinity}) {
    EXPECT_THAT(PackGltf(BallWith("POSITION", value), {}).status().message(),
                AllOf(HasSubstr("mesh 0 (ball), primitive 0: accessor 0: POSITION: vertex 7 is not finite")));
    for (const char* name : {"NORMAL", "COLOR_0", "_FORCE"}) {
      const Status status = PackGltf(BallWith(name, value), {}).status();
      EXPECT_EQ(status.code(), StatusCode::kInvalidData);
      EXPECT_THAT(status.message(), HasSubstr("mesh 0 (ball), primitive 0: accessor 2: " + std::string(name) + ": vertex 7 is not finite"));
    }
    EXPECT_THAT(PackGltf(BallWith("target", value), {}).status().message(),
                HasSubstr("mesh 0 (ball), primitive 0: morph target 0: accessor 2: POSITION: vertex 7 is not finite"));
  }
}

TEST(Repair, WhatIsPackedThenIsFiniteAndTellsSo) {
  const size_t num_triangles = WavySphere(13, 22).triangles.size();
  for (const char* name : {"POSITION", "NORMAL", "COLOR_0", "_FORCE", "target"}) {
    const auto packed = PackGltf(BallWith(name, kNan), Repairing());
    ASSERT_TRUE(packed.ok()) << name << ": " << packed.status().message();
    ASSERT_EQ(packed.value().report.notes.size(), 1u) << name;
    EXPECT_THAT(packed.value().report.notes[0], HasSubstr("mesh 0 (ball), primitive 0: repaired: 1 "));
    // And may be packed again by those who refuse.
    const Bytes plain = UnpackGltf(packed.value().glb, {}).value().glb;
    EXPECT_TRUE(PackGltf(plain, {}).ok()) << name;
    EXPECT_LE(FlattenGltf(plain, {}).value().mesh.triangles.size(), num_triangles);
  }
}

TEST(Repair, TheLeftOverStaysAsItWas) {
  Primitive square = Square();
  square.attributes[0].data = Accessor({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, kNan, 0}});
  square.attributes.push_back({"TEXCOORD_0", Accessor({{0, 0}, {0.25f, 0}, {0.25f, 0.5f}, {7, 7}})});
  std::vector<MorphTarget> targets = {{{"POSITION", Accessor({{1, 1, 1}, {kNan, 3, kInfinity}, {0, 0, 0}, {9, 9, 9}})}}};
  const Repaired repaired = RepairPrimitive(&square, &targets).value();
  EXPECT_EQ(repaired.vertices, 1u);
  EXPECT_EQ(repaired.triangles, 1u);
  EXPECT_EQ(repaired.values, 0u);
  EXPECT_EQ(repaired.offsets, 1u);
  EXPECT_EQ(square.num_vertices, 3u);
  EXPECT_THAT(square.triangles, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_EQ(square.attributes[1].data.bytes, Accessor({{0, 0}, {0.25f, 0}, {0.25f, 0.5f}}).bytes);
  EXPECT_EQ(targets[0][0].data.bytes, Accessor({{1, 1, 1}, {0, 3, 0}, {0, 0, 0}}).bytes);
}

TEST(Repair, ValuesFollowThoseBesideThem) {
  Primitive square = Square();
  square.attributes.push_back({"NORMAL", Accessor({{0, 0, 1}, {kNan, 0, 0}, {0, 0, 1}, {0, 0, 1}})});
  square.attributes.push_back({"TANGENT", Accessor({{0, 1, 0, -1}, {kNan, kNan, kNan, kNan}, {0, 1, 0, -1}, {1, 0, 0, 1}})});
  square.attributes.push_back({"TEXCOORD_0", Accessor({{0, 0}, {kInfinity, 0}, {1, 0.5f}, {5, 5}})});
  square.attributes.push_back({"_FORCE", Accessor({{kNan}, {kNan}, {kNan}, {kNan}})});
  std::vector<MorphTarget> targets;
  const Repaired repaired = RepairPrimitive(&square, &targets).value();
  EXPECT_EQ(repaired.values, 7u);
  EXPECT_EQ(repaired.triangles, 0u);
  EXPECT_THAT(Row(square.Find("NORMAL")->data, 1), ElementsAre(0, 0, 1));
  EXPECT_THAT(Row(square.Find("TANGENT")->data, 1), ElementsAre(0, 1, 0, -1));
  EXPECT_THAT(Row(square.Find("TEXCOORD_0")->data, 1), ElementsAre(0.5f, 0.25f));  // vertex 3 is not beside it
  EXPECT_THAT(Row(square.Find("_FORCE")->data, 2), ElementsAre(0));
}

TEST(Repair, RingByRing) {
  constexpr uint32_t kLength = 50;  // a strip, of which one end has values
  Primitive strip;
  strip.num_vertices = 2 * kLength;
  std::vector<std::vector<float>> positions, values;
  for (uint32_t i = 0; i < 2 * kLength; ++i) {
    positions.push_back({static_cast<float>(i / 2), static_cast<float>(i % 2), 0});
    values.push_back({i < 2 ? 3.0f : kNan});
    if (i >= 2) strip.triangles.push_back({i - 2, i - 1, i});
  }
  strip.attributes = {{"POSITION", Accessor(positions)}, {"_FORCE", Accessor(values)}};
  std::vector<MorphTarget> targets;
  EXPECT_EQ(RepairPrimitive(&strip, &targets).value().values, 2 * kLength - 2);
  for (uint32_t i = 0; i < 2 * kLength; ++i) EXPECT_EQ(strip.attributes[1].data.Float(i, 0), 3.0f) << i;
}

TEST(Repair, WeightsKeepTheirProportionsAndTheSumOne) {
  Primitive square = Square();
  square.attributes.push_back({"WEIGHTS_0", Accessor({{1, 0, 0, 0}, {0.25f, 0.25f, kNan, 0}, {kNan, kNan, kNan, kNan}, {0.5f, 0.5f, 0, 0}})});
  std::vector<MorphTarget> targets;
  EXPECT_EQ(RepairPrimitive(&square, &targets).value().values, 2u);
  EXPECT_THAT(Row(square.attributes[1].data, 1), ElementsAre(0.5f, 0.5f, 0, 0));
  EXPECT_THAT(Row(square.attributes[1].data, 2), ElementsAre(1, 0, 0, 0));
  EXPECT_THAT(Row(square.attributes[1].data, 3), ElementsAre(0.5f, 0.5f, 0, 0));
}

TEST(Repair, WhatHasNothingLeftIsRefused) {
  TriangleMesh ball = WavySphere(6, 8);
  for (Vec3f& position : ball.positions) position.x = kNan;
  AssetBuilder builder;
  builder.AddMesh("ball", Json::array({builder.Primitive(ball)}));
  const Status status = PackGltf(builder.Glb(), Repairing()).status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidData);
  EXPECT_THAT(status.message(), HasSubstr("mesh 0 (ball), primitive 0: has no triangle with finite positions"));
}

TEST(Repair, WhatIsNotBrokenComesOutAsWithout) {
  AssetBuilder builder;
  builder.AddMesh("ball", Json::array({builder.Primitive(WavySphere(13, 22))}));
  PackOptions options = Repairing();
  const PackResult repaired = PackGltf(builder.Glb(), options).value();
  options.repair = false;
  EXPECT_EQ(repaired.glb, PackGltf(builder.Glb(), options).value().glb);
  EXPECT_THAT(repaired.report.notes, IsEmpty());
}

// Too small to be compressed, one accessor of positions for both, a strip and points.
TEST(Repair, WhatStaysAsItIsIsRepairedTooAndOthersKeepTheirAccessors) {
  AssetBuilder builder;
  const uint64_t positions = builder.AddFloats({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {kNan, 0, 0}}, true);
  const Json strip = {{"attributes", {{"POSITION", positions}}}, {"mode", 5}};
  const Json points = {{"attributes", {{"POSITION", positions}}}, {"mode", 0}};
  builder.AddMesh("both", Json::array({strip, points}));
  const PackResult packed = PackGltf(builder.Glb(), Repairing()).value();
  EXPECT_THAT(packed.report.notes, ElementsAre(HasSubstr("primitive 0: repaired: 1 vertices without a finite position removed with 1 triangles")));
  const GltfDocument document = ParseGltf(packed.glb, "").value();
  const Json& primitives = document.json["meshes"][0]["primitives"];
  const Primitive read = ReadPrimitive(document, primitives[0], DecodeLimits{}).value();
  EXPECT_EQ(read.triangles.size(), 2u);
  EXPECT_EQ(read.num_vertices, 4u);
  EXPECT_EQ(primitives[1]["mode"], 0);
  EXPECT_EQ(ReadAccessor(document, primitives[1]["attributes"]["POSITION"].get<uint64_t>()).value().count, 5u);
}

}  // namespace
}  // namespace lacerta
