#include "remesh/mesh_neighbors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "shapes/shapes.h"

namespace lacerta {
namespace {

TEST(MeshNeighborsTest, CountsOfAClosedSurface) {
  const TriangleMesh mesh = shapes::Torus(9, 7);
  const MeshNeighbors neighbors(mesh);
  EXPECT_EQ(neighbors.edges.size(), 3 * mesh.triangles.size() / 2);
  EXPECT_EQ(neighbors.flaps.size(), neighbors.edges.size());
  for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
    EXPECT_EQ(neighbors.vertex_faces[v].size(), 6u);
    EXPECT_EQ(neighbors.vertex_edges[v].size(), 6u);
    EXPECT_EQ(neighbors.vertex_flaps[v].size(), 12u);
  }
}

TEST(MeshNeighborsTest, EdgesAreAcrossTheirCorners) {
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    if (shape.name.find("egenerate") != std::string::npos) continue;
    SCOPED_TRACE(shape.name);
    const MeshNeighbors neighbors(shape.mesh);
    const std::set<std::array<uint32_t, 2>> distinct(neighbors.edges.begin(), neighbors.edges.end());
    EXPECT_EQ(distinct.size(), neighbors.edges.size());
    for (uint32_t f = 0; f < shape.mesh.triangles.size(); ++f) {
      const Triangle& t = shape.mesh.triangles[f];
      for (size_t k = 0; k < 3; ++k) {
        const std::array<uint32_t, 2> edge = neighbors.edges[neighbors.face_edges[f][k]];
        const uint32_t a = t[(k + 1) % 3], b = t[(k + 2) % 3];
        EXPECT_EQ(edge[0], std::min(a, b));
        EXPECT_EQ(edge[1], std::max(a, b));
        const auto faces = neighbors.vertex_faces[t[k]];
        EXPECT_NE(std::find(faces.begin(), faces.end(), f), faces.end());
      }
    }
    for (const auto& [a, b, c, d] : neighbors.flaps) EXPECT_EQ((std::set<uint32_t>{a, b, c, d}).size(), 4u);
  }
}

TEST(MeshNeighborsTest, BordersAndFinsAreNoFlaps) {
  const MeshNeighbors fins(shapes::NonManifoldEdge());
  EXPECT_EQ(fins.edges.size(), 7u);
  EXPECT_TRUE(fins.flaps.empty());
  const MeshNeighbors grid(shapes::GridWithBorder(3, 2));
  EXPECT_EQ(grid.edges.size() - grid.flaps.size(), 10u);
}

}  // namespace
}  // namespace lacerta
