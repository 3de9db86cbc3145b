#include "baselines/single_rate.h"

#include <gmock/gmock.h>

#include <cmath>

#include "lacerta/surface_distance.h"
#include "shapes/shapes.h"

namespace lacerta::baselines {
namespace {

TEST(SingleRate, PointsComeBackExactly) {
  for (const TriangleMesh& mesh : {shapes::BumpySphere(3), shapes::GridWithBorder(5, 7)}) {
    const Topology t = BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles).value();
    std::vector<Point> points;
    for (const Vec3f& p : mesh.positions) {
      points.push_back(
          {static_cast<int32_t>(900 * p.x), static_cast<int32_t>(900 * p.y), static_cast<int32_t>(900 * p.z)});
    }
    EXPECT_EQ(DecodeByParallelograms(t, EncodeByParallelograms(t, points)), points);
  }
}

// A flat regular grid lies where parallelograms say: next to nothing is left.
TEST(SingleRate, FlatGridsCostAlmostNothing) {
  const TriangleMesh grid = shapes::GridWithBorder(32, 32);
  const Topology t = BuildTopology(static_cast<uint32_t>(grid.positions.size()), grid.triangles).value();
  std::vector<Point> points;
  for (const Vec3f& p : grid.positions)
    points.push_back({static_cast<int32_t>(32 * p.x), static_cast<int32_t>(32 * p.y), 0});
  EXPECT_LT(8.0 * static_cast<double>(EncodeByParallelograms(t, points).size()), 1.5 * t.num_vertices);
}

TEST(SingleRate, ErrorsFollowTheLattice) {
  const TriangleMesh mesh = shapes::BumpySphere(4);
  size_t last_bytes = 0;
  for (const int bits : {6, 8, 10}) {
    const SingleRateMesh coded = CodeSingleRate(mesh, bits).value();
    EXPECT_EQ(coded.mesh.triangles.size(), mesh.triangles.size());
    const double step = std::ldexp(2.2, -bits);  // of the longest side
    const double error =
        MeasureSurfaceDistance(mesh, coded.mesh, SurfaceDistanceOptions::RmsOnly(20'000)).value().Rms();
    EXPECT_LT(error, 0.6 * step);  // a sqrt(12)th of the step in one direction
    EXPECT_GT(error, 0.05 * step);
    EXPECT_GT(coded.bytes, last_bytes + mesh.positions.size() / 8);
    last_bytes = coded.bytes;
  }
  EXPECT_LT(8.0 * static_cast<double>(last_bytes), 30.0 * static_cast<double>(mesh.positions.size()));
  EXPECT_EQ(CodeSingleRate(mesh, 0).status().code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace lacerta::baselines
