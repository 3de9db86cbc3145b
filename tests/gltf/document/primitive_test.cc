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

}  // namespace
}  // namespace lacerta
