#include "remesh/corners.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shapes/shapes.h"

namespace lacerta {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::vector<uint32_t> BorderCorners(const TriangleMesh& mesh) {
  const StatusOr<Topology> topology = BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles);
  EXPECT_TRUE(topology.ok()) << topology.status().message();
  const std::vector<uint8_t> corner =
      FindCorners(mesh, topology.value(), std::vector<uint8_t>(topology.value().num_edges(), 0), kPi / 4);
  std::vector<uint32_t> marked;
  for (uint32_t v = 0; v < corner.size(); ++v) {
    if (corner[v] != 0) marked.push_back(v);
  }
  return marked;
}

// A disk whose border vertex i is at distance radius(i).
template <typename Radius>
TriangleMesh Disk(uint32_t n, Radius radius) {
  TriangleMesh mesh;
  mesh.positions.push_back({0, 0, 0});
  for (uint32_t i = 0; i < n; ++i) {
    const double a = 2 * kPi * i / n, r = radius(i);
    mesh.positions.push_back({static_cast<float>(r * std::cos(a)), static_cast<float>(r * std::sin(a)), 0});
    mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % n});
  }
  return mesh;
}

TEST(FindCorners, ASquareHasFour) {
  for (const int n : {1, 2, 3, 8, 50}) {
    const TriangleMesh mesh = shapes::GridWithBorder(n, n);
    const std::vector<uint32_t> corners = BorderCorners(mesh);
    EXPECT_EQ(corners.size(), 4u) << n;
    for (const uint32_t v : corners) {
      EXPECT_TRUE(mesh.positions[v].x == 0 || mesh.positions[v].x == 1);
      EXPECT_TRUE(mesh.positions[v].y == 0 || mesh.positions[v].y == 1);
    }
  }
}

TEST(FindCorners, ACircleHasNone) {
  for (const uint32_t n : {5u, 6u, 8u, 12u, 100u}) {
    EXPECT_TRUE(BorderCorners(Disk(n, [](uint32_t) { return 1.0; })).empty()) << n;
  }
}

TEST(FindCorners, AJaggedBorderHasNone) {
  EXPECT_TRUE(BorderCorners(Disk(64, [](uint32_t i) { return i % 2 == 0 ? 1.05 : 0.95; })).empty());
}

TEST(FindCorners, AStripHasFourHoweverThin) {
  for (const int width : {2, 3, 8}) EXPECT_EQ(BorderCorners(shapes::GridWithBorder(60, width)).size(), 4u) << width;
}

TEST(FindCorners, ALensHasTwo) {
  // Two arcs of a quarter circle each, which meet at right angles at vertices 1 and 1 + n.
  for (const uint32_t n : {4u, 10u, 40u}) {
    TriangleMesh lens = Disk(2 * n, [](uint32_t) { return 1.0; });
    for (uint32_t i = 0; i < 2 * n; ++i) {
      const double a = kPi / 4 + kPi / 2 * (i % n) / n, side = i < n ? 1 : -1;
      lens.positions[1 + i] = {static_cast<float>(side * std::cos(a)),
                               static_cast<float>(side * (std::sin(a) - std::sqrt(0.5))), 0};
    }
    EXPECT_EQ(BorderCorners(lens), (std::vector<uint32_t>{1, 1 + n})) << n;
  }
}

TEST(FindCorners, CreasesCountAsBordersDo) {
  // One right angle of creases within a flat sheet; it ends on the border, where three curve edges meet.
  const TriangleMesh mesh = shapes::GridWithBorder(8, 8);
  const StatusOr<Topology> built = BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles);
  const Topology& topology = built.value();
  std::vector<uint8_t> crease(topology.num_edges(), 0);
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    const Vec3f a = mesh.positions[topology.edges[e][0]], b = mesh.positions[topology.edges[e][1]];
    crease[e] = (a.x == 0.5f && b.x == 0.5f && a.y <= 0.5f && b.y <= 0.5f) ||
                (a.y == 0.5f && b.y == 0.5f && a.x <= 0.5f && b.x <= 0.5f);
  }
  const std::vector<uint8_t> corner = FindCorners(mesh, topology, crease, kPi / 4);
  EXPECT_EQ(std::count(corner.begin(), corner.end(), 1), 5);
  for (uint32_t v = 0; v < corner.size(); ++v) {
    const Vec3f& p = mesh.positions[v];
    const bool turn = p.x == 0.5f && p.y == 0.5f, of_sheet = (p.x == 0 || p.x == 1) && (p.y == 0 || p.y == 1);
    EXPECT_EQ(corner[v] != 0, turn || of_sheet);
  }
}

}  // namespace
}  // namespace lacerta
