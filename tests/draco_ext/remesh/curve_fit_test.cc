#include "remesh/curve_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "lacerta/surface_distance.h"
#include "remesh/attributed_simplify.h"
#include "shapes/attributed_shapes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

TEST(FitBesideCurvesTest, ComesCloserToASphere) {
  const AttributedMesh sphere = WeldSoups({{shapes::Icosphere(5).positions, shapes::Icosphere(5).triangles, {}}}).value();
  AttributedMesh mesh = WeldSoups({{shapes::Icosphere(2).positions, shapes::Icosphere(2).triangles, {}}}).value();
  const double before = MeasureSurfaceDistance(sphere.surface, mesh.surface).value().Rms();
  const FitTarget target(sphere.surface, 20'000);
  FitBesideCurves(target, 2, &mesh);
  // Inscribed triangles are off by their sagitta s in the middle, fitted ones by the spread of it.
  const double after = MeasureSurfaceDistance(sphere.surface, mesh.surface).value().Rms();
  EXPECT_LT(after, before / 2);
  EXPECT_GT(after, before / 10);
}

TEST(FitBesideCurvesTest, VerticesOfASeamMoveAlongTheirNormalsAlone) {
  const AttributedMesh fine = WeldSoups({shapes::Cylinder(96, 32)}).value();
  AttributedMesh mesh = WeldSoups({shapes::Cylinder(12, 4)}).value();
  const std::vector<Vec3f> before = mesh.surface.positions;
  const FitTarget target(fine.surface, 20'000);
  FitBesideCurves(target, 2, &mesh);
  int on_seam = 0, moved = 0;
  for (size_t v = 0; v < before.size(); ++v) {
    const Vec3f move = mesh.surface.positions[v] - before[v];
    const bool is_end = before[v].z == 0 || before[v].z > 6.28f, is_seam = before[v].x > 0.999f;
    EXPECT_TRUE(!is_seam || !is_end || Norm(move) == 0);
    if (!is_seam || is_end) continue;
    ++on_seam;
    moved += move.x > 0.005f;  // outwards
    EXPECT_NEAR(move.y, 0, 1e-5);
    EXPECT_NEAR(move.z, 0, 1e-5);
  }
  EXPECT_EQ(on_seam, 3);
  EXPECT_EQ(moved, 3);
}

}  // namespace
}  // namespace lacerta
