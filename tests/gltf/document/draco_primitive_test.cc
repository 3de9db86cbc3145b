#include "document/draco_primitive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gltf/test_assets.h"

namespace lacerta {
namespace {

Primitive WithTexture(const TriangleMesh& mesh) {
  Primitive primitive;
  primitive.num_vertices = mesh.positions.size();
  primitive.triangles = mesh.triangles;
  primitive.attributes.push_back({"POSITION", MakeFloatAccessor(mesh.positions)});
  AccessorData joints;
  joints.type = ComponentType::kUint8;
  joints.components = 4;
  joints.count = mesh.positions.size();
  for (size_t i = 0; i < 4 * mesh.positions.size(); ++i) joints.bytes.push_back(static_cast<uint8_t>(i));
  primitive.attributes.push_back({"JOINTS_0", joints});
  return primitive;
}

// Largest distance from a vertex of `decoded` to the vertex of `primitive` with the same joints.
double LargestMove(const Primitive& primitive, const Primitive& decoded) {
  double largest = 0.0;
  const TriangleMesh before = Surface(primitive);
  const TriangleMesh after = Surface(decoded);
  for (size_t i = 0; i < after.positions.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t j = 0; j < before.positions.size(); ++j) {
      if (primitive.attributes[1].data.Uint(j, 0) != decoded.attributes[1].data.Uint(i, 0)) continue;
      nearest = std::min(nearest, static_cast<double>(Norm(after.positions[i] - before.positions[j])));
    }
    largest = std::max(largest, nearest);
  }
  return largest;
}

TEST(DracoPrimitive, KeepsIntegersAndTheGrid) {
  for (const float scale : {1.0f, 1e-4f, 1e4f}) {
    TriangleMesh mesh = testing::WavySphere(6, 8);
    for (Vec3f& position : mesh.positions) position *= scale;
    const Primitive primitive = WithTexture(mesh);
    const Vec3f corner = Vec3f{1.1f, 1.1f, 1.1f} * scale;
    const PositionGrid grid = MakePositionGrid(-corner, corner, 60.0);
    const auto encoded = EncodeDracoPrimitive(primitive, grid);
    ASSERT_TRUE(encoded.ok()) << encoded.status().message();
    EXPECT_EQ(encoded.value().decoded.num_vertices, mesh.positions.size());
    EXPECT_EQ(encoded.value().decoded.triangles.size(), mesh.triangles.size());
    const double step = 2.2 * scale / (std::pow(2.0, grid.bits) - 1);
    const double move = LargestMove(primitive, encoded.value().decoded);
    EXPECT_LE(move, 0.9 * step) << scale;  // half the diagonal of a cell
    EXPECT_GE(move, 0.1 * step) << scale;
  }
}

TEST(DracoPrimitive, GridIsTheCoarsestForThePsnr) {
  const auto psnr = [](int bits) { return 20 * std::log10(2 * std::sqrt(3.0) * (std::pow(2.0, bits) - 1)); };
  for (const double target : {60.0, 70.0, 80.0}) {
    const PositionGrid grid = MakePositionGrid({0, 0, 0}, {1, 1, 1}, target);
    EXPECT_GE(psnr(grid.bits), target - 0.01);
    EXPECT_LT(psnr(grid.bits - 1), target);
  }
  EXPECT_EQ(MakePositionGrid({0, 0, 0}, {1, 1, 1}, 500.0).bits, 24);
  EXPECT_GT(MakePositionGrid({2, 2, 2}, {2, 2, 2}, 70.0).range, 0.0f);  // a point
}

TEST(DracoPrimitive, RefusesWhatWouldCrashDraco) {
  Primitive primitive = WithTexture(testing::WavySphere(3, 4));
  const PositionGrid grid = MakePositionGrid({-1, -1, -1}, {1, 1, 1}, 60.0);
  const float nan = std::nanf("");
  std::memcpy(primitive.attributes[0].data.bytes.data(), &nan, sizeof(nan));
  EXPECT_EQ(EncodeDracoPrimitive(primitive, grid).status().code(), StatusCode::kUnsupported);
  primitive = WithTexture(testing::WavySphere(3, 4));
  primitive.triangles.clear();
  EXPECT_FALSE(EncodeDracoPrimitive(primitive, grid).ok());
  primitive.triangles = {{1, 1, 2}};
  EXPECT_FALSE(EncodeDracoPrimitive(primitive, grid).ok());
}

TEST(DracoPrimitive, DecodingSurvivesTruncationAndNamesAttributes) {
  const Primitive primitive = WithTexture(testing::WavySphere(3, 4));
  const auto encoded = EncodeDracoPrimitive(primitive, MakePositionGrid({-2, -2, -2}, {2, 2, 2}, 50.0));
  ASSERT_TRUE(encoded.ok());
  const Bytes& bytes = encoded.value().bytes;
  for (size_t length = 0; length + 1 < bytes.size(); ++length) {
    const Bytes prefix(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    const auto decoded = DecodeDracoPrimitive(prefix, encoded.value().ids, {});
    EXPECT_FALSE(decoded.ok() && length < bytes.size() / 2) << length;
  }
  EXPECT_THAT(DecodeDracoPrimitive(bytes, {{"COLOR_0", 77}}, {}).status().message(),
              AllOf(::testing::HasSubstr("77"), ::testing::HasSubstr("COLOR_0")));
}

}  // namespace
}  // namespace lacerta
