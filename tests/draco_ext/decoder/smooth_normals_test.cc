#include "decoder/smooth_normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "shapes/shapes.h"

namespace lacerta {
namespace {

TEST(SmoothNormals, WeighAreCornerAngles) {
  // Three squares of a cube's corner, one of them as two triangles: weights by count or area would lean to it.
  const TriangleMesh corner = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}},
                               {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 5, 4}, {0, 4, 3}, {3, 4, 6}}};
  const std::vector<Vec3f> normals = SmoothNormals(corner.positions, corner.triangles);
  const float third = -1 / std::sqrt(3.0f);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(normals[0][axis], third, 1e-5f);
  EXPECT_NEAR(normals[2].z, -1.0f, 1e-6f);
}

TEST(SmoothNormals, AreRadialOnASphere) {
  const TriangleMesh sphere = shapes::Icosphere(3);
  const std::vector<Vec3f> normals = SmoothNormals(sphere.positions, sphere.triangles);
  float worst = 1;
  for (size_t v = 0; v < normals.size(); ++v) worst = std::min(worst, Dot(normals[v], Normalized(sphere.positions[v])));
  EXPECT_GT(worst, 0.9999f);
  EXPECT_LT(worst, 1.0f);
}

TEST(SmoothNormals, VerticesAtOnePlaceShareTheirs) {
  const TriangleMesh roof = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 1}, {0, 0, 0}, {1, 0, -0.0f}, {0, -1, 1}}, {{0, 1, 2}, {3, 5, 4}}};
  const std::vector<Vec3f> normals = SmoothNormals(roof.positions, roof.triangles);
  EXPECT_EQ(normals[0], normals[3]);
  EXPECT_EQ(normals[1], normals[4]);
  EXPECT_NE(normals[2], normals[5]);
  EXPECT_NEAR(normals[0].z, 1.0f, 1e-6f);
}

TEST(SmoothNormals, TrianglesWithoutAreaSayNothing) {
  const float inf = std::numeric_limits<float>::infinity();
  const TriangleMesh bad = {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {inf, 0, 0}}, {{0, 1, 2}, {0, 1, 3}, {1, 1, 1}}};
  for (const Vec3f& normal : SmoothNormals(bad.positions, bad.triangles)) EXPECT_EQ(normal, (Vec3f{0, 0, 1}));
}

}  // namespace
}  // namespace lacerta
