#include "remesh/attribute_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "lacerta/attribute_distance.h"
#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

AttributedMesh Weld(const VertexSoup& soup) { return WeldSoups({soup}).value(); }

AttributeError Error(const AttributedMesh& a, const AttributedMesh& b, size_t attribute) {
  return AttributeDistanceMeter::Create(a).value().Measure(b).value().Worst(attribute);
}

AttributedMesh Fitted(const AttributedMesh& original, AttributedMesh mesh) {
  const GroupSurface surface(original);
  FitAttributes(surface, {}, &mesh);
  EXPECT_TRUE(CheckAttributedMesh(mesh).ok());
  return mesh;
}

// A plane with the texture (x^2, y).
VertexSoup Bent(int nx, int ny) {
  VertexSoup soup = shapes::TexturedGrid(nx, ny);
  std::vector<float>& values = soup.attributes[0].values;
  for (size_t i = 0; i < values.size(); i += 2) values[i] *= values[i];
  return soup;
}

TEST(FitAttributesTest, IsTheLeastSquaresOfAParabola) {
  // Over pieces of width h the chords of x^2 are off by h^2 / sqrt(30), the best continuous pieces by h^2 / sqrt(180), but for the ends.
  const AttributedMesh original = Weld(Bent(200, 4)), chords = Weld(Bent(10, 4));
  EXPECT_NEAR(Error(original, chords, 0).rms, 1024 * 0.01 / std::sqrt(30.0), 0.05);
  const double fitted = Error(original, Fitted(original, chords), 0).rms;
  EXPECT_NEAR(fitted, 1024 * 0.01 / std::sqrt(180.0), 0.08);
}

TEST(FitAttributesTest, LeavesWhatIsRight) {
  for (const VertexSoup& soup : {shapes::TexturedBox(3), shapes::Cylinder(16, 6)}) {
    const AttributedMesh mesh = Weld(soup), fitted = Fitted(mesh, mesh);
    for (size_t a = 0; a < 2; ++a) EXPECT_LT(Error(mesh, fitted, a).max, 0.05);
  }
}

TEST(FitAttributesTest, KeepsSeamsAndJoinsNothingAcrossThem) {
  const AttributedMesh original = Weld(shapes::Cylinder(96, 24)), mesh = Weld(shapes::Cylinder(12, 4));
  const AttributedMesh fitted = Fitted(original, mesh);
  EXPECT_EQ(fitted.surface.positions.size(), mesh.surface.positions.size());
  EXPECT_LT(Error(original, fitted, 0).rms_99, 1.01 * Error(original, mesh, 0).rms_99);
  for (size_t f = 0; f < mesh.surface.triangles.size(); ++f) {
    for (size_t g = 0; g < f; ++g) {
      for (size_t i = 0; i < 9; ++i) {
        if (mesh.surface.triangles[f][i / 3] != mesh.surface.triangles[g][i % 3]) continue;
        EXPECT_EQ(mesh.attributes[0].corners[f][i / 3] == mesh.attributes[0].corners[g][i % 3],
                  fitted.attributes[0].corners[f][i / 3] == fitted.attributes[0].corners[g][i % 3]);
      }
    }
  }
}

TEST(FitAttributesTest, NormalsHaveUnitLength) {
  const AttributedMesh original = Weld(shapes::TexturedGrid(60, 60, 0.4f));
  const AttributedMesh fitted = Fitted(original, Weld(shapes::TexturedGrid(8, 8, 0.4f)));
  for (uint32_t i = 0; i < fitted.attributes[1].num_values(); ++i) {
    const float* n = &fitted.attributes[1].values[3 * i];
    EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-5);
  }
  EXPECT_LT(Error(original, fitted, 1).rms, Error(original, Weld(shapes::TexturedGrid(8, 8, 0.4f)), 1).rms);
}

TEST(FitAttributesTest, MirrorsNoTriangleOfATexture) {
  // The texture of the original folds back at x = 0.5: the fit would follow it with triangles of the other sign.
  VertexSoup folded = shapes::TexturedGrid(64, 2);
  std::vector<float>& values = folded.attributes[0].values;
  for (size_t i = 0; i < values.size(); i += 2) values[i] = std::fabs(values[i] - 0.5f);
  AttributedMesh mesh = Weld(shapes::TexturedGrid(4, 2));
  const AttributedMesh fitted = Fitted(Weld(folded), mesh);
  const MeshAttribute& texture = fitted.attributes[0];
  for (const Triangle& t : texture.corners) {
    const auto at = [&](size_t k) { return &texture.values[2 * t[k]]; };
    EXPECT_GT((at(1)[0] - at(0)[0]) * (at(2)[1] - at(0)[1]) - (at(1)[1] - at(0)[1]) * (at(2)[0] - at(0)[0]), 0);
  }
}

}  // namespace
}  // namespace lacerta
