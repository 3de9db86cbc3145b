#include "geometry/close_cracks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "lacerta/clean.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

// Two squares that share an edge but for that gap: vertices 1, 2 and 4, 5.
TriangleMesh SquaresApart(float gap) {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1 + gap, 0, 0}, {1 + gap, 1, 0}, {2, 1, 0}, {2, 0, 0}},
          {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}}};
}

std::vector<uint32_t> Unchanged(const TriangleMesh& mesh) {
  std::vector<uint32_t> vertices(mesh.positions.size());
  std::iota(vertices.begin(), vertices.end(), 0u);
  return vertices;
}

TEST(CloseCracks, ClosesGapsOfRoundingAndNoWiderOnes) {
  const double millionth = std::sqrt(5.0) / (1 << 20);
  for (const double share : {0.1, 0.9}) {
    EXPECT_EQ(VerticesWithoutCracks(SquaresApart(static_cast<float>(share * millionth))),
              (std::vector<uint32_t>{0, 1, 2, 3, 1, 2, 6, 7}));
  }
  const TriangleMesh apart = SquaresApart(static_cast<float>(1.1 * millionth));
  EXPECT_EQ(VerticesWithoutCracks(apart), Unchanged(apart));
}

TEST(CloseCracks, IsTheSameAnywhereAndAtAnyScale) {
  TriangleMesh mesh = SquaresApart(1e-6f);
  for (Vec3f& p : mesh.positions) p = p * 1e-20f;
  EXPECT_EQ(VerticesWithoutCracks(mesh)[4], 1u);
  mesh = SquaresApart(std::ldexp(1.0f, -20));
  for (Vec3f& p : mesh.positions) p = p - Vec3f{1, 7, -3};
  EXPECT_EQ(VerticesWithoutCracks(mesh)[4], 1u);
}

TEST(CloseCracks, FarVerticesOfNoTriangleDoNotMatter) {
  TriangleMesh mesh = SquaresApart(1e-6f);
  mesh.positions.push_back({-1e30f, 1e30f, 1e30f});
  EXPECT_EQ(VerticesWithoutCracks(mesh)[4], 1u);
}

TEST(CloseCracks, LeavesTheInsideAlone) {
  TriangleMesh sphere = shapes::Icosphere(3);
  const auto far = static_cast<uint32_t>(sphere.positions.size());  // a triangle that makes the sphere tiny
  sphere.positions.insert(sphere.positions.end(), {{1e8f, 0, 0}, {1e8f, 1e8f, 0}, {0, 1e8f, 1e8f}});
  sphere.triangles.push_back({far, far + 1, far + 2});
  EXPECT_EQ(VerticesWithoutCracks(sphere), Unchanged(sphere));
}

TEST(CloseCracks, ClosesGapsAtEdgesOfMoreThanTwoTriangles) {
  // Two edges with three triangles each, apart by rounding.
  TriangleMesh fins;
  for (const float gap : {0.0f, 1e-7f}) {
    const auto v = static_cast<uint32_t>(fins.positions.size());
    const float side = gap > 0 ? 1.0f : -1.0f;
    fins.positions.insert(fins.positions.end(), {{gap, 0, 0}, {gap, 0, 1}, {side, 0.5f, 0}, {side, 0, 0.5f}, {side, -0.5f, 0}});
    fins.triangles.insert(fins.triangles.end(), {{v, v + 1, v + 2}, {v, v + 1, v + 3}, {v, v + 1, v + 4}});
  }
  EXPECT_EQ(VerticesWithoutCracks(fins), (std::vector<uint32_t>{0, 1, 2, 3, 4, 0, 1, 7, 8, 9}));
}

TEST(CloseCracks, TakesTheNearestAndTheSameForAll) {
  // Four triangles around a point that each has for itself, on a line of roundings.
  TriangleMesh fan;
  for (int k = 0; k < 4; ++k) {
    const float turn = 1.5707963f * static_cast<float>(k);
    const Vec3f out{std::cos(turn), std::sin(turn), 0}, side{-std::sin(turn), std::cos(turn), 0};
    const auto v = static_cast<uint32_t>(fan.positions.size());
    fan.positions.insert(fan.positions.end(),
                         {Vec3f{1e-7f * static_cast<float>(k), 0, 0}, out + side * 0.1f, out - side * 0.1f});
    fan.triangles.push_back({v, v + 2, v + 1});
  }
  const std::vector<uint32_t> closed = VerticesWithoutCracks(fan);
  for (const uint32_t v : {0u, 3u, 6u, 9u}) EXPECT_EQ(closed[v], 0u);
}

TEST(CloseCracks, ATornSphereIsWhole) {
  const TriangleMesh soup = shapes::TriangleSoup(3);
  TriangleMesh torn = soup;
  uint32_t noise = 1;
  for (Vec3f& p : torn.positions) {
    for (int c = 0; c < 3; ++c)
      p[c] += 1e-7f * (static_cast<float>((noise = noise * 1664525u + 1013904223u) >> 8) / (1 << 24) - 0.5f);
  }
  const StatusOr<CleanedMesh> whole = Clean(soup), closed = Clean(torn);
  ASSERT_TRUE(whole.ok() && closed.ok());
  EXPECT_EQ(closed.value().mesh.triangles, whole.value().mesh.triangles);
  EXPECT_EQ(closed.value().report.welded_vertices, whole.value().report.welded_vertices);
}

}  // namespace
}  // namespace lacerta
