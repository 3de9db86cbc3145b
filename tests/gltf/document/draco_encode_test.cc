#include "document/draco_encode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "decoder/smooth_normals.h"
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

DracoPrecision Precision(const Vec3f& min, const Vec3f& max, int bits) { return {PositionLattice(min, max, bits), {}, 0}; }

TEST(DracoEncode, KeepsIntegersAndTheLattice) {
  constexpr int kBits = 9;
  for (const float scale : {1.0f, 1e-6f, 1e4f}) {
    TriangleMesh mesh = testing::WavySphere(6, 8);
    for (Vec3f& position : mesh.positions) position *= scale;
    const Primitive primitive = WithTexture(mesh);
    const Vec3f corner = Vec3f{1.1f, 1.1f, 1.1f} * scale;
    const auto encoded = EncodeDracoPrimitive(primitive, Precision(-corner, corner, kBits));
    ASSERT_TRUE(encoded.ok()) << encoded.status().message();
    EXPECT_EQ(encoded.value().decoded.num_vertices, mesh.positions.size());
    EXPECT_EQ(encoded.value().decoded.triangles.size(), mesh.triangles.size());
    const double step = 2.2 * scale / (std::pow(2.0, kBits) - 1);
    const double move = LargestMove(primitive, encoded.value().decoded);
    EXPECT_LE(move, 0.9 * step) << scale;  // half the diagonal of a cell
    EXPECT_GE(move, 0.1 * step) << scale;
  }
}

// Draco would take four bytes for each integer between the least and the largest.
TEST(DracoEncode, IntegersFarApartAreRefused) {
  const TriangleMesh mesh = testing::WavySphere(4, 5);
  const auto encode = [&](uint32_t least, uint32_t most) {
    Primitive primitive = WithTexture(mesh);
    AccessorData names{ComponentType::kUint32, 1, false, mesh.positions.size(), Bytes(4 * mesh.positions.size(), 0)};
    for (size_t i = 0; i < names.count; ++i) {
      const uint32_t value = i % 2 == 0 ? least : most;
      std::memcpy(names.bytes.data() + 4 * i, &value, sizeof(value));
    }
    primitive.attributes.push_back({"_NAME", names});
    return EncodeDracoPrimitive(primitive, Precision({-1.1f, -1.1f, -1.1f}, {1.1f, 1.1f, 1.1f}, 10));
  };
  const auto refused = encode(0, (1u << 24) + 1);
  EXPECT_EQ(refused.status().code(), StatusCode::kUnsupported);
  EXPECT_THAT(refused.status().message(), ::testing::HasSubstr("_NAME holds integers that are too far apart"));
  for (const uint32_t least : {0u, 2'000'000'000u}) {
    constexpr uint32_t kNear = 1u << 24;
    const auto encoded = encode(least, least + kNear);
    ASSERT_TRUE(encoded.ok()) << encoded.status().message();
    const AccessorData& decoded = encoded.value().decoded.Find("_NAME")->data;
    for (uint64_t i = 0; i < decoded.count; ++i) EXPECT_EQ((decoded.Uint(i, 0) - least) % kNear, 0u);
  }
}

// What RoundAttributes says is what decoders get, value by value: errors measured with the one hold for the other.
TEST(DracoEncode, DecodersGetTheRoundedValues) {
  const TriangleMesh mesh = testing::WavySphere(9, 14, {0.3f, -2.0f, 5.0f});
  Primitive primitive = WithTexture(mesh);
  primitive.attributes.push_back({"NORMAL", MakeFloatAccessor(SmoothNormals(mesh.positions, mesh.triangles))});
  AccessorData texture = MakeFloatAccessor(mesh.positions);
  primitive.attributes.push_back({"COLOR_0", texture});
  primitive.attributes.push_back({"_EXACT", MakeFloatAccessor(mesh.positions)});
  DracoPrecision precision = Precision({-1, -4, 3}, {2, 0, 7}, 11);
  precision.lattices = {{"COLOR_0", LatticeOfStep({{-1.5f, -4.0f, 3.0f, 0.0f}, 5.0f, 0}, 0.01f)}};
  precision.normal_bits = 7;
  const auto quick = EncodeDracoPrimitive(primitive, precision);
  ASSERT_TRUE(quick.ok()) << quick.status().message();
  const auto predicted = EncodeDracoPrimitive(primitive, precision, DracoSearch::kPredictions);
  ASSERT_TRUE(predicted.ok()) << predicted.status().message();
  const auto elsewhere = EncodeInOtherOrder(primitive, precision, predicted.value());
  ASSERT_TRUE(elsewhere.ok()) << elsewhere.status().message();
  for (const DracoEncoded* encoded : {&quick.value(), &predicted.value(), &elsewhere.value()}) {
    const Primitive rounded = RoundAttributes(primitive, precision);
    const Primitive& decoded = encoded->decoded;
    const Attribute* exact = decoded.Find("_EXACT");
    ASSERT_NE(exact, nullptr);
    ASSERT_EQ(decoded.num_vertices, primitive.num_vertices);
    double moved = 0.0;
    for (uint64_t i = 0; i < decoded.num_vertices; ++i) {
      uint64_t v = 0;  // the exact attribute tells which vertex it was
      const Attribute* original = primitive.Find("_EXACT");
      while (v + 1 < primitive.num_vertices && (original->data.Float(v, 0) != exact->data.Float(i, 0) ||
                                                original->data.Float(v, 1) != exact->data.Float(i, 1) ||
                                                original->data.Float(v, 2) != exact->data.Float(i, 2))) {
        ++v;
      }
      for (const char* name : {"POSITION", "NORMAL", "COLOR_0"}) {
        for (uint32_t c = 0; c < 3; ++c) {
          const float value = rounded.Find(name)->data.Float(v, c);
          EXPECT_NEAR(decoded.Find(name)->data.Float(i, c), value, 2e-6f * (1.0f + std::abs(value))) << name;
          moved = std::max(moved, static_cast<double>(std::abs(value - primitive.Find(name)->data.Float(v, c))));
        }
      }
    }
    EXPECT_GT(moved, 1e-3);  // there was something to round
  }
}

// Of every triangle the rows of all floats at its corners, the least row first; sorted.
std::vector<std::vector<float>> TrianglesOf(const Primitive& primitive) {
  std::vector<std::vector<float>> triangles;
  for (const Triangle& t : primitive.triangles) {
    std::array<std::vector<float>, 3> corners;
    for (size_t k = 0; k < 3; ++k) {
      for (const Attribute& attribute : primitive.attributes) {
        for (uint32_t c = 0; c < attribute.data.components; ++c) corners[k].push_back(attribute.data.Float(t[k], c));
      }
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.emplace_back();
    for (const std::vector<float>& corner : corners) triangles.back().insert(triangles.back().end(), corner.begin(), corner.end());
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// A texture that is stretched unevenly does not follow from positions.
TEST(DracoEncode, MoreWaysTakeFewerBytesForTheSameValues) {
  const TriangleMesh mesh = testing::WavySphere(12, 20);
  Primitive primitive;
  primitive.num_vertices = mesh.positions.size();
  primitive.triangles = mesh.triangles;
  primitive.attributes.push_back({"POSITION", MakeFloatAccessor(mesh.positions)});
  std::vector<float> texture;
  for (const Vec3f& p : mesh.positions) texture.insert(texture.end(), {0.5f + 0.5f * p.x * p.x * p.x, 0.5f + 0.1f * p.y});
  primitive.attributes.push_back({"TEXCOORD_0", MakeFloatAccessor(texture, 2)});
  primitive.attributes.push_back({"NORMAL", MakeFloatAccessor(SmoothNormals(mesh.positions, mesh.triangles))});
  DracoPrecision precision = Precision({-1.5f, -1.5f, -1.5f}, {1.5f, 1.5f, 1.5f}, 11);
  precision.lattices = {{"TEXCOORD_0", LatticeOfStep({{0, 0, 0, 0}, 1.5f, 0}, 0.001f)}};
  precision.normal_bits = 8;
  const auto quick = EncodeDracoPrimitive(primitive, precision);
  const auto predicted = EncodeDracoPrimitive(primitive, precision, DracoSearch::kPredictions);
  ASSERT_TRUE(quick.ok()) << quick.status().message();
  ASSERT_TRUE(predicted.ok()) << predicted.status().message();
  const auto smaller = EncodeInOtherOrder(primitive, precision, predicted.value());
  ASSERT_TRUE(smaller.ok()) << smaller.status().message();
  EXPECT_LT(predicted.value().bytes.size(), quick.value().bytes.size());
  EXPECT_LE(smaller.value().bytes.size(), predicted.value().bytes.size());
  EXPECT_EQ(DracoPrimitiveBytes(primitive, precision, quick.value().coding).value(), quick.value().bytes.size());
  const uint64_t by_draco = DracoPrimitiveBytes(primitive, precision, predicted.value().coding).value();  // before RecodeStream
  EXPECT_GT(by_draco, predicted.value().bytes.size());
  EXPECT_LT(static_cast<double>(by_draco), 1.1 * static_cast<double>(predicted.value().bytes.size()));
  EXPECT_EQ(predicted.value().decoded.triangles, quick.value().decoded.triangles);
  for (size_t a = 0; a < primitive.attributes.size(); ++a) {
    EXPECT_EQ(predicted.value().decoded.attributes[a].data.bytes, quick.value().decoded.attributes[a].data.bytes);
  }
  const auto before = static_cast<double>(quick.value().bytes.size()), after = static_cast<double>(smaller.value().bytes.size());
  EXPECT_LT(after, 0.98 * before);
  EXPECT_GT(after, 0.5 * before);
  EXPECT_EQ(TrianglesOf(smaller.value().decoded), TrianglesOf(quick.value().decoded));
  EXPECT_EQ(EncodeInOtherOrder(primitive, precision, predicted.value()).value().bytes, smaller.value().bytes);
}

// Loose triangles anywhere in a box: what the first vertex of each is predicted from is most of the difference.
TEST(DracoEncode, NeighborsAmongManyComponentsFollowEachOther) {
  constexpr uint32_t kCount = 1000;
  std::mt19937 random(7);
  const auto between_0_and = [&](float most) { return most * static_cast<float>(random() % 1024) / 1024; };
  Primitive primitive;
  std::vector<Vec3f> positions;
  for (uint32_t i = 0; i < kCount; ++i) {
    const Vec3f corner{between_0_and(10), between_0_and(10), between_0_and(2)};
    primitive.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    for (int k = 0; k < 3; ++k) positions.push_back(corner + Vec3f{between_0_and(0.1f), between_0_and(0.1f), between_0_and(0.1f)});
  }
  primitive.num_vertices = positions.size();
  primitive.attributes = {{"POSITION", MakeFloatAccessor(positions)}};
  const DracoPrecision precision = Precision({0, 0, 0}, {11, 11, 11}, 11);
  const auto given = EncodeDracoPrimitive(primitive, precision, DracoSearch::kPredictions);
  ASSERT_TRUE(given.ok()) << given.status().message();
  const auto nearest = EncodeInOtherOrder(primitive, precision, given.value());
  ASSERT_TRUE(nearest.ok()) << nearest.status().message();
  const auto before = static_cast<double>(given.value().bytes.size()), after = static_cast<double>(nearest.value().bytes.size());
  EXPECT_LT(after, 0.9 * before);
  EXPECT_GT(after, 0.5 * before);
  EXPECT_EQ(TrianglesOf(nearest.value().decoded), TrianglesOf(given.value().decoded));
}

TEST(DracoEncode, RefusesWhatWouldCrashDraco) {
  Primitive primitive = WithTexture(testing::WavySphere(3, 4));
  const DracoPrecision grid = Precision({-1, -1, -1}, {1, 1, 1}, 10);
  const float nan = std::nanf("");
  std::memcpy(primitive.attributes[0].data.bytes.data(), &nan, sizeof(nan));
  EXPECT_EQ(EncodeDracoPrimitive(primitive, grid).status().code(), StatusCode::kUnsupported);
  primitive = WithTexture(testing::WavySphere(3, 4));
  primitive.triangles.clear();
  EXPECT_FALSE(EncodeDracoPrimitive(primitive, grid).ok());
  primitive.triangles = {{1, 1, 2}};
  EXPECT_FALSE(EncodeDracoPrimitive(primitive, grid).ok());
  EXPECT_FALSE(EncodeDracoPrimitive(primitive, grid, DracoSearch::kPredictions).ok());
}

TEST(DracoEncode, DecodingSurvivesTruncationAndNamesAttributes) {
  const Primitive primitive = WithTexture(testing::WavySphere(3, 4));
  const auto encoded = EncodeDracoPrimitive(primitive, Precision({-2, -2, -2}, {2, 2, 2}, 8));
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
