#include "draco/mesh_conversion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "draco_ext/draco/test_meshes.h"

namespace lacerta {
namespace {

using ::lacerta::testing::Octahedron;
using ::lacerta::testing::SameBits;
using ::testing::HasSubstr;

TEST(MeshConversionTest, RoundTrips) {
  TriangleMesh mesh = Octahedron().ToMesh();
  mesh.positions[1] = mesh.positions[0];  // stay apart
  mesh.positions[2].x = -0.0f;
  const StatusOr<TriangleMesh> result = FromDracoMesh(*ToDracoMesh(mesh));
  ASSERT_TRUE(result.ok()) << result.status().message();
  EXPECT_TRUE(SameBits(result.value().positions, mesh.positions));
  EXPECT_EQ(result.value().triangles, mesh.triangles);
}

TEST(MeshConversionTest, ConvertsIntegerPositions) {
  draco::Mesh mesh;
  mesh.set_num_points(3);
  draco::GeometryAttribute description;
  description.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_INT16, false, 6, 0);
  const int id = mesh.AddAttribute(description, true, 3);
  for (int16_t v = 0; v < 3; ++v) {
    const std::array<int16_t, 3> p = {v, static_cast<int16_t>(-v), 300};
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(static_cast<uint32_t>(v)), p.data());
  }
  const StatusOr<TriangleMesh> result = FromDracoMesh(mesh);
  ASSERT_TRUE(result.ok()) << result.status().message();
  EXPECT_EQ(result.value().positions[2], (Vec3f{2, -2, 300}));
}

TEST(MeshConversionTest, RefusesWhatIsNotThere) {
  EXPECT_THAT(FromDracoMesh(draco::Mesh()).status().message(), HasSubstr("POSITION"));
  TriangleMesh mesh = Octahedron().ToMesh();
  mesh.triangles[3][1] = 6;
  EXPECT_THAT(FromDracoMesh(*ToDracoMesh(mesh)).status().message(), HasSubstr("triangle 3 refers to vertex 6 of 6"));
  mesh.positions[4].z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(FromDracoMesh(*ToDracoMesh(mesh)).status().message(), HasSubstr("vertex 4 is not finite"));
}

TEST(MeshConversionTest, ChecksWhatDracoDoesNot) {
  EXPECT_TRUE(CheckEncodable(Octahedron().ToMesh()).ok());
  EXPECT_THAT(CheckEncodable(TriangleMesh()).message(), HasSubstr("0 vertices"));
  TriangleMesh mesh = Octahedron().ToMesh();
  mesh.triangles.clear();
  EXPECT_THAT(CheckEncodable(mesh).message(), HasSubstr("0 triangles"));
}

TEST(MeshConversionTest, ConvertsStatus) {
  EXPECT_TRUE(ToDracoStatus({}).ok());
  EXPECT_TRUE(FromDracoStatus(draco::OkStatus()).ok());
  EXPECT_EQ(ToDracoStatus(InvalidArgument("x")).code(), draco::Status::INVALID_PARAMETER);
  EXPECT_EQ(ToDracoStatus(LimitExceeded("x")).code(), draco::Status::DRACO_ERROR);
  EXPECT_EQ(FromDracoStatus(ToDracoStatus(Unsupported("x"))).code(), StatusCode::kUnsupported);
  EXPECT_EQ(FromDracoStatus(draco::ErrorStatus("because")).message(), "Draco: because");
}

}  // namespace
}  // namespace lacerta
