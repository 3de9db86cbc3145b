#include "remesh/wedge_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "shapes/attributed_shapes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

size_t Count(const WedgeMesh& mesh, VertexFreedom freedom) {
  return static_cast<size_t>(std::count(mesh.freedom.begin(), mesh.freedom.end(), freedom));
}

AttributedMesh Plain(const TriangleMesh& mesh) { return WeldSoups({{mesh.positions, mesh.triangles, {}}}).value(); }

TEST(WedgeMeshTest, TheSeamOfACylinderIsACurveBetweenItsBorders) {
  const WedgeMesh mesh = MakeWedgeMesh(WeldSoups({shapes::Cylinder(20, 6)}).value());
  EXPECT_EQ(Count(mesh, VertexFreedom::kJunction), 2u);    // where the seam meets the two borders
  EXPECT_EQ(Count(mesh, VertexFreedom::kCurve), 2u * 19 + 5);
  EXPECT_EQ(Count(mesh, VertexFreedom::kSurface), 19u * 5);
  EXPECT_EQ(mesh.attributes[0].values.size(), 21u * 7);    // the texture has two values along the seam,
  EXPECT_EQ(mesh.attributes[1].values.size(), 20u * 7);    // the normal one
}

TEST(WedgeMeshTest, TheEdgesOfABoxAreCurvesAndItsCornersJunctions) {
  const WedgeMesh mesh = MakeWedgeMesh(WeldSoups({shapes::TexturedBox(4)}).value());
  EXPECT_EQ(Count(mesh, VertexFreedom::kJunction), 8u);
  EXPECT_EQ(Count(mesh, VertexFreedom::kCurve), 12u * 3);
  EXPECT_EQ(Count(mesh, VertexFreedom::kSurface), 6u * 9);
}

TEST(WedgeMeshTest, TheBorderOfTwoGroupsIsACurve) {
  AttributedMesh mesh = Plain(shapes::Icosphere(2));
  EXPECT_EQ(Count(MakeWedgeMesh(mesh), VertexFreedom::kCurve), 0u);
  mesh.groups.clear();
  for (const Triangle& t : mesh.surface.triangles) {
    mesh.groups.push_back(mesh.surface.positions[t[0]].z + mesh.surface.positions[t[1]].z + mesh.surface.positions[t[2]].z > 0.01f);
  }
  const WedgeMesh split = MakeWedgeMesh(mesh);
  const size_t num_on_border = split.num_vertices() - Count(split, VertexFreedom::kSurface);
  EXPECT_GT(num_on_border, 10u);
  EXPECT_LT(num_on_border, split.num_vertices() / 4);
}

TEST(WedgeMeshTest, AnyShapeBecomesOne) {
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    SCOPED_TRACE(shape.name);
    const AttributedMesh input = Plain(shape.mesh);
    const WedgeMesh mesh = MakeWedgeMesh(input);
    ASSERT_EQ(mesh.source_face.size(), mesh.mesh.triangles.size());
    EXPECT_LE(mesh.mesh.triangles.size(), input.surface.triangles.size());
    for (size_t f = 0; f < mesh.mesh.triangles.size(); ++f) {
      Triangle t = mesh.mesh.triangles[f];
      if (mesh.flipped[f] != 0) std::swap(t[1], t[2]);
      for (size_t k = 0; k < 3; ++k) EXPECT_EQ(mesh.source_vertex[t[k]], input.surface.triangles[mesh.source_face[f]][k]);
    }
    const bool is_plain = shape.manifold && shape.oriented && shape.num_borders == 0;
    EXPECT_TRUE(!is_plain || Count(mesh, VertexFreedom::kSurface) == mesh.num_vertices());
  }
}

TEST(WedgeMeshTest, WhereTheSurfaceIsCutItStandsStill) {
  const WedgeMesh mesh = MakeWedgeMesh(Plain(shapes::NonManifoldEdge()));
  EXPECT_EQ(Count(mesh, VertexFreedom::kSurface), 0u);
  EXPECT_GE(Count(mesh, VertexFreedom::kFixed), 2u);
  // The back of a sheet is cut off along its rim only.
  const WedgeMesh sheet = MakeWedgeMesh(Plain(shapes::DoubleSheet(6, 6)));
  EXPECT_EQ(Count(sheet, VertexFreedom::kSurface), 2u * 25);
}

TEST(WedgeMeshTest, LeavesOutDegenerateAndRepeatedTrianglesOfAGroup) {
  AttributedMesh mesh = Plain({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {1, 2, 0}, {0, 1, 1}, {0, 1, 2}}});
  mesh.groups = {0, 0, 0, 1};
  const WedgeMesh result = MakeWedgeMesh(mesh);
  EXPECT_EQ(result.source_face, (std::vector<uint32_t>{0, 3}));
}

}  // namespace
}  // namespace lacerta
