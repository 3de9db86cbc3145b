#include "document/primitive.h"

#include <gtest/gtest.h>

#include "document/draco_encode.h"
#include "document/gltf_document.h"
#include "gltf/test_assets.h"

namespace lacerta {
namespace {

// What Draco's streams say of that differs from writer to writer; glTF's accessors decide.
TEST(Primitive, AccessorsOfDracoStreamsTellWhetherIntegersAreNormalized) {
  const TriangleMesh mesh = testing::WavySphere(6, 8);
  for (const bool stream_says : {false, true}) {
    Primitive primitive;
    primitive.num_vertices = mesh.positions.size();
    primitive.triangles = mesh.triangles;
    primitive.attributes.push_back({"POSITION", MakeFloatAccessor(mesh.positions)});
    AccessorData color{ComponentType::kUint16, 4, stream_says, mesh.positions.size(),
                       Bytes(8 * mesh.positions.size(), 255)};
    primitive.attributes.push_back({"COLOR_0", color});
    DracoEncoded encoded =
        EncodeDracoPrimitive(primitive, {PositionLattice({-2, -2, -2}, {2, 2, 2}, 10), {}, 0}).value();
    for (const bool accessor_says : {false, true}) {
      GltfDocument document;
      document.json = {{"buffers", {{{"byteLength", encoded.bytes.size()}}}},
                       {"bufferViews", {{{"buffer", 0}, {"byteLength", encoded.bytes.size()}}}},
                       {"accessors", {Json::object(), {{"componentType", 5123}, {"normalized", accessor_says}}}}};
      document.buffers = {encoded.bytes};
      const Json draco = {{"bufferView", 0},
                          {"attributes", {{"POSITION", encoded.ids[0].id}, {"COLOR_0", encoded.ids[1].id}}}};
      const Json json = {{"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}},
                         {"extensions", {{"KHR_draco_mesh_compression", draco}}}};
      const StatusOr<Primitive> read = ReadPrimitive(document, json, DecodeLimits());
      ASSERT_TRUE(read.ok()) << read.status().message();
      EXPECT_EQ(read.value().Find("COLOR_0")->data.normalized, accessor_says);
      EXPECT_EQ(read.value().Find("COLOR_0")->data.Float(3, 1), accessor_says ? 1.0f : 65535.0f);
    }
  }
}

// A ball as a Draco stream of positions alone, with accessors of colors and of joints beside it: the latter without any data.
struct BallWithBeside {
  GltfDocument document;
  Json json;
  uint64_t num_vertices = 0;

  explicit BallWithBeside(int missing_colors = 0) {
    Primitive primitive;
    const TriangleMesh mesh = testing::WavySphere(6, 8);
    primitive.num_vertices = num_vertices = mesh.positions.size();
    primitive.triangles = mesh.triangles;
    primitive.attributes.push_back({"POSITION", MakeFloatAccessor(mesh.positions)});
    const DracoEncoded encoded = EncodeDracoPrimitive(primitive, {PositionLattice({-2, -2, -2}, {2, 2, 2}, 10), {}, 0}).value();
    const uint64_t num_colors = num_vertices - static_cast<uint64_t>(missing_colors);
    Bytes colors;
    for (uint64_t i = 0; i < 4 * num_colors; ++i) colors.push_back(static_cast<uint8_t>(i));
    document.json = {{"buffers", {{{"byteLength", encoded.bytes.size()}}, {{"byteLength", colors.size()}}}},
                     {"bufferViews", {{{"buffer", 0}, {"byteLength", encoded.bytes.size()}}, {{"buffer", 1}, {"byteLength", colors.size()}}}},
                     {"accessors",
                      {{{"componentType", 5126}, {"type", "VEC3"}, {"count", num_vertices}},
                       {{"bufferView", 1}, {"componentType", 5121}, {"normalized", true}, {"type", "VEC4"}, {"count", num_colors}},
                       {{"componentType", 5123}, {"type", "VEC4"}, {"count", num_vertices}}}}};
    document.buffers = {encoded.bytes, colors};
    json = {{"attributes", {{"POSITION", 0}, {"COLOR_0", 1}, {"JOINTS_0", 2}}},
            {"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", 0}, {"attributes", {{"POSITION", encoded.ids[0].id}}}}}}}};
  }
};

TEST(Primitive, AttributesBesideADracoStreamAreRead) {
  const BallWithBeside ball;
  const StatusOr<Primitive> read = ReadPrimitive(ball.document, ball.json, DecodeLimits());
  ASSERT_TRUE(read.ok()) << read.status().message();
  ASSERT_EQ(read.value().attributes.size(), 3u);
  EXPECT_EQ(read.value().attributes[0].name, "POSITION");
  const AccessorData& color = read.value().Find("COLOR_0")->data;
  ASSERT_EQ(color.count, ball.num_vertices);
  EXPECT_EQ(color.Float(5, 2), 22.0f / 255);
  const AccessorData& joints = read.value().Find("JOINTS_0")->data;
  ASSERT_EQ(joints.count, ball.num_vertices);
  EXPECT_EQ(joints.bytes, Bytes(8 * ball.num_vertices, 0)) << "what an accessor without data holds";

  const BallWithBeside other(3);
  const StatusOr<Primitive> refused = ReadPrimitive(other.document, other.json, DecodeLimits());
  EXPECT_EQ(refused.status().code(), StatusCode::kUnsupported) << "it stays as it is";
  EXPECT_NE(refused.status().message().find("elements of COLOR_0 beside a Draco stream"), std::string::npos) << refused.status().message();
}

TEST(Primitive, WithoutPositionsItIsLegalButNotRead) {
  BallWithBeside ball;
  Json draco = ball.json, plain = ball.json;
  draco["attributes"].erase("POSITION");
  draco["extensions"]["KHR_draco_mesh_compression"]["attributes"].erase("POSITION");
  plain["attributes"].erase("POSITION");
  plain.erase("extensions");
  for (const Json& json : {draco, plain}) {
    const Status status = ReadPrimitive(ball.document, json, DecodeLimits()).status();
    EXPECT_EQ(status.code(), StatusCode::kUnsupported) << status.message();
    EXPECT_NE(status.message().find("has no POSITION"), std::string::npos) << status.message();
  }
  plain["attributes"]["POSITION"] = 0;  // an accessor without data: its base was left out, or comes with an extension
  EXPECT_EQ(ReadPrimitive(ball.document, plain, DecodeLimits()).status().code(), StatusCode::kUnsupported);
}

}  // namespace
}  // namespace lacerta
