#include "draco/zero_level.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "common/position_prediction.h"
#include "draco/base_mesh_codec.h"
#include "draco_ext/draco/test_meshes.h"
#include "shapes/base_meshes.h"

namespace lacerta {
namespace {

using ::lacerta::testing::Octahedron;
using ::lacerta::testing::RealMesh;
using ::lacerta::testing::SameBits;
using ::lacerta::testing::Torus;
using ::lacerta::testing::TwoOctahedra;

float LongestSide(const TriangleMesh& mesh) {
  Vec3f low = mesh.positions[0], high = low;
  for (const Vec3f& p : mesh.positions) {
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], p[c]);
      high[c] = std::max(high[c], p[c]);
    }
  }
  const Vec3f size = high - low;
  return std::max({size.x, size.y, size.z});
}

Vec3d Sum(const TriangleMesh& mesh) {
  Vec3d sum;
  for (const Triangle& t : mesh.triangles) {
    for (const uint32_t v : t) sum += Vec3Cast<double>(mesh.positions[v]);
  }
  return sum;
}

// Signed volume times six: changes when a triangle is lost, turned over or moved.
double Volume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const Triangle& t : mesh.triangles) {
    volume += Dot(Vec3Cast<double>(mesh.positions[t[0]]),
                  Cross(Vec3Cast<double>(mesh.positions[t[1]]), Vec3Cast<double>(mesh.positions[t[2]])));
  }
  return volume;
}

CodedZeroLevel ExpectRoundTrip(const TriangleMesh& mesh, int bits) {
  const StatusOr<CodedZeroLevel> result = EncodeZeroLevel(mesh, bits);
  EXPECT_TRUE(result.ok()) << result.status().message();
  if (!result.ok()) return {};
  const CodedZeroLevel& coded = result.value();
  EXPECT_EQ(coded.mesh.triangles.size(), mesh.triangles.size());
  const auto side = static_cast<double>(LongestSide(mesh));
  const double step = side / static_cast<double>((1 << bits) - 1);
  const double tolerance = 0.51 * step + 1e-6 * side;
  EXPECT_NEAR(LongestSide(coded.mesh), side, 1e-6 * side);
  const Vec3d difference = Sum(coded.mesh) - Sum(mesh);
  const double corners = 3.0 * static_cast<double>(mesh.triangles.size());
  for (int c = 0; c < 3; ++c) EXPECT_LE(std::fabs(difference[c]), corners * tolerance);
  const double size = side + std::sqrt(SquaredNorm(Vec3Cast<double>(mesh.positions[0])));
  EXPECT_NEAR(Volume(coded.mesh), Volume(mesh), corners * tolerance * 2 * size * size);
  const StatusOr<DecodedBase> decoded = DecodeBaseMesh(coded.stream, {});
  EXPECT_TRUE(decoded.ok() && SameBits(decoded.value().mesh.positions, coded.mesh.positions));
  return coded;
}

TEST(ZeroLevelTest, CodesManifoldMeshesWithEdgebreaker) {
  EXPECT_FALSE(ExpectRoundTrip(Octahedron().ToMesh(), 10).sequential);
  EXPECT_FALSE(ExpectRoundTrip(Torus(12, 9).ToMesh(), 14).sequential);
  EXPECT_FALSE(ExpectRoundTrip(TwoOctahedra().ToMesh(), 1).sequential);
}

TEST(ZeroLevelTest, EveryVertexIsWithinHalfAStep) {
  const TriangleMesh mesh = Torus(12, 9).ToMesh();
  for (const int bits : {4, 9, 16}) {
    const CodedZeroLevel coded = EncodeZeroLevel(mesh, bits).value();
    const double step = static_cast<double>(LongestSide(mesh)) / ((1 << bits) - 1);
    for (const Vec3f& p : coded.mesh.positions) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vec3f& q : mesh.positions) {
        const Vec3f d = p - q;
        nearest = std::min(nearest, static_cast<double>(std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)})));
      }
      EXPECT_LE(nearest, 0.5001 * step + 1e-6);
    }
  }
}

TEST(ZeroLevelTest, SplitsNonManifoldVerticesButKeepsTheSurface) {
  TriangleMesh bowtie;
  bowtie.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
  bowtie.triangles = {{{0, 1, 2}}, {{0, 3, 4}}};
  EXPECT_EQ(ExpectRoundTrip(bowtie, 8).mesh.positions.size(), 6u);
}

TEST(ZeroLevelTest, KeepsNonManifoldEdges) {
  TriangleMesh fins;
  fins.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, -1}};
  fins.triangles = {{{0, 1, 2}}, {{0, 1, 3}}, {{0, 1, 4}}, {{1, 0, 5}}};
  ExpectRoundTrip(fins, 8);
}

TEST(ZeroLevelTest, KeepsDuplicateAndOppositeTriangles) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{{0, 1, 2}}, {{1, 2, 0}}, {{0, 2, 1}}};
  ExpectRoundTrip(mesh, 8);
}

TEST(ZeroLevelTest, CodesDegenerateTrianglesSequentially) {
  TriangleMesh mesh = Octahedron().ToMesh();
  mesh.triangles.push_back({{0, 0, 1}});
  EXPECT_TRUE(ExpectRoundTrip(mesh, 8).sequential);
}

TEST(ZeroLevelTest, CodesMeshesInOnePoint) {
  TriangleMesh mesh;
  mesh.positions = {{5, 6, 7}, {5, 6, 7}, {5, 6, 7}};
  mesh.triangles = {{{0, 1, 2}}};
  const CodedZeroLevel coded = EncodeZeroLevel(mesh, 12).value();
  for (const Vec3f& p : coded.mesh.positions) EXPECT_EQ(p, (Vec3f{5, 6, 7}));
}

TEST(ZeroLevelTest, CodesManyComponents) {
  TriangleMesh leaves;
  for (uint32_t i = 0; i < 500; ++i) {
    const auto x = static_cast<float>(i % 25), y = static_cast<float>(i / 25);
    leaves.positions.insert(leaves.positions.end(), {{x, y, 0}, {x + 0.7f, y, 0.1f}, {x, y + 0.7f, 0.2f}});
    leaves.triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}});
  }
  ExpectRoundTrip(leaves, 12);
}

TEST(ZeroLevelTest, CodesRealMeshes) {
  int tried = 0;
  for (const char* name : {"fertility.ply", "plane_holes.ply", "beetle.ply", "dragon_vrip_res2.ply"}) {
    const auto mesh = RealMesh(name);
    if (!mesh.has_value()) continue;
    SCOPED_TRACE(name);
    ++tried;
    ExpectRoundTrip(*mesh, 12);
  }
  if (tried == 0) GTEST_SKIP() << "no real mesh in " LACERTA_TEST_DATA_DIR;
}

TEST(ZeroLevelTest, KeepsLatticesOfAnyStep) {
  const TriangleMesh torus = Torus(12, 9).ToMesh();
  for (const float step : {0.3f, 0.0123f, 1e-5f}) {
    LatticeMesh mesh;
    mesh.origin = {-7.5f, 3.25f, 100};
    mesh.step = step;
    mesh.triangles = torus.triangles;
    for (size_t v = 0; v < torus.positions.size(); ++v) {
      mesh.lattice.push_back({static_cast<int32_t>(v * 7 % 101), static_cast<int32_t>(v * v % 47), static_cast<int32_t>(v / 3)});
    }
    size_t sizes[2] = {};
    for (const CodingEffort effort : {CodingEffort::kQuick, CodingEffort::kFull}) {
      const CodedZeroLevel coded = EncodeLatticeMesh(mesh, effort).value();
      EXPECT_FALSE(coded.sequential);
      ASSERT_EQ(coded.mesh.triangles.size(), mesh.triangles.size());
      std::vector<std::array<int32_t, 3>> points, expected = mesh.lattice;
      for (const Vec3f& p : coded.mesh.positions) {
        std::array<int32_t, 3> point{};
        for (int c = 0; c < 3; ++c) {
          const float value = (p[c] - mesh.origin[c]) / step;
          point[static_cast<size_t>(c)] = static_cast<int32_t>(std::lround(value));
          if (step > 1e-3f) {
            EXPECT_NEAR(value, std::round(value), 1e-2);
          }
        }
        points.push_back(point);
      }
      std::sort(points.begin(), points.end());
      std::sort(expected.begin(), expected.end());
      if (step > 1e-3f) {  // else the floats near the origin are too coarse
        EXPECT_EQ(points, expected);
      }
      sizes[effort == CodingEffort::kFull] = coded.stream.size();
    }
    EXPECT_LE(sizes[1], sizes[0]);
    EXPECT_GT(static_cast<double>(sizes[1]), 0.7 * static_cast<double>(sizes[0]));
  }
}

// Triangles as lattice points, each from its smallest corner on, sorted.
std::vector<std::array<LatticePoint, 3>> LatticeTriangles(const std::vector<LatticePoint>& lattice, const std::vector<Triangle>& triangles) {
  std::vector<std::array<LatticePoint, 3>> result;
  for (const Triangle& t : triangles) {
    result.push_back({lattice[t[0]], lattice[t[1]], lattice[t[2]]});
    std::rotate(result.back().begin(), std::min_element(result.back().begin(), result.back().end()), result.back().end());
  }
  std::sort(result.begin(), result.end());
  return result;
}

TEST(ZeroLevelTest, CompactBasesAreCutWhereTheMeshIsNoOrientedManifold) {
  // Two octahedra that share a vertex, one of them with a fin at one of its edges and a triangle turned over.
  LatticeMesh mesh;
  mesh.step = 0.5f;
  mesh.lattice = {{4, 4, 4}, {12, 4, 4}, {8, 0, 4}, {8, 8, 4}, {8, 4, 0}, {8, 4, 8}, {4, 8, 8}, {0, 4, 4}, {20, 4, 4},
                  {16, 0, 4}, {16, 8, 4}, {16, 4, 0}, {16, 4, 8}};
  const auto add = [&](uint32_t left, uint32_t right, uint32_t first) {
    const uint32_t front = first, back = first + 1, low = first + 2, high = first + 3;
    for (const auto& [a, b] : {std::pair{front, right}, {right, back}, {back, left}, {left, front}}) {
      mesh.triangles.push_back({a, b, high});
      mesh.triangles.push_back({b, a, low});
    }
  };
  add(0, 1, 2);
  add(1, 8, 9);
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  mesh.triangles.push_back({3, 5, 6});
  mesh.triangles.push_back({6, 5, 7});
  for (const CodingEffort effort : {CodingEffort::kQuick, CodingEffort::kFull}) {
    const CodedZeroLevel coded = EncodeLatticeMesh(mesh, effort, BaseCoding::kCompact).value();
    EXPECT_EQ(coded.coding, BaseCoding::kCompact);
    const CompactBase decoded = DecodeCompactBase(coded.stream, {}).value();
    EXPECT_EQ(LatticeTriangles(decoded.mesh.lattice, decoded.mesh.triangles), LatticeTriangles(mesh.lattice, mesh.triangles));
    EXPECT_TRUE(SameBits(coded.mesh.positions, decoded.ToMesh().positions));
    EXPECT_EQ(decoded.mesh.lattice.size(), mesh.lattice.size() + 1 + 3 + 2);  // copies: where they touch, of the triangle, of the fin
    EXPECT_LT(coded.stream.size(), EncodeLatticeMesh(mesh, effort).value().stream.size());
  }
  // What no base holds comes as a stock stream.
  mesh.triangles.push_back({0, 0, 1});
  EXPECT_EQ(EncodeLatticeMesh(mesh, CodingEffort::kFull, BaseCoding::kCompact).value().coding, BaseCoding::kStock);
}

TEST(ZeroLevelTest, RefusesLatticesOfMoreThan22Bits) {
  LatticeMesh mesh;
  mesh.lattice = {{0, 0, 0}, {1 << 22, 0, 0}, {0, 5, 0}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_EQ(EncodeLatticeMesh(mesh, CodingEffort::kQuick).status().code(), StatusCode::kInvalidData);
  mesh.lattice[1][0] -= 1;
  EXPECT_TRUE(EncodeLatticeMesh(mesh, CodingEffort::kQuick).ok());
}

// Draco's edgebreaker goes around a vertex once for each of its triangles.
TEST(ZeroLevelTest, VerticesOfVeryManyTrianglesTakeNoEdgebreaker) {
  for (const uint32_t sides : {60'000u, 270'000u}) {
    const TriangleMesh fan = shapes::Fan(sides);
    const CodedZeroLevel coded = EncodeZeroLevel(fan, 18).value();
    EXPECT_EQ(coded.sequential, sides > 1 << 18);
    EXPECT_EQ(coded.mesh.triangles.size(), fan.triangles.size());
  }
}

TEST(ZeroLevelTest, RefusesBadInput) {
  TriangleMesh mesh = Octahedron().ToMesh();
  EXPECT_EQ(EncodeZeroLevel(mesh, 0).status().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(EncodeZeroLevel(mesh, 25).status().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(EncodeZeroLevel(TriangleMesh(), 12).status().code(), StatusCode::kInvalidData);
  const auto expect_refused = [](const TriangleMesh& bad, const char* reason) {
    const Status status = EncodeZeroLevel(bad, 12).status();
    EXPECT_EQ(status.code(), StatusCode::kInvalidData);
    EXPECT_THAT(status.message(), ::testing::HasSubstr(reason));
  };
  mesh.positions[3].y = std::numeric_limits<float>::quiet_NaN();
  expect_refused(mesh, "vertex 3 is not finite");
  mesh.positions[3].y = std::numeric_limits<float>::infinity();
  expect_refused(mesh, "vertex 3 is not finite");
  mesh.positions[3].y = 3e38f;
  mesh.positions[2].y = -3e38f;
  expect_refused(mesh, "does not fit a float");
  mesh = Octahedron().ToMesh();
  mesh.triangles[4][2] = 6;
  expect_refused(mesh, "triangle 4 refers to vertex 6");
}

}  // namespace
}  // namespace lacerta
