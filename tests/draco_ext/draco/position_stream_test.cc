#include "draco/position_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "draco/base_mesh_codec.h"
#include "draco/mesh_conversion.h"
#include "draco/stock_stream.h"
#include "lacerta/mesh.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using Connectivity = StockSettings::Connectivity;

std::vector<StockAttempt> Attempts() {
  std::vector<StockAttempt> result;
  for (const int speed : {0, 1}) {
    for (const Connectivity connectivity : {Connectivity::kEdgebreakerValence, Connectivity::kEdgebreaker}) {
      result.push_back({{connectivity, StockSettings::Prediction::kParallelogram, speed}, 3, 1, {}});
    }
  }
  return result;
}

std::vector<LatticePoint> RandomPoints(size_t count, int bits) {
  std::mt19937 random(7);
  std::vector<LatticePoint> points(count);
  for (LatticePoint& p : points) {
    for (int32_t& x : p) x = static_cast<int32_t>(random() & ((1u << bits) - 1));
  }
  return points;
}

using Corners = std::array<LatticePoint, 3>;

std::vector<Corners> Sorted(const std::vector<Triangle>& triangles, const std::vector<LatticePoint>& points) {
  std::vector<Corners> result;
  for (const Triangle& t : triangles) {
    Corners corners = {points[t[0]], points[t[1]], points[t[2]]};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    result.push_back(corners);
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<LatticePoint> Integers(const TriangleMesh& mesh) {
  std::vector<LatticePoint> result;
  for (const Vec3f& p : mesh.positions) result.push_back({static_cast<int32_t>(p.x), static_cast<int32_t>(p.y), static_cast<int32_t>(p.z)});
  return result;
}

constexpr int kBits = 11;
constexpr QuantizationGrid kIntegers = {{}, (1 << kBits) - 1};

TEST(PositionStream, HoldsAnyPointsOfAConnectivity) {
  for (const TriangleMesh& mesh : {shapes::Torus(12, 8), shapes::Icosphere(2), shapes::GridWithBorder(5, 7)}) {
    for (const StockAttempt& attempt : Attempts()) {
      const PositionStream stream = PositionStream::Create(mesh.triangles, mesh.positions.size(), attempt).value();
      const std::vector<LatticePoint> points = RandomPoints(mesh.positions.size(), kBits);
      const DecodedBase decoded = DecodeBaseMesh(stream.Encode(points, kIntegers, kBits), kNoDecodeLimits).value();
      EXPECT_EQ(Sorted(decoded.mesh.triangles, Integers(decoded.mesh)), Sorted(mesh.triangles, points));
      // In the order that it tells.
      const std::vector<uint32_t> vertices = stream.DecodedVertices();
      ASSERT_EQ(vertices.size(), decoded.mesh.positions.size());
      for (size_t v = 0; v < vertices.size(); ++v) EXPECT_EQ(Integers(decoded.mesh)[v], points[vertices[v]]);
      std::vector<LatticePoint> reordered;
      for (const uint32_t v : vertices) reordered.push_back(points[v]);
      EXPECT_EQ(stream.Decoded().Encode(reordered, kIntegers, kBits), stream.Encode(points, kIntegers, kBits));
    }
  }
}

// Two tetrahedra at one vertex, and a vertex of no triangle.
TEST(PositionStream, TellsWhichVerticesAreCutAndWhichAreGone) {
  const std::vector<Triangle> triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 5, 6}, {0, 7, 5}, {0, 6, 7}, {5, 7, 6}};
  for (const StockAttempt& attempt : Attempts()) {
    const PositionStream stream = PositionStream::Create(triangles, 8, attempt).value();
    std::map<uint32_t, int> times;
    for (const uint32_t v : stream.vertices()) ++times[v];
    EXPECT_EQ(times, (std::map<uint32_t, int>{{0, 2}, {1, 1}, {2, 1}, {3, 1}, {5, 1}, {6, 1}, {7, 1}}));
    const std::vector<LatticePoint> points = RandomPoints(8, kBits);
    const DecodedBase decoded = DecodeBaseMesh(stream.Encode(points, kIntegers, kBits), kNoDecodeLimits).value();
    EXPECT_EQ(Sorted(decoded.mesh.triangles, Integers(decoded.mesh)), Sorted(triangles, points));
  }
}

// Draco's own coding of the same mesh is no smaller.
TEST(PositionStream, TakesNoMoreThanDraco) {
  const TriangleMesh mesh = shapes::BumpySphere(3, 0.2f);
  std::vector<LatticePoint> points;
  TriangleMesh integers = mesh;
  for (Vec3f& p : integers.positions) {
    for (int k = 0; k < 3; ++k) p[k] = std::round((p[k] + 1.5f) * 300);
  }
  points = Integers(integers);
  for (const StockAttempt& attempt : Attempts()) {
    const PositionStream stream = PositionStream::Create(mesh.triangles, mesh.positions.size(), attempt).value();
    const size_t size = stream.Encode(points, kIntegers, kBits).size();
    const size_t usual = EncodeIntegerPositions(*ToDracoMesh(StartingAsIn(attempt, integers)), kBits, attempt.settings).value().size();
    EXPECT_LE(size, usual);
    EXPECT_GT(size, usual / 2);
  }
}

TEST(PositionStream, FailsOnNothing) {
  EXPECT_EQ(PositionStream::Create({}, 3, {Attempts()[0].settings, 0, 0, {}}).status().code(), StatusCode::kInvalidData);
}

}  // namespace
}  // namespace lacerta
