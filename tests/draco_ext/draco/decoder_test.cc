// The pair in Draco's manner (lacerta/draco.h) and the encoding method behind it.
#include <draco/compression/config/encoder_options.h>
#include <draco/compression/encode.h>
#include <draco/metadata/geometry_metadata.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "draco/decode_mesh.h"
#include "draco/mesh_conversion.h"
#include "draco/mesh_decoder.h"
#include "draco/mesh_encoder.h"
#include "draco_ext/draco/test_progressive_streams.h"
#include "lacerta/draco.h"

namespace lacerta {
namespace {

using ::lacerta::testing::MakeProgressiveStream;
using ::lacerta::testing::Octahedron;
using ::lacerta::testing::ProgressiveStream;
using ::lacerta::testing::SameBits;
using ::testing::HasSubstr;

draco::DecoderBuffer BufferOf(const Bytes& stream) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  return buffer;
}

Bytes BytesOf(const draco::EncoderBuffer& buffer) { return Bytes(buffer.data(), buffer.data() + buffer.size()); }

void ExpectSameMesh(const draco::Mesh& mesh, const TriangleMesh& expected) {
  const StatusOr<TriangleMesh> actual = FromDracoMesh(mesh);
  ASSERT_TRUE(actual.ok()) << actual.status().message();
  EXPECT_TRUE(SameBits(actual.value().positions, expected.positions));
  EXPECT_EQ(actual.value().triangles, expected.triangles);
}

TEST(DecoderTest, ReadsBothFormsAsDecodeMeshDoes) {
  const ProgressiveStream stream = MakeProgressiveStream(Octahedron(), 3);
  for (const Bytes& bytes : {stream.DracoForm(), stream.CustomForm()}) {
    for (int level = 0; level <= 3; ++level) {
      DecodeOptions options;
      options.max_level = level;
      Decoder decoder(options);
      draco::DecoderBuffer buffer = BufferOf(bytes);
      const auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
      ASSERT_TRUE(mesh.ok()) << mesh.status().error_msg();
      EXPECT_EQ(decoder.level(), level);
      EXPECT_EQ(decoder.num_levels(), 3);
      EXPECT_TRUE(decoder.refinement().ok());
      EXPECT_EQ(buffer.remaining_size(), 0);
      ExpectSameMesh(*mesh.value(), DecodeMesh(bytes, options).value().mesh);
    }
  }
}

TEST(DecoderTest, TellsWhyRefinementEnded) {
  const ProgressiveStream stream = MakeProgressiveStream(Octahedron(), 3);
  for (Bytes bytes : {stream.DracoForm(), stream.CustomForm()}) {
    bytes.pop_back();
    Decoder decoder;
    draco::DecoderBuffer buffer = BufferOf(bytes);
    ASSERT_TRUE(decoder.DecodeMeshFromBuffer(&buffer).ok());
    EXPECT_EQ(decoder.level(), 2);
    EXPECT_THAT(decoder.refinement().message(), HasSubstr("level 3 of 3"));
  }
}

TEST(DecoderTest, KeepsAttributesOfStockStreams) {
  const TriangleMesh octahedron = Octahedron().ToMesh();
  const auto mesh = ToDracoMesh(octahedron);
  draco::GeometryAttribute description;
  description.Init(draco::GeometryAttribute::COLOR, nullptr, 1, draco::DT_UINT8, false, 1, 0);
  const int color = mesh->AddAttribute(description, true, mesh->num_points());
  for (uint8_t v = 0; v < mesh->num_points(); ++v) {
    mesh->attribute(color)->SetAttributeValue(draco::AttributeValueIndex(v), &v);
  }
  draco::Encoder stock;
  draco::EncoderBuffer encoded;
  ASSERT_TRUE(stock.EncodeMeshToBuffer(*mesh, &encoded).ok());
  const Bytes bytes = BytesOf(encoded);
  draco::DecoderBuffer buffer = BufferOf(bytes);
  Decoder decoder;
  const auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  ASSERT_TRUE(decoded.ok()) << decoded.status().error_msg();
  EXPECT_EQ(decoded.value()->num_attributes(), 2);
  EXPECT_NE(decoded.value()->GetNamedAttribute(draco::GeometryAttribute::COLOR), nullptr);
  EXPECT_EQ(decoded.value()->num_faces(), 8u);
}

TEST(DecoderTest, RefusesInDracosManner) {
  Decoder decoder;
  const Bytes nothing;
  draco::DecoderBuffer buffer = BufferOf(nothing);
  EXPECT_FALSE(decoder.DecodeMeshFromBuffer(&buffer).ok());
  Bytes bytes = MakeProgressiveStream(Octahedron(), 1).CustomForm();
  bytes[11] = 9;
  buffer = BufferOf(bytes);
  const auto unknown = decoder.DecodeMeshFromBuffer(&buffer);
  EXPECT_EQ(unknown.status().code(), draco::Status::UNSUPPORTED_FEATURE);
  EXPECT_THAT(unknown.status().error_msg_string(), HasSubstr("version 9"));
  decoder.options().max_level = -1;
  buffer = BufferOf(bytes);
  EXPECT_EQ(decoder.DecodeMeshFromBuffer(&buffer).status().code(), draco::Status::INVALID_PARAMETER);
}

TEST(MeshEncoderTest, WritesTheCustomForm) {
  const ProgressiveStream stream = MakeProgressiveStream(Octahedron(), 2);
  const auto mesh = ToDracoMesh(Octahedron().ToMesh());
  ProgressiveMeshEncoder encoder({stream.base.stream, stream.refinement});
  encoder.SetMesh(*mesh);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.Encode(draco::EncoderOptions::CreateDefaultOptions(), &buffer);
  ASSERT_TRUE(status.ok()) << status.error_msg();
  EXPECT_EQ(BytesOf(buffer), stream.CustomForm());
}

TEST(MeshEncoderTest, CarriesMetadata) {
  const ProgressiveStream stream = MakeProgressiveStream(Octahedron(), 2);
  const auto mesh = ToDracoMesh(Octahedron().ToMesh());
  auto metadata = std::make_unique<draco::GeometryMetadata>();
  metadata->AddEntryString("name", "octahedron");
  mesh->AddMetadata(std::move(metadata));
  ProgressiveMeshEncoder encoder({stream.base.stream, stream.refinement});
  encoder.SetMesh(*mesh);
  draco::EncoderBuffer encoded;
  ASSERT_TRUE(encoder.Encode(draco::EncoderOptions::CreateDefaultOptions(), &encoded).ok());
  const Bytes bytes = BytesOf(encoded);
  draco::DecoderBuffer buffer = BufferOf(bytes);
  Decoder decoder;
  const auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  ASSERT_TRUE(decoded.ok()) << decoded.status().error_msg();
  EXPECT_EQ(decoder.level(), 2);
  std::string name;
  ASSERT_NE(decoded.value()->GetMetadata(), nullptr);
  EXPECT_TRUE(decoded.value()->GetMetadata()->GetEntryString("name", &name));
  EXPECT_EQ(name, "octahedron");
  EXPECT_EQ(DecodeMesh(bytes, {}).value().level, 2);
}

TEST(MeshDecoderTest, IsADracoMeshDecoder) {
  const ProgressiveStream stream = MakeProgressiveStream(Octahedron(), 2);
  const Bytes bytes = stream.CustomForm();
  draco::DecoderBuffer buffer = BufferOf(bytes);
  ProgressiveMeshDecoder decoder{DecodeOptions()};
  draco::Mesh mesh;
  draco::MeshDecoder& base = decoder;
  ASSERT_TRUE(base.Decode(draco::DecoderOptions(), &buffer, &mesh).ok());
  EXPECT_EQ(mesh.num_faces(), 8u * 16);
  EXPECT_EQ(decoder.num_levels(), 2);

  Bytes bad = bytes;
  bad[40] ^= 0xff;
  buffer = BufferOf(bad);
  ProgressiveMeshDecoder second{DecodeOptions()};
  draco::Mesh nothing;
  EXPECT_FALSE(second.Decode(draco::DecoderOptions(), &buffer, &nothing).ok());
  EXPECT_THAT(second.status().message(), HasSubstr("base of the custom form"));
}

}  // namespace
}  // namespace lacerta
