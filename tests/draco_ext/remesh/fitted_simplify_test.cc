#include "remesh/fitted_simplify.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "lacerta/surface_distance.h"
#include "remesh/mesh_fit.h"
#include "remesh/mesh_neighbors.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

constexpr FittedSimplification::Options kOptions = {1600, 2000, 20000};

bool AreEqual(const TriangleMesh& a, const TriangleMesh& b) {
  return a.triangles == b.triangles && a.positions.size() == b.positions.size() &&
         std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(Vec3f)) == 0;
}

double PsnrOfFitted(const TriangleMesh& input, TriangleMesh mesh) {
  FitToSurface(FitTarget(input, 20000), MeshNeighbors(mesh), RateModel(), 3, &mesh);
  return Psnr(MeasureSurfaceDistance(input, mesh, SurfaceDistanceOptions::RmsOnly(30000)).value().Rms(), BoundingBoxDiagonal(input));
}

TEST(FittedSimplificationTest, IsNearerThanASimplifiedMeshWhereBothAreFitted) {
  for (const TriangleMesh& mesh : {shapes::BumpySphere(5, 0.2f), shapes::BumpySphere(5, 0.1f, 0.0005f)}) {
    const SimplificationSequence sequence(mesh);
    FitTarget target(mesh, 4000);
    FittedSimplification fitted(sequence, kOptions, &target);
    const double gain = PsnrOfFitted(mesh, fitted.MeshWith(800)) - PsnrOfFitted(mesh, sequence.MeshWith(800));
    EXPECT_GT(gain, 0.2);
    EXPECT_LT(gain, 2);
  }
}

TEST(FittedSimplificationTest, HasEverySizeWhateverWasAskedForBefore) {
  const TriangleMesh mesh = shapes::BumpySphere(5, 0.2f);
  const SimplificationSequence sequence(mesh);
  FitTarget target(mesh, 4000), other_target(mesh, 4000);
  FittedSimplification down(sequence, kOptions, &target), up(sequence, kOptions, &other_target);
  std::vector<TriangleMesh> meshes;
  for (const uint32_t n : {1600u, 1454u, 1000u, 400u}) {
    meshes.push_back(down.MeshWith(n));
    EXPECT_LE(meshes.back().triangles.size(), n);
    EXPECT_GE(meshes.back().triangles.size() + 4, n);
  }
  for (const uint32_t n : {400u, 1000u, 1454u, 1600u}) {
    EXPECT_TRUE(AreEqual(up.MeshWith(n), meshes.back())) << n;
    meshes.pop_back();
  }
}

TEST(FittedSimplificationTest, LargerMeshesAreOfTheSequence) {
  const TriangleMesh mesh = shapes::BumpySphere(4, 0.2f);
  const SimplificationSequence sequence(mesh);
  FitTarget target(mesh, 4000);
  FittedSimplification fitted(sequence, kOptions, &target);
  EXPECT_TRUE(AreEqual(fitted.MeshWith(1601), sequence.MeshWith(1601)));
  EXPECT_TRUE(AreEqual(fitted.MeshWith(100000), sequence.MeshWith(100000)));
  EXPECT_FALSE(AreEqual(fitted.MeshWith(1600), sequence.MeshWith(1600)));  // fitted, and simplified from there
}

// As far as the collapses of the input and those of what was fitted go.
TEST(FittedSimplificationTest, NothingGoesFartherThanTheSequenceAllows) {
  const TriangleMesh mesh = shapes::WithStick(shapes::BumpySphere(5, 0.2f), 0.003f, 0.3f);
  constexpr double kFarthest = 0.03;
  SimplificationOptions options;
  options.original = std::make_shared<const DeviationSamples>(mesh, kFarthest);
  const SimplificationSequence free(mesh), bounded(mesh, options);
  FitTarget target(mesh, 4000);
  const auto farthest_of = [&](const SimplificationSequence& sequence) {
    return MeasureSurfaceDistance(mesh, FittedSimplification(sequence, kOptions, &target).MeshWith(200)).value().Hausdorff();
  };
  EXPECT_GT(farthest_of(free), 1.8 * kFarthest);
  EXPECT_LT(farthest_of(bounded), 1.6 * kFarthest);  // fits move it on
}

TEST(FittedSimplificationTest, GoesAsFarAsCollapsesGo) {
  const TriangleMesh mesh = shapes::Icosphere(2);
  const SimplificationSequence sequence(mesh);
  FitTarget target(mesh, 2000);
  FittedSimplification fitted(sequence, {320, 2000, 2000}, &target);
  EXPECT_GE(fitted.MeshWith(1).triangles.size(), 1u);
  EXPECT_LE(fitted.MeshWith(1).triangles.size(), 8u);
}

}  // namespace
}  // namespace lacerta
