#include "remesh/base_flips.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "draco_ext/remesh/decimated_input.h"
#include "draco_ext/remesh/remeshing.h"
#include "remesh/base_midpoints.h"
#include "remesh/growing_normal_mesh.h"
#include "remesh/reversal.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using lacerta::testing::BasePositions;
using lacerta::testing::PositionOf;
using lacerta::testing::RandomPointOn;

// A base of so many vertices, and with edges turned.
struct Flipped : testing::DecimatedInput {
  Flipped(const TriangleMesh& input, uint32_t num_vertices)
      : DecimatedInput(input, num_vertices), before(Domain()), after(before), positions(BasePositions(before, mesh)), num_turned(FlipBaseEdges(surface, &after, positions)) {}

  const BaseDomain before;
  BaseDomain after;
  const std::vector<Vec3f> positions;
  const size_t num_turned;
};

// Mean of what midpoints of the first level are off.
double FirstDistances(const Flipped& flipped, const BaseDomain& domain) {
  const MidpointsOver midpoints(domain.topology(), 0);
  PointsOnInput points = BaseOnInput(flipped.surface, domain, flipped.positions, midpoints.num_points());
  double sum = 0;
  for (uint32_t point = midpoints.num_base(); point < midpoints.num_points(); ++point) {
    FindMidpoint(flipped.surface, midpoints, point, &points);
    sum += std::fabs(points.distances[point]);
  }
  return sum;
}

int Irregularity(const Topology& topology) {
  int sum = 0;
  for (const int valence : topology.valence) sum += std::abs(valence - 6);
  return sum;
}

TEST(FlipBaseEdges, LeavesLessToCode) {
  for (const TriangleMesh& input : {shapes::BumpySphere(5), shapes::Torus(96, 48)}) {
    const Flipped flipped(input, 120);
    EXPECT_GT(flipped.num_turned, 3u);
    EXPECT_LT(flipped.num_turned, 60u);
    EXPECT_LT(FirstDistances(flipped, flipped.after), 0.99 * FirstDistances(flipped, flipped.before));
    EXPECT_LE(Irregularity(flipped.after.topology()), Irregularity(flipped.before.topology()));
    EXPECT_EQ(flipped.after.topology().num_edges(), flipped.before.topology().num_edges());
  }
}

TEST(FlipBaseEdges, TheDomainMapsBothWaysInAnyOrder) {
  for (const TriangleMesh& input : {shapes::BumpySphere(4), shapes::Torus(64, 32), shapes::GridWithBorder(40, 40, 0.3f)}) {
    Flipped flipped(input, 60);
    EXPECT_GT(flipped.num_turned, 0u);
    const uint32_t n = flipped.after.num_vertices();
    std::vector<uint32_t> vertex_map;
    for (uint32_t v = 0; v < n; ++v) vertex_map.push_back(n - 1 - v);
    std::vector<Triangle> triangles(flipped.after.triangles().rbegin(), flipped.after.triangles().rend());
    for (Triangle& t : triangles) {
      for (uint32_t& v : t) v = n - 1 - v;
      std::rotate(t.begin(), t.begin() + 1, t.end());
    }
    BaseDomain reordered = flipped.after;
    reordered.Reorder(vertex_map, triangles);
    std::mt19937 random(5);
    for (int i = 0; i < 1000; ++i) {
      const DomainPoint p = RandomPointOn(random() % flipped.mesh.triangles.size(), &random);
      const auto at = [&](const DomainPoint& q) { return PositionOf(flipped.mesh.positions, flipped.mesh.triangles[q.face], q.barycentric); };
      EXPECT_LT(Norm(at(flipped.after.ToInput(flipped.after.FromInput(p))) - at(p)), 1e-6);
      EXPECT_LT(Norm(at(reordered.ToInput(reordered.FromInput(p))) - at(p)), 1e-6);
      const DomainPoint first = flipped.after.FromInput(p), second = reordered.FromInput(p);
      EXPECT_EQ(flipped.after.triangles().size() - 1 - first.face, second.face);
    }
    for (uint32_t v = 0; v < n; ++v) EXPECT_EQ(reordered.topology().role[v], flipped.after.topology().role[n - 1 - v]);
  }
}

TEST(FlipBaseEdges, NothingIsFoldedThatIsPiercedOverIt) {
  for (const TriangleMesh& input : {shapes::BumpySphere(4), shapes::Torus(64, 32)}) {
    const Flipped flipped(input, 60);
    GrowingNormalMesh growing(flipped.surface, flipped.after, flipped.positions, PiercingOptions());
    for (int level = 0; level < 3; ++level) growing.AddLevel();
    EXPECT_LT(FindReversed(flipped.surface, growing.mesh()).share, 0.002);
  }
}

TEST(FlipBaseEdges, CurvesStay) {
  const Flipped flipped(shapes::GridWithBorder(40, 40, 0.3f), 60);
  const auto num_curves = [](const Topology& t) { return std::count(t.on_curve.begin(), t.on_curve.end(), 1); };
  EXPECT_EQ(num_curves(flipped.after.topology()), num_curves(flipped.before.topology()));
  EXPECT_EQ(flipped.after.topology().role, flipped.before.topology().role);
}

TEST(FlipBaseEdges, WhatIsFlatStays) { EXPECT_EQ(Flipped(shapes::GridWithBorder(20, 20), 30).num_turned, 0u); }

TEST(FlipBaseEdges, IsTheSameOnOneThread) {
  const Flipped flipped(shapes::BumpySphere(5), 100);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(Flipped(shapes::BumpySphere(5), 100).after.triangles(), flipped.after.triangles());
}

}  // namespace
}  // namespace lacerta
