#include "encoder/surface_target.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>

#include "draco_ext/encoder/tagged_meshes.h"
#include "draco_ext/remesh/remeshing.h"

namespace lacerta {
namespace {

using lacerta::testing::Remesh;

TEST(SpreadStencils, IsTheTransposeOfTheStencils) {
  for (const TriangleMesh& mesh : {shapes::Icosphere(1), shapes::Torus(8, 5), shapes::GridWithBorder(4, 3), shapes::BumpySphere(2)}) {
    Topology topology = BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles).value();
    const StencilTable table(topology);
    for (int level = 0; level < 2; ++level, topology = Refine(topology)) {
      const StencilSpread spread = SpreadStencils(topology, table);
      ASSERT_EQ(spread.first.size(), topology.num_vertices + 1u);
      ASSERT_EQ(spread.first.back(), spread.edges.size());
      std::vector<std::map<uint32_t, double>> by_edge(topology.num_edges()), expected(topology.num_edges());
      for (uint32_t v = 0; v < topology.num_vertices; ++v) {
        for (uint32_t k = spread.first[v]; k < spread.first[v + 1]; ++k) by_edge.at(spread.edges[k])[v] += spread.weights[k];
      }
      for (uint32_t e = 0; e < topology.num_edges(); ++e) {
        VisitStencil(topology, table, e, [&](uint32_t v, float weight) { expected[e][v] += weight; });
      }
      EXPECT_EQ(by_edge, expected);
    }
  }
}

TEST(SurfaceTarget, HasTheShapesItPromises) {
  const NormalMesh mesh = Remesh(shapes::BumpySphere(4), 50, 3);
  const SurfaceTarget target = MakeSurfaceTarget(mesh);
  ASSERT_EQ(target.num_levels(), 3);
  ASSERT_EQ(target.topologies.size(), 4u);
  ASSERT_EQ(target.masses.size(), 4u);
  EXPECT_EQ(target.topologies[0].triangles, mesh.mesh.base_triangles);
  EXPECT_EQ(target.topologies[3].num_vertices, mesh.mesh.positions.size());
  EXPECT_EQ(target.points.size(), mesh.mesh.positions.size());
  EXPECT_EQ(target.normals.size(), mesh.mesh.positions.size());
  EXPECT_EQ(target.piercing, mesh.piercing);
}

TEST(SurfaceTarget, MassesSumToOneOnEveryLevel) {
  for (const TriangleMesh& input : {shapes::BumpySphere(4), shapes::Torus(48, 24), shapes::TwoHoledPlate(6)}) {
    const SurfaceTarget target = MakeSurfaceTarget(Remesh(input, 60, 3));
    for (size_t level = 0; level < target.masses.size(); ++level) {
      const std::vector<float>& masses = target.masses[level];
      ASSERT_EQ(masses.size(), target.topologies[level].num_vertices);
      EXPECT_NEAR(std::accumulate(masses.begin(), masses.end(), 0.0), 1, 1e-5);
      EXPECT_GE(*std::min_element(masses.begin(), masses.end()), 0);
      EXPECT_LT(*std::max_element(masses.begin(), masses.end()), 0.2);
    }
  }
}

TEST(SurfaceTarget, MassIsTheShareOfTheArea) {
  NormalMesh mesh;  // two triangles of areas 1/2 and 3/2
  mesh.mesh = {{{0, 1, 2}, {2, 1, 3}}, 4, 0, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 2, 0}}};
  mesh.surface_normals.assign(4, {0, 0, 1});
  const SurfaceTarget target = MakeSurfaceTarget(mesh);
  const std::vector<float> expected = {1 / 12.0f, 1 / 3.0f, 1 / 3.0f, 1 / 4.0f};
  for (size_t v = 0; v < 4; ++v) EXPECT_NEAR(target.masses[0][v], expected[v], 1e-6);
}

TEST(SurfaceTarget, TakesPointsAsTheyAre) {
  NormalMesh mesh = Remesh(shapes::BumpySphere(3), 40, 2);
  for (uint32_t v = 0; v < 40; ++v) mesh.mesh.positions[v] += Vec3f{0.1f, 0, 0};
  const SurfaceTarget target = MakeSurfaceTarget(mesh);
  for (size_t v = 0; v < target.points.size(); ++v) {
    EXPECT_EQ(target.points[v], mesh.mesh.positions[v]);
  }
}

TEST(SurfaceTarget, TwinsAreTheVerticesThatLieTogether) {
  const NormalMesh mesh = lacerta::testing::Bent(lacerta::testing::ThreeSheets(), 3);
  const SurfaceTarget target = MakeSurfaceTarget(mesh);
  ASSERT_EQ(target.next_twin.size(), target.points.size());
  int twins = 0;
  for (size_t v = 0; v < target.points.size(); ++v) {
    const uint32_t next = target.next_twin[v];
    if (next == kNone) continue;
    ++twins;
    EXPECT_GT(next, v);
    EXPECT_EQ(target.points[next], target.points[v]);
  }
  EXPECT_EQ(twins, 2 * (2 + 1 + 2 + 4));  // two for each vertex on the common curve
  EXPECT_TRUE(MakeSurfaceTarget(lacerta::testing::Bent(lacerta::testing::SquareWithCorners(), 2)).next_twin.empty());
}

TEST(SurfaceTarget, StillTrianglesHaveNoMass) {
  const SurfaceTarget target = MakeSurfaceTarget(lacerta::testing::Bent(lacerta::testing::OctahedronBesideStillSheets(), 2));
  for (const std::vector<float>& masses : target.masses) {
    EXPECT_NEAR(std::accumulate(masses.begin(), masses.end(), 0.0), 1, 1e-5);
    for (size_t v = 6; v < 11; ++v) EXPECT_EQ(masses[v], 0);
    for (size_t v = 0; v < 6; ++v) EXPECT_GT(masses[v], 0);
  }
}

}  // namespace
}  // namespace lacerta
