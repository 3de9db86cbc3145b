#include "remesh/retreat.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"
#include "remesh/mesh_neighbors.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

// Whether the vertex has, moved to `to`.
bool HasRetreated(TriangleMesh mesh, uint32_t v, const Vec3f& to, double most) {
  const MeshNeighbors neighbors(mesh);
  const Vec3f from = mesh.positions[v];
  mesh.positions[v] = to;
  return HasRetreated(Vec3Cast<double>(from), v, mesh.triangles, neighbors, most, [&](uint32_t u) { return Vec3Cast<double>(mesh.positions[u]); });
}

// A vertex that slides within a plane leaves nothing, however far.
TEST(HasRetreated, SlidingIsNone) {
  const TriangleMesh grid = shapes::GridWithBorder(8, 8);
  const MeshNeighbors neighbors(grid);
  for (uint32_t v = 0; v < grid.positions.size(); ++v) {
    if (neighbors.vertex_faces[v].size() != 6) continue;  // of the border
    const Vec3f beside = grid.positions[v] + (grid.positions[grid.triangles[neighbors.vertex_faces[v][0]][0]] - grid.positions[v]) * 0.5f;
    EXPECT_FALSE(HasRetreated(grid, v, beside, 1e-4)) << v;
  }
}

TEST(HasRetreated, ATipThatGetsShorterDoes) {
  // A pyramid of height 1.
  const TriangleMesh spike = {{{0, 0, 1}, {0.1f, 0, 0}, {0, 0.1f, 0}, {-0.1f, -0.1f, 0}}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}}};
  EXPECT_TRUE(HasRetreated(spike, 0, {0, 0, 0.8f}, 0.1));
  EXPECT_FALSE(HasRetreated(spike, 0, {0, 0, 0.8f}, 0.25));
  EXPECT_FALSE(HasRetreated(spike, 0, {0, 0, 0.8f}, 0));  // no bound
  EXPECT_FALSE(HasRetreated(spike, 0, {0, 0, 1.5f}, 0.1));  // longer: the tip is still on it, nearly
}

}  // namespace
}  // namespace lacerta
