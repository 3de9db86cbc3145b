#include "geometry/vertex_area_vectors.h"

#include <gtest/gtest.h>

namespace lacerta {
namespace {

TEST(VertexAreaVectorsTest, AddUpTwiceTheAreasAround) {
  // Two triangles at a right angle along an edge, of areas 1/2 and 1, and a vertex of none.
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}, {5, 5, 5}}, {{0, 1, 2}, {0, 3, 1}}};
  const std::vector<Vec3d> vectors = VertexAreaVectors(mesh);
  ASSERT_EQ(vectors.size(), 5u);
  const Vec3d expected[] = {{0, 2, 1}, {0, 2, 1}, {0, 0, 1}, {0, 2, 0}, {0, 0, 0}};
  for (size_t v = 0; v < vectors.size(); ++v) {
    EXPECT_EQ(vectors[v].x, expected[v].x) << v;
    EXPECT_EQ(vectors[v].y, expected[v].y) << v;
    EXPECT_EQ(vectors[v].z, expected[v].z) << v;
  }
}

}  // namespace
}  // namespace lacerta
