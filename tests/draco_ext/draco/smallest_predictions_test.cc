#include "draco/smallest_predictions.h"

#include <draco/attributes/point_attribute.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "draco/mesh_conversion.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

// A torus with a texture that is stretched unevenly.
std::unique_ptr<draco::Mesh> StretchedTorus() {
  const TriangleMesh torus = shapes::Torus(24, 12);
  std::unique_ptr<draco::Mesh> mesh = ToDracoMesh(torus);
  draco::GeometryAttribute description;
  description.Init(draco::GeometryAttribute::TEX_COORD, nullptr, 2, draco::DT_FLOAT32, false, 2 * sizeof(float), 0);
  const int id = mesh->AddAttribute(description, /*identity_mapping=*/true, mesh->num_points());
  std::vector<float> texture;
  for (const Vec3f& p : torus.positions) texture.insert(texture.end(), {p.x * p.x * p.x, 0.2f * p.y});
  mesh->attribute(id)->buffer()->Write(0, texture.data(), texture.size() * sizeof(float));
  return mesh;
}

StatusOr<Bytes> Encode(const draco::Mesh& mesh, const Predictions& predictions) {
  draco::ExpertEncoder encoder(mesh);
  encoder.SetSpeedOptions(0, 0);
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  for (int id = 0; id < mesh.num_attributes(); ++id) encoder.SetAttributeQuantization(id, 10);
  LACERTA_RETURN_IF_ERROR(SetPredictions(predictions, &encoder));
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeToBuffer(&buffer).ok()) return Unsupported("Draco failed");
  return Bytes(buffer.data(), buffer.data() + buffer.size());
}

TEST(SmallestPredictionsTest, FindsSmallerStreamsAndSaysHow) {
  const std::unique_ptr<draco::Mesh> mesh = StretchedTorus();
  const Bytes usual = Encode(*mesh, {}).value();
  Bytes stream = usual;
  int tried = 0;
  const Predictions found = FindPredictions(*mesh, [&](const Predictions& predictions) { return ++tried, Encode(*mesh, predictions); }, &stream);
  EXPECT_LT(stream.size(), usual.size() - 20);
  EXPECT_GT(stream.size(), usual.size() / 2);
  EXPECT_EQ(Encode(*mesh, found).value(), stream);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NE(found[1], draco::PREDICTION_UNDEFINED);
  EXPECT_EQ(tried, 5);
}

TEST(SmallestPredictionsTest, WhatIsRefusedIsLeftOut) {
  const std::unique_ptr<draco::Mesh> mesh = StretchedTorus();
  const Bytes usual = Encode(*mesh, {}).value();
  Bytes stream = usual;
  const Predictions found = FindPredictions(*mesh, [](const Predictions&) -> StatusOr<Bytes> { return Unsupported("no"); }, &stream);
  EXPECT_EQ(stream, usual);
  EXPECT_EQ(found, Predictions(2, draco::PREDICTION_UNDEFINED));
  EXPECT_FALSE(Encode(*mesh, {draco::PREDICTION_UNDEFINED, draco::NUM_PREDICTION_SCHEMES}).ok());
}

}  // namespace
}  // namespace lacerta
