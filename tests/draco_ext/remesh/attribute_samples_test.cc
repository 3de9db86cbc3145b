#include "remesh/attribute_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

AttributedMesh Weld(const VertexSoup& soup) { return WeldSoups({soup}).value(); }

TEST(AttributeSamplesTest, EveryTriangleHasThreeAndTheAreaIsWhole) {
  const AttributedMesh mesh = Weld(shapes::Cylinder(12, 4));
  const GroupSurface surface(mesh);
  for (const size_t wanted : {size_t{0}, size_t{5000}}) {
    const AttributeSamples samples(mesh, surface, wanted, 1e-3);
    std::vector<int> count(mesh.surface.triangles.size(), 0);
    double area = 0;
    for (size_t i = 0; i < samples.size(); ++i) {
      ++count[samples[i].face];
      area += samples.ShareOf(i);
    }
    for (const int n : count) EXPECT_GE(n, 3);
    EXPECT_NEAR(area, 1, 1e-9);
    EXPECT_GE(samples.size(), wanted * 9 / 10);
    EXPECT_LE(samples.size(), wanted + 3 * count.size());
  }
}

// The texture of a cylinder has two sides at its one seam, its normals have one everywhere.
TEST(AttributeSamplesTest, SidesAreToldWhereASeamIsNear) {
  const AttributedMesh original = Weld(shapes::Cylinder(96, 24)), mesh = Weld(shapes::Cylinder(12, 4));
  const GroupSurface surface(original);
  constexpr double kNear = 0.05;
  const AttributeSamples samples(mesh, surface, 4000, kNear);
  size_t num_seam = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    size_t texture = 0, normals = 0;
    samples.ForEachSide(i, 0, [&](const GroupSurface::Point& point) {
      if (texture++ > 0) return;
      EXPECT_EQ(point.face, samples[i].closest.face);
    });
    samples.ForEachSide(i, 1, [&](const GroupSurface::Point&) { ++normals; });
    EXPECT_EQ(normals, 1u);
    if (texture > 1) ++num_seam;
    EXPECT_LE(texture, 2u);
  }
  const double share = static_cast<double>(num_seam) / static_cast<double>(samples.size());
  EXPECT_GT(share, 0.5 * 2 * kNear / (2 * M_PI));
  EXPECT_LT(share, 4 * 2 * kNear / (2 * M_PI));
}

}  // namespace
}  // namespace lacerta
