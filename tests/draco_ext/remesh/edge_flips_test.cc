#include "remesh/edge_flips.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdlib>

#include "lacerta/surface_distance.h"
#include "remesh/mesh_neighbors.h"
#include "remesh/simplify.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

// Two planes that meet in the edge from vertex 1 to 3, of that height; and two triangles over the same vertices that cut it off.
TriangleMesh Roof(float height) { return {{{-1, 0.5f, 0}, {0, 0, height}, {1, 0.5f, 0}, {0, 1, height}}, {{0, 1, 3}, {2, 3, 1}}}; }
TriangleMesh CutOff(float height) { return {Roof(height).positions, {{0, 1, 2}, {2, 3, 0}}}; }

size_t Flip(const TriangleMesh& input, const RateModel& rate, TriangleMesh* mesh) { return EdgeFlipper(FitTarget(input, 2000), mesh).Flip(rate); }

double Distance(const TriangleMesh& a, const TriangleMesh& b) { return MeasureSurfaceDistance(a, b, SurfaceDistanceOptions::RmsOnly(20000)).value().Rms(); }

TEST(EdgeFlipsTest, AnEdgeAcrossACreaseIsTurnedIntoIt) {
  TriangleMesh mesh = CutOff(0.4f);
  EXPECT_GT(Distance(Roof(0.4f), mesh), 0.05);
  EXPECT_EQ(Flip(Roof(0.4f), RateModel(), &mesh), 1u);
  EXPECT_LT(Distance(Roof(0.4f), mesh), 1e-5);
  EXPECT_EQ(Flip(Roof(0.4f), RateModel(), &mesh), 0u);
}

TEST(EdgeFlipsTest, NewTrianglesDoNotLookAway) {
  TriangleMesh mesh = CutOff(8);  // steep: they would stand across the old ones
  EXPECT_EQ(Flip(Roof(8), RateModel(), &mesh), 0u);
}

TEST(EdgeFlipsTest, BitsDecideWhereTheDistanceDoesNot) {
  // A sheet of 4 x 4 vertices, regular but for one edge inside.
  TriangleMesh regular;
  for (int i = 0; i < 16; ++i) regular.positions.push_back({static_cast<float>(i % 4), static_cast<float>(i / 4), 0});
  for (uint32_t y = 0; y < 3; ++y) {
    for (uint32_t x = 0; x < 3; ++x) {
      const uint32_t v = 4 * y + x;
      regular.triangles.push_back({v, v + 1, v + 5});
      regular.triangles.push_back({v, v + 5, v + 4});
    }
  }
  TriangleMesh turned = regular;
  turned.triangles[8] = {5, 6, 9};
  turned.triangles[9] = {6, 10, 9};
  TriangleMesh mesh = turned;
  EXPECT_EQ(Flip(regular, RateModel(), &mesh), 0u);
  EXPECT_EQ(Flip(regular, {0.1, 1e-6}, &mesh), 1u);
  EXPECT_EQ(MeshNeighbors(mesh).edges, MeshNeighbors(regular).edges);
  EXPECT_LT(Distance(regular, mesh), 1e-6);
}

TEST(EdgeFlipsTest, EdgesThatAreNoDiagonalsStay) {
  TriangleMesh fan = CutOff(0.4f);  // a third triangle at the edge
  fan.positions.push_back({0, 0.5f, -1});
  fan.triangles.push_back({0, 2, 4});
  TriangleMesh mesh = fan;
  EXPECT_EQ(Flip(Roof(0.4f), RateModel(), &mesh), 0u);
  mesh = CutOff(0.4f);  // two that are oriented against each other
  std::swap(mesh.triangles[1][0], mesh.triangles[1][1]);
  EXPECT_EQ(Flip(Roof(0.4f), RateModel(), &mesh), 0u);
  mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};  // all corners are joined already
  EXPECT_EQ(Flip(shapes::Icosphere(2), {0.1, 1}, &mesh), 0u);
}

RateModel UsualRate(const TriangleMesh& input, const TriangleMesh& mesh) {
  return RateModel::For(0.28 * FitTarget(input, 2000).DistortionAt(mesh), mesh.positions.size());
}

// Of positions and connectivity, about.
double Bits(const TriangleMesh& mesh, const RateModel& rate) {
  const MeshNeighbors neighbors(mesh);
  double bits = 0;
  for (const auto& [a, b, c, d] : neighbors.flaps) {
    const auto at = [&, &positions = mesh.positions](uint32_t v) { return Vec3Cast<double>(positions[v]); };
    bits += rate.BitsOfFlap(SquaredNorm(at(a) + at(b) - at(c) - at(d)));
  }
  for (uint32_t v = 0; v < mesh.positions.size(); ++v) bits += std::abs(static_cast<int>(neighbors.vertex_edges[v].size()) - 6);
  return bits;
}

TEST(EdgeFlipsTest, SimplifiedMeshesTakeFewerBitsForLittleDistanceAndStayClosed) {
  for (const TriangleMesh& input : {shapes::BumpySphere(5, 0.2f), shapes::Torus(80, 40, 1.0f, 0.4f)}) {
    TriangleMesh mesh = SimplificationSequence(input).MeshWith(600);
    const TriangleMesh before = mesh;
    const RateModel rate = UsualRate(input, mesh);
    const size_t flipped = Flip(input, rate, &mesh);
    EXPECT_GT(flipped, 5u);
    EXPECT_LT(flipped, 200u);
    EXPECT_EQ(mesh.positions, before.positions);
    EXPECT_LT(Bits(mesh, rate), 0.99 * Bits(before, rate));
    EXPECT_GT(Bits(mesh, rate), 0.8 * Bits(before, rate));
    const double gain = 20 * std::log10(Distance(input, before) / Distance(input, mesh));
    EXPECT_GT(gain, -0.5);
    EXPECT_LT(gain, 1);
    const MeshNeighbors neighbors(mesh);
    EXPECT_EQ(neighbors.flaps.size(), neighbors.edges.size());
    EXPECT_EQ(2 * neighbors.edges.size(), 3 * mesh.triangles.size());
  }
}

TEST(EdgeFlipsTest, KnowsHowFarTheMeshIsBeforeAndAfter) {
  for (const TriangleMesh& input : {shapes::BumpySphere(5, 0.2f), shapes::Torus(80, 40, 1.0f, 0.4f)}) {
    TriangleMesh mesh = SimplificationSequence(input).MeshWith(600);
    const FitTarget target(input, 6000);
    EdgeFlipper flipper(target, &mesh);
    for (const bool is_flipped : {false, true}) {
      if (is_flipped) {
        EXPECT_GT(flipper.Flip(UsualRate(input, mesh)), 5u);
      }
      const double distortion = target.DistortionAt(mesh);
      EXPECT_GT(flipper.Distortion(), 0.95 * distortion);
      EXPECT_LT(flipper.Distortion(), 1.35 * distortion);
      EXPECT_NEAR(flipper.Distortion(), EdgeFlipper(target, &mesh).Distortion(), 1e-3 * distortion);  // samples stay with the faces that are turned
    }
  }
  TriangleMesh flat{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};  // no area
  const TriangleMesh sphere = shapes::Icosphere(2);
  EXPECT_GT(EdgeFlipper(FitTarget(sphere, 2000), &flat).Distortion(), 4);
}

TEST(EdgeFlipsTest, SimplifiedMeshesComeNearerWhereBitsDoNotMatter) {
  for (const TriangleMesh& input : {shapes::BumpySphere(5, 0.2f), shapes::Torus(80, 40, 1.0f, 0.4f)}) {
    TriangleMesh mesh = SimplificationSequence(input).MeshWith(600);
    const TriangleMesh before = mesh;
    EXPECT_GT(Flip(input, RateModel(), &mesh), 5u);
    const double gain = 20 * std::log10(Distance(input, before) / Distance(input, mesh));
    EXPECT_GT(gain, 0.02);
    EXPECT_LT(gain, 2);
  }
}

TEST(EdgeFlipsTest, IsTheSameOnAnyNumberOfThreads) {
  const TriangleMesh input = shapes::BumpySphere(4, 0.2f), simplified = SimplificationSequence(input).MeshWith(300);
  const RateModel rate = UsualRate(input, simplified);
  TriangleMesh alone = simplified, together = simplified;
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    Flip(input, rate, &alone);
  }
  Flip(input, rate, &together);
  EXPECT_EQ(alone.triangles, together.triangles);
  EXPECT_NE(alone.triangles, simplified.triangles);
}

}  // namespace
}  // namespace lacerta
