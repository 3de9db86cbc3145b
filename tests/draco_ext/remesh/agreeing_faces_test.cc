#include "remesh/agreeing_faces.h"

#include <gtest/gtest.h>

#include <utility>

#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

void TurnOver(uint32_t face, AttributedMesh* mesh) {
  std::swap(mesh->surface.triangles[face][1], mesh->surface.triangles[face][2]);
  for (MeshAttribute& attribute : mesh->attributes) std::swap(attribute.corners[face][1], attribute.corners[face][2]);
}

TEST(AgreeingFaces, TurnsTheMinorityOverWithItsCorners) {
  const AttributedMesh mesh = WeldSoups({shapes::TexturedGrid(20, 20, 0.3f)}).value();  // 800 triangles of about equal area
  EXPECT_FALSE(TurnToAgree(mesh).has_value());
  AttributedMesh turned = mesh;
  for (const uint32_t f : {100u, 101u, 555u}) TurnOver(f, &turned);
  const std::optional<AgreeingSurface> agreeing = TurnToAgree(turned);
  ASSERT_TRUE(agreeing.has_value());
  EXPECT_NEAR(agreeing->turned_share, 3.0 / 800, 1.0 / 800);
  AttributedMesh expected = turned;
  for (const uint32_t f : {100u, 101u, 555u}) TurnOver(f, &expected);
  EXPECT_EQ(agreeing->mesh.surface.triangles, expected.surface.triangles);
  for (size_t a = 0; a < mesh.attributes.size(); ++a) EXPECT_EQ(agreeing->mesh.attributes[a].corners, expected.attributes[a].corners);
}

}  // namespace
}  // namespace lacerta
