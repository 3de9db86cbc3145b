#include "remesh/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <string>

#include "draco_ext/remesh/profiles.h"
#include "lacerta/clean.h"
#include "remesh/bends.h"
#include "remesh/manifold.h"
#include "shapes/real_meshes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

struct Found {
  TriangleMesh mesh;
  Topology topology;
  Features features;

  std::ptrdiff_t creases() const { return std::count(features.crease.begin(), features.crease.end(), 1); }
  std::ptrdiff_t corners() const { return std::count(features.corner.begin(), features.corner.end(), 1); }
};

// With what holds on any mesh.
Found FindOn(const TriangleMesh& mesh) {
  StatusOr<Topology> built = BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles);
  EXPECT_TRUE(built.ok()) << built.status().message();
  Found found = {mesh, std::move(built).value(), {}};
  const Topology& t = found.topology;
  found.features = DetectFeatures(mesh, t);
  EXPECT_EQ(found.features.crease.size(), t.num_edges());
  EXPECT_EQ(found.features.corner.size(), t.num_vertices);
  const std::vector<double> bends = EdgeBends(mesh, t);
  std::vector<int> curves(t.num_vertices, 0);
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    EXPECT_FALSE(t.is_border(e) && found.features.crease[e] != 0);
    for (const uint32_t v : t.edges[e]) curves[v] += t.is_border(e) || found.features.crease[e] != 0;
  }
  for (uint32_t v = 0; v < t.num_vertices; ++v) EXPECT_TRUE(found.features.corner[v] == 0 || curves[v] == 2);
  for (const auto& fe : t.face_edges) {
    if (!found.features.crease[fe[0]] || !found.features.crease[fe[1]] || !found.features.crease[fe[2]]) continue;
    for (const uint32_t e : fe) EXPECT_GE(bends[e], 59.99 * kDegree);
  }
  return found;
}

TEST(DetectFeatures, ExactlyTheEdgesOfACube) {
  for (const int n : {1, 2, 8, 30}) {
    const Found found = FindOn(shapes::CreasedBox(n));
    EXPECT_EQ(found.creases(), 12 * n);
    const std::vector<double> bends = EdgeBends(found.mesh, found.topology);
    for (uint32_t e = 0; e < bends.size(); ++e) EXPECT_EQ(found.features.crease[e] != 0, bends[e] > 1.5);
    EXPECT_EQ(found.corners(), 0);  // three creases meet there
  }
  EXPECT_EQ(FindOn(shapes::TwoHoledPlate(4)).creases(), 240);
  EXPECT_EQ(FindOn(shapes::ThinPlate(8)).creases(), 96);
}

TEST(DetectFeatures, NoneOnSmoothSurfaces) {
  EXPECT_EQ(FindOn(shapes::Icosphere(3)).creases(), 0);
  EXPECT_EQ(FindOn(shapes::Torus(48, 24)).creases(), 0);
  EXPECT_EQ(FindOn(shapes::Torus(12, 8)).creases(), 0);  // bends of 45 degrees, but everywhere
  EXPECT_EQ(FindOn(shapes::SpikySphere(4)).creases(), 0);
  for (const float noise : {0.001f, 0.005f, 0.02f}) EXPECT_EQ(FindOn(shapes::BumpySphere(4, 0.1f, noise)).creases(), 0);
}

TEST(DetectFeatures, AFoldIsACreaseAndARoundedOneIsNot) {
  const auto creases = [](const std::vector<double>& turns) { return FindOn(testing::DrawnOut(turns, 20)).creases(); };
  EXPECT_EQ(creases({0, 0, 35, 0, 0}), 20);
  EXPECT_EQ(creases({0, 0, -90, 0, 0}), 20);
  EXPECT_EQ(creases({0, 0, 15, 0, 0}), 0);
  EXPECT_EQ(creases({0, 0, 22, 22, 22, 22, 0, 0}), 0);
  EXPECT_EQ(creases({0, 0, 30, 30, 30, 0, 0}), 0);
  EXPECT_EQ(creases({2, 2, 35, 2, 2}), 20);  // between two curved sheets
  EXPECT_EQ(creases({0, 0, 60, 0, 0, -60, 0, 0}), 40);
}

TEST(DetectFeatures, WhatCountsIsTheBendAgainstTheUsualOne) {
  const auto creases = [](float noise) {
    TriangleMesh mesh = testing::DrawnOut({0, 0, 0, 0, 0, 45, 0, 0, 0, 0, 0}, 40);
    std::mt19937 random(1);
    for (Vec3f& p : mesh.positions) {
      for (int k = 0; k < 3; ++k) p[k] += noise * (static_cast<float>(random()) / 4294967296.0f - 0.5f);
    }
    return FindOn(mesh).creases();
  };
  EXPECT_EQ(creases(0.02f), 40);
  EXPECT_EQ(creases(0.6f), 0);
}

TEST(DetectFeatures, CornersOfASheet) {
  const Found flat = FindOn(shapes::GridWithBorder(8, 8));
  EXPECT_EQ(flat.creases(), 0);
  EXPECT_EQ(flat.corners(), 4);
  // The fold ends on the border, where three curve edges meet; the sheet keeps its corners.
  EXPECT_EQ(FindOn(testing::DrawnOut({0, 0, 35, 0, 0}, 20)).corners(), 4);
}

TEST(DetectFeatures, DoesNotDependOnTheSize) {
  TriangleMesh mesh = testing::DrawnOut({0, 0, 35, 0, -70, 0, 0}, 20);
  const Features once = FindOn(mesh).features;
  for (Vec3f& p : mesh.positions) p *= 1024.0f;
  EXPECT_EQ(FindOn(mesh).features.crease, once.crease);
  for (Vec3f& p : mesh.positions) p *= 1.0f / (1 << 24);
  EXPECT_EQ(FindOn(mesh).features.crease, once.crease);
}

TEST(DetectFeatures, LinesOfPartsAndFewOnScans) {
  struct Expected {
    std::string name;
    std::ptrdiff_t at_least, at_most;
  };
  const std::vector<Expected> expected = {{"fandisk.ply", 700, 770},
                                          {"beetle.ply", 280, 400},
                                          {"crank.ply", 4900, 6000},
                                          // At most 0.5 % of the edges.
                                          {"rabbit_scan.ply", 0, 20},
                                          {"bunny_closed.ply", 0, 500},
                                          {"dragon_50k.ply", 0, 750},
                                          {"armadillo.ply", 0, 100},
                                          {"horse.ply", 0, 700},
                                          {"lion_statue.ply", 0, 100},
                                          {"screwdriver.ply", 0, 400}};
  for (const auto& [name, at_least, at_most] : expected) {
    const std::optional<TriangleMesh> mesh = testing::RealMesh(name);
    if (!mesh) GTEST_SKIP() << name << " is not there";
    const StatusOr<CleanedMesh> cleaned = Clean(*mesh);
    const Found found = FindOn(MakeManifold(cleaned.value().mesh).mesh);
    EXPECT_GE(found.creases(), at_least) << name;
    EXPECT_LE(found.creases(), at_most) << name;
  }
}

}  // namespace
}  // namespace lacerta
