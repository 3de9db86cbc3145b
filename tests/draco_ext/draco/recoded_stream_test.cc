#include "draco/recoded_stream.h"

#include <draco/attributes/geometry_indices.h>
#include <draco/attributes/point_attribute.h>
#include <draco/compression/expert_encode.h>
#include <draco/core/encoder_buffer.h>
#include <draco/mesh/mesh.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "draco/mesh_conversion.h"
#include "draco/stock_stream.h"
#include "shapes/real_meshes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

struct Way {
  int method = draco::MESH_EDGEBREAKER_ENCODING;
  int edgebreaker = draco::MESH_EDGEBREAKER_STANDARD_ENCODING;
  int speed = 0;
  int prediction = draco::PREDICTION_UNDEFINED;  // of positions
};

std::vector<Way> Ways() {
  std::vector<Way> ways;
  for (const int edgebreaker : {draco::MESH_EDGEBREAKER_STANDARD_ENCODING, draco::MESH_EDGEBREAKER_VALENCE_ENCODING}) {
    for (const int prediction : {draco::PREDICTION_DIFFERENCE, draco::MESH_PREDICTION_PARALLELOGRAM, draco::MESH_PREDICTION_CONSTRAINED_MULTI_PARALLELOGRAM}) {
      for (const int speed : {0, 1, 5}) ways.push_back({draco::MESH_EDGEBREAKER_ENCODING, edgebreaker, speed, prediction});
    }
  }
  return ways;
}

Bytes EncodeBy(const Way& way, const draco::Mesh& mesh) {
  draco::ExpertEncoder encoder(mesh);
  encoder.SetSpeedOptions(way.speed, way.speed);
  encoder.SetEncodingMethod(way.method);
  if (way.method == draco::MESH_EDGEBREAKER_ENCODING) {
    EXPECT_TRUE(SetEdgebreaker(mesh, way.edgebreaker, &encoder).ok());
  }
  for (int i = 0; i < mesh.num_attributes(); ++i) {
    if (mesh.attribute(i)->attribute_type() != draco::GeometryAttribute::GENERIC) encoder.SetAttributeQuantization(i, 11);
  }
  if (way.prediction != draco::PREDICTION_UNDEFINED) {
    EXPECT_TRUE(encoder.SetAttributePredictionScheme(0, way.prediction).ok());
  }
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
  return Bytes(buffer.data(), buffer.data() + buffer.size());
}

std::vector<float> ValueAt(const draco::PointAttribute& attribute, draco::PointIndex point) {
  std::vector<float> value(static_cast<size_t>(attribute.num_components()));
  EXPECT_TRUE(attribute.ConvertValue<float>(attribute.mapped_index(point), attribute.num_components(), value.data()));
  return value;
}

// Recodes it, expects Draco to read the same, and returns the new size.
size_t ExpectSame(const Bytes& stream) {
  const Bytes recoded = RecodeStream(stream);
  EXPECT_LE(recoded.size(), stream.size());
  const StatusOr<StockMesh> before = DecodeStockStream(stream, kNoDecodeLimits), after = DecodeStockStream(recoded, kNoDecodeLimits);
  EXPECT_TRUE(before.ok() && after.ok());
  if (!before.ok() || !after.ok()) return 0;
  EXPECT_EQ(after.value().bytes_used, recoded.size());
  const draco::Mesh &a = *before.value().mesh, &b = *after.value().mesh;
  EXPECT_EQ(a.num_points(), b.num_points());
  EXPECT_EQ(a.num_faces(), b.num_faces());
  EXPECT_EQ(a.num_attributes(), b.num_attributes());
  if (a.num_points() != b.num_points() || a.num_faces() != b.num_faces() || a.num_attributes() != b.num_attributes()) return 0;
  for (draco::FaceIndex f(0); f < a.num_faces(); ++f) EXPECT_EQ(a.face(f), b.face(f));
  for (int i = 0; i < a.num_attributes(); ++i) {
    EXPECT_EQ(a.attribute(i)->unique_id(), b.attribute(i)->unique_id());
    for (draco::PointIndex p(0); p < a.num_points(); ++p) EXPECT_EQ(ValueAt(*a.attribute(i), p), ValueAt(*b.attribute(i), p));
  }
  return recoded.size();
}

// A sphere with texture coordinates that jump across a seam, normals, which are by vertex, a number on each face, and floats that stay exact.
std::unique_ptr<draco::Mesh> Textured() {
  const TriangleMesh sphere = shapes::BumpySphere(3);
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(sphere.triangles.size()));
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int texture = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const int normal = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
  const int number = builder.AddAttribute(draco::GeometryAttribute::GENERIC, 1, draco::DT_UINT8);
  const int exact = builder.AddAttribute(draco::GeometryAttribute::GENERIC, 1, draco::DT_FLOAT32);
  for (uint32_t f = 0; f < sphere.triangles.size(); ++f) {
    const draco::FaceIndex face(f);
    std::array<Vec3f, 3> corner;
    for (size_t k = 0; k < 3; ++k) corner[k] = sphere.positions[sphere.triangles[f][k]];
    const float turn = corner[0].x + corner[1].x + corner[2].x > 0 ? 0.25f : 0.75f;
    std::array<std::array<float, 2>, 3> uv;
    for (size_t k = 0; k < 3; ++k) uv[k] = {turn + 0.2f * corner[k].y, 0.5f + 0.2f * corner[k].z};
    builder.SetAttributeValuesForFace(position, face, &corner[0], &corner[1], &corner[2]);
    builder.SetAttributeValuesForFace(texture, face, &uv[0], &uv[1], &uv[2]);
    builder.SetAttributeValuesForFace(normal, face, &corner[0], &corner[1], &corner[2]);
    const auto side = static_cast<uint8_t>(turn * 200);
    builder.SetPerFaceAttributeValueForFace(number, face, &side);
    builder.SetAttributeValuesForFace(exact, face, &corner[0].x, &corner[1].x, &corner[2].x);
  }
  return builder.Finalize();
}

TEST(RecodeStream, KeepsEveryShapeHoweverItWasCoded) {
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    SCOPED_TRACE(shape.name);
    if (!CheckEncodable(shape.mesh).ok()) continue;
    const auto mesh = ToDracoMesh(shape.mesh);
    for (const Way& way : Ways()) ExpectSame(EncodeBy(way, *mesh));
  }
}

TEST(RecodeStream, TakesFewerBytesForWhatScansLookLike) {
  const auto mesh = ToDracoMesh(shapes::BumpySphere(3, 0.1f, 0.01f));
  for (const Way& way : Ways()) {
    const Bytes stream = EncodeBy(way, *mesh);
    const auto size = static_cast<double>(ExpectSame(stream)), before = static_cast<double>(stream.size());
    EXPECT_LT(size, 0.995 * before);
    EXPECT_GT(size, (way.prediction == draco::PREDICTION_DIFFERENCE ? 0.5 : 0.85) * before);
  }
}

TEST(RecodeStream, KeepsAttributesWithAndWithoutSeams) {
  const std::unique_ptr<draco::Mesh> mesh = Textured();
  ASSERT_NE(mesh, nullptr);
  ASSERT_EQ(mesh->num_attributes(), 5);
  for (const Way& way : Ways()) {
    const Bytes stream = EncodeBy(way, *mesh);
    EXPECT_LT(ExpectSame(stream), stream.size());
  }
}

TEST(RecodeStream, RecodesOnlyOnce) {
  const Bytes once = RecodeStream(EncodeBy(Ways().front(), *ToDracoMesh(shapes::BumpySphere(2))));
  EXPECT_EQ(RecodeStream(once), once);
}

TEST(RecodeStream, OtherStreamsComeBackAsTheyAre) {
  const auto mesh = ToDracoMesh(shapes::Icosphere(2));
  Way sequential;
  sequential.method = draco::MESH_SEQUENTIAL_ENCODING;
  Bytes stream = EncodeBy(sequential, *mesh);
  EXPECT_EQ(RecodeStream(stream), stream);
  EXPECT_EQ(RecodeStream({}), Bytes());
  const Bytes whole = EncodeBy({}, *mesh);
  for (size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size));
    EXPECT_EQ(RecodeStream(cut), cut);
  }
  Bytes longer = whole;
  longer.push_back(0);
  EXPECT_EQ(RecodeStream(longer), longer);
}

TEST(RecodeStream, KeepsRealMeshes) {
  int tried = 0;
  for (const char* name : {"fertility.ply", "plane_holes.ply", "beetle.ply", "dragon_vrip_res2.ply"}) {
    const auto mesh = testing::RealMesh(name);
    if (!mesh.has_value()) continue;
    SCOPED_TRACE(name);
    ++tried;
    const Bytes stream = EncodeBy({}, *ToDracoMesh(*mesh));
    EXPECT_LT(ExpectSame(stream), stream.size());
  }
  if (tried == 0) GTEST_SKIP() << "no real mesh in " LACERTA_TEST_DATA_DIR;
}

}  // namespace
}  // namespace lacerta
