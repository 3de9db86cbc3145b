#include "remesh/base_midpoints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/butterfly.h"
#include "draco_ext/remesh/decimated_input.h"
#include "draco_ext/remesh/remeshing.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using lacerta::testing::BasePositions;
using lacerta::testing::TopologyOf;

TEST(MidpointsOver, PredictsAsTheButterflyDoesLevelByLevel) {
  for (const TriangleMesh& mesh : {shapes::BumpySphere(2), shapes::Torus(12, 7), shapes::GridWithBorder(6, 6, 0.3f)}) {
    Topology level = TopologyOf(mesh);
    const MidpointsOver midpoints(level, 4 * level.num_vertices + 4);
    ASSERT_EQ(midpoints.level_ends.size(), 3u);
    std::vector<Vec3f> expected = mesh.positions;
    std::vector<Vec3d> at;
    for (const Vec3f& p : mesh.positions) at.push_back(Vec3Cast<double>(p));
    at.resize(midpoints.num_points());
    midpoints.ForLevels([&](uint32_t point) { at[point] = midpoints.Predicted(point, at); });
    for (int i = 0; i < 2; ++i) {
      PredictMidpoints(level, StencilTable(level), &expected);
      level = Refine(level);
    }
    ASSERT_EQ(midpoints.num_points(), expected.size());
    for (size_t v = 0; v < expected.size(); ++v) EXPECT_LT(Norm(at[v] - Vec3Cast<double>(expected[v])), 1e-5) << v;
  }
}

TEST(MidpointsOver, NamesTheBaseFacesAndWeighsLevels) {
  const Topology base = TopologyOf(shapes::GridWithBorder(6, 6, 0.3f));
  const MidpointsOver midpoints(base, base.num_vertices + base.num_edges());
  ASSERT_EQ(midpoints.level_ends.size(), 3u);
  std::vector<size_t> on_face(base.num_faces());
  for (uint32_t point = midpoints.num_base(); point < midpoints.num_points(); ++point) {
    const MidpointsOver::Midpoint& midpoint = midpoints.midpoint(point);
    const bool is_first_level = point < midpoints.level_ends[1];
    if (is_first_level) {
      EXPECT_EQ(midpoint.faces, base.edge_faces[point - midpoints.num_base()]);
    }
    const bool is_curve = midpoint.faces[1] == kNone;
    EXPECT_EQ(midpoint.weight, is_curve ? 0.0 : is_first_level ? 1.0 : 2.0);
    on_face[midpoint.faces[0]] += 1;
    if (midpoint.faces[1] != kNone && midpoint.faces[1] != midpoint.faces[0]) on_face[midpoint.faces[1]] += 1;
  }
  for (const size_t count : on_face) EXPECT_EQ(count, 3u + 6u + 3u);  // its edges, their halves and those within
}

struct OnSphere : testing::DecimatedInput {
  OnSphere() : DecimatedInput(shapes::Icosphere(4), 60), domain(Domain()) {}

  const BaseDomain domain;
};

TEST(FindMidpoint, FindsTheInputAndItsSide) {
  const OnSphere sphere;
  const MidpointsOver midpoints(sphere.domain.topology(), 0);
  PointsOnInput points = BaseOnInput(sphere.surface, sphere.domain, BasePositions(sphere.domain, sphere.mesh), midpoints.num_points());
  double most = 0;
  for (uint32_t point = midpoints.num_base(); point < midpoints.num_points(); ++point) {
    EXPECT_TRUE(FindMidpoint(sphere.surface, midpoints, point, &points));
    const Vec3d predicted = midpoints.Predicted(point, points.at);
    EXPECT_NEAR(Norm(points.at[point]), 1, 5e-3);
    EXPECT_NEAR(points.distances[point], Norm(predicted) - 1, 5e-3);
    most = std::max(most, std::fabs(points.distances[point]));
  }
  EXPECT_GT(most, 0.005);
}

TEST(FindMidpoint, TellsAnotherSheet) {
  const OnSphere sphere;
  const MidpointsOver midpoints(sphere.domain.topology(), 0);
  PointsOnInput points = BaseOnInput(sphere.surface, sphere.domain, BasePositions(sphere.domain, sphere.mesh), midpoints.num_points());
  for (Vec3d& normal : points.normals) normal = normal * -1.0;
  const uint32_t point = midpoints.num_base();
  const auto& [a, b] = midpoints.midpoint(point).ends;
  EXPECT_FALSE(FindMidpoint(sphere.surface, midpoints, point, &points));
  EXPECT_NEAR(points.distances[point], Norm(points.at[a] - points.at[b]) / 2, 1e-12);
}

TEST(CodingBits, GrowWithTheDistanceAndAreNoneWhereAllIsFlat) {
  const OnSphere sphere;
  const MidpointsOver midpoints(sphere.domain.topology(), 0);
  PointsOnInput points = BaseOnInput(sphere.surface, sphere.domain, BasePositions(sphere.domain, sphere.mesh), midpoints.num_points());
  EXPECT_TRUE(CodingBits(midpoints, points).is_nothing());
  double mean = 0;
  for (uint32_t point = midpoints.num_base(); point < midpoints.num_points(); ++point) {
    FindMidpoint(sphere.surface, midpoints, point, &points);
    mean += std::fabs(points.distances[point]) / (midpoints.num_points() - midpoints.num_base());
  }
  const CodingBits bits(midpoints, points);
  EXPECT_FALSE(bits.is_nothing());
  EXPECT_EQ(bits.Of(0), 0);
  EXPECT_NEAR(bits.Of(mean * mean / 4), 0.5, 1e-9);  // at half the mean distance
  EXPECT_NEAR(bits.Of(100 * mean * mean), 0.5 * std::log2(401), 1e-9);
  EXPECT_NEAR(bits.Slope(0) / bits.Slope(mean * mean / 4), 2, 1e-9);
}

TEST(Flaps, AreOfAllEdgesOfTwoFaces) {
  const TriangleMesh mesh = shapes::GridWithBorder(6, 6);
  const Topology base = TopologyOf(mesh);
  std::vector<Vec3d> at;
  for (const Vec3f& p : mesh.positions) at.push_back(Vec3Cast<double>(p));
  const std::vector<Flap> flaps = FlapsOf(base);
  EXPECT_EQ(flaps.size(), static_cast<size_t>(std::count(base.on_curve.begin(), base.on_curve.end(), 0)));
  for (const Flap& flap : flaps) EXPECT_LT(Norm(OffParallelogram(flap, at)), 1e-6);  // a grid is made of them
}

}  // namespace
}  // namespace lacerta
