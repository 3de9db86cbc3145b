#include "remesh/distance_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lacerta/surface_distance.h"
#include "remesh/simplify.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

double Value(const DistanceModel& model) { return (model.forward + model.backward) / 2; }

TEST(DistanceModelTest, SolvesSymmetricSystems) {
  Symmetric3 m;
  m.AddOuter({1, 2, 3}, 2);
  m.AddOuter({-1, 0, 1}, 3);
  m.AddScaledIdentity(0.5);
  EXPECT_NEAR(m.Trace(), 2 * 14 + 3 * 2 + 1.5, 1e-12);
  const Vec3d x{0.3, -2, 5};
  EXPECT_LT(Norm(m.Solve(m * x) - x), 1e-9);
  EXPECT_EQ(Symmetric3().Solve({1, 2, 3}), Vec3d());
}

TEST(DistanceModelTest, KnowsTheDistanceOfSpheres) {
  const TriangleMesh mesh = shapes::Icosphere(4), larger = shapes::Icosphere(4, 1.1f);
  const FitTarget target(mesh, 4000);
  const DistanceModel model = target.ModelAt(larger, MeshNeighbors(larger));
  EXPECT_NEAR(std::sqrt(model.forward), 0.1, 0.001);
  EXPECT_NEAR(std::sqrt(model.backward), 0.1, 0.001);
  EXPECT_NEAR(target.diagonal(), 2 * std::sqrt(3.0), 0.05);
}

TEST(DistanceModelTest, AgreesWithTheMeter) {
  const TriangleMesh mesh = shapes::BumpySphere(4, 0.2f);
  const TriangleMesh simplified = SimplificationSequence(mesh).MeshWith(300);
  const DistanceModel model = FitTarget(mesh, 20000).ModelAt(simplified, MeshNeighbors(simplified));
  const SurfaceDistance distance = MeasureSurfaceDistance(mesh, simplified, SurfaceDistanceOptions::RmsOnly(20000)).value();
  EXPECT_NEAR(std::sqrt(model.forward), distance.forward.rms, 0.03 * distance.forward.rms);
  EXPECT_NEAR(std::sqrt(model.backward), distance.backward.rms, 0.03 * distance.backward.rms);
}

// Alone it is measured by as few samples as the target has, even where the mesh has more triangles.
TEST(DistanceModelTest, DistortionAloneAgreesWithTheMeter) {
  const TriangleMesh mesh = shapes::BumpySphere(5, 0.2f);
  const FitTarget target(mesh, 8000);
  for (const TriangleMesh& other : {SimplificationSequence(mesh).MeshWith(300), shapes::BumpySphere(5, 0.21f)}) {
    const SurfaceDistance distance = MeasureSurfaceDistance(mesh, other, SurfaceDistanceOptions::RmsOnly(20000)).value();
    EXPECT_NEAR(std::sqrt(target.DistortionAt(other)), distance.Rms(), 0.03 * distance.Rms());
  }
  EXPECT_LT(std::sqrt(target.DistortionAt(mesh)), 1e-6 * target.diagonal());
}

// With a few hundred samples, of which an area of 1 % would have a handful.
TEST(DistanceModelTest, SeesSmallPartsOfManyFaces) {
  const TriangleMesh mesh = shapes::SpheresOverAPlate(30, 0.005f), larger = shapes::SpheresOverAPlate(30, 0.006f);
  const SurfaceDistance distance = MeasureSurfaceDistance(mesh, larger, SurfaceDistanceOptions::RmsOnly(200000)).value();
  for (const size_t samples : {400, 500, 600}) {
    const double forward = std::sqrt(FitTarget(mesh, samples).ModelAt(larger, MeshNeighbors(larger)).forward);
    EXPECT_NEAR(forward, distance.forward.rms, 0.15 * distance.forward.rms) << samples;
  }
}

// As on a lattice that is too coarse for every triangle.
TEST(DistanceModelTest, TakesAMeshWithoutAreaForFarOff) {
  const TriangleMesh mesh = shapes::Icosphere(2);
  const TriangleMesh without_area{{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}, {{0, 1, 2}}};
  const FitTarget target(mesh, 2000);
  EXPECT_DOUBLE_EQ(target.ModelAt(without_area, MeshNeighbors(without_area)).backward, target.diagonal() * target.diagonal());
  EXPECT_DOUBLE_EQ(target.DistortionAt(without_area), target.diagonal() * target.diagonal());
}

TEST(DistanceModelTest, ForetellsWhatAMoveChanges) {
  const TriangleMesh mesh = shapes::BumpySphere(4, 0.2f);
  TriangleMesh moved = SimplificationSequence(mesh).MeshWith(200);
  const MeshNeighbors neighbors(moved);
  const FitTarget target(mesh, 20000);
  const DistanceModel model = target.ModelAt(moved, neighbors);
  double slope = 0, curvature = 0;  // along minus the gradient
  for (const Vec3d& g : model.gradient) slope -= 2 * SquaredNorm(g);
  for (size_t v = 0; v < model.gradient.size(); ++v) curvature += Dot(model.gradient[v], model.diagonal[v] * model.gradient[v]);
  for (size_t e = 0; e < neighbors.edges.size(); ++e) {
    curvature += 2 * Dot(model.gradient[neighbors.edges[e][0]], model.off_diagonal[e] * model.gradient[neighbors.edges[e][1]]);
  }
  const double length = -slope / (2 * curvature);  // to the least value
  for (size_t v = 0; v < model.gradient.size(); ++v) moved.positions[v] -= Vec3Cast<float>(model.gradient[v] * length);
  const double foretold = Value(model) + slope * length + curvature * length * length;
  EXPECT_LT(foretold, 0.8 * Value(model));
  EXPECT_NEAR(Value(target.ModelAt(moved, neighbors)), foretold, 0.15 * (Value(model) - foretold));
}

}  // namespace
}  // namespace lacerta
