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
    const float* n = &fitted.attributes[1].values[3 * size_t{i}];
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
    const auto at = [&](size_t k) { return &texture.values[2 * size_t{t[k]}]; };
    EXPECT_GT((at(1)[0] - at(0)[0]) * (at(2)[1] - at(0)[1]) - (at(1)[1] - at(0)[1]) * (at(2)[0] - at(0)[0]), 0);
  }
}

// Values of `count` components over a plane: component c is a hill around a place of its own.
AttributedMesh Hills(int n, size_t count) {
  AttributedMesh mesh = Weld(shapes::TexturedGrid(n, n));
  MeshAttribute hills;
  hills.kind = AttributeKind::kGeneric;
  hills.components = static_cast<uint32_t>(count);
  hills.corners = mesh.surface.triangles;
  for (const Vec3f& p : mesh.surface.positions) {
    for (size_t c = 0; c < count; ++c) {
      const size_t column = c % 5, row = c / 5;
      const float x = p.x - static_cast<float>(column) * 0.2f - 0.1f, y = p.y - static_cast<float>(row) * 0.2f - 0.1f;
      hills.values.push_back(std::max(0.0f, 1 - 40 * (x * x + y * y)));
    }
  }
  mesh.attributes.assign(1, hills);
  return mesh;
}

TEST(FitAttributesTest, DozensOfComponentsAreEachFittedLikeOne) {
  constexpr size_t kCount = 25;
  const AttributedMesh original = Hills(96, kCount), mesh = Hills(14, kCount), fitted = Fitted(original, mesh);
  const auto component = [](AttributedMesh of, size_t c) {
    MeshAttribute& attribute = of.attributes[0];
    std::vector<float> values;
    for (size_t i = c; i < attribute.values.size(); i += kCount) values.push_back(attribute.values[i]);
    attribute.values = values;
    attribute.components = 1;
    return of;
  };
  for (const size_t c : {size_t{0}, size_t{7}, size_t{24}}) {
    const AttributedMesh alone = component(original, c);
    const double before = Error(alone, component(mesh, c), 0).rms, together = Error(alone, component(fitted, c), 0).rms;
    const double by_itself = Error(alone, Fitted(alone, component(mesh, c)), 0).rms;
    EXPECT_LT(together, 0.8 * before) << c;
    EXPECT_NEAR(together, by_itself, 0.02 * by_itself) << c;
  }
}

TEST(FitAttributesTest, WhatIsZeroStaysZero) {
  const AttributedMesh mesh = Hills(14, 25), fitted = Fitted(Hills(96, 25), mesh);
  size_t num_zero = 0, num_moved = 0;
  for (size_t f = 0; f < mesh.surface.triangles.size(); ++f) {
    for (size_t k = 0; k < 3; ++k) {
      const auto at = [&](const AttributedMesh& of) { return of.attributes[0].values[25 * size_t{of.attributes[0].corners[f][k]} + 24]; };
      if (at(mesh) == 0) {
        EXPECT_EQ(at(fitted), 0.0f);
        ++num_zero;
      } else {
        num_moved += at(fitted) != at(mesh);
      }
    }
  }
  EXPECT_GT(num_zero, 500u);
  EXPECT_GT(num_moved, 20u);
}

}  // namespace
}  // namespace lacerta
