#include "document/normals.h"

#include <gtest/gtest.h>

#include "gltf/test_assets.h"

namespace lacerta {
namespace {

TriangleMesh Sphere() {
  TriangleMesh mesh = testing::WavySphere(24, 48);
  for (Vec3f& position : mesh.positions) position = Normalized(position);
  return mesh;
}

TEST(Normals, PointOutOfASphere) {
  const TriangleMesh mesh = Sphere();
  const std::vector<Vec3f> normals = DeriveNormals(mesh);
  ASSERT_EQ(normals.size(), mesh.positions.size());
  for (size_t v = 0; v < normals.size(); ++v) {
    EXPECT_NEAR(Norm(normals[v]), 1.0f, 1e-6f);
    EXPECT_GT(Dot(normals[v], mesh.positions[v]), 0.995f);
  }
}

TEST(Normals, VerticesAtOnePlaceShareTheirs) {
  TriangleMesh soup;  // a sphere without shared vertices
  const TriangleMesh mesh = Sphere();
  for (const Triangle& triangle : mesh.triangles) {
    for (const uint32_t v : triangle) soup.positions.push_back(mesh.positions[v]);
    const auto end = static_cast<uint32_t>(soup.positions.size());
    soup.triangles.push_back({end - 3, end - 2, end - 1});
  }
  EXPECT_TRUE(NormalsAreDerivable(soup, soup.positions));
}

TEST(Normals, CreasesAreNotDerivable) {
  const TriangleMesh mesh = Sphere();
  std::vector<Vec3f> normals = mesh.positions;
  EXPECT_TRUE(NormalsAreDerivable(mesh, normals));
  for (size_t v = 0; v < normals.size(); v += 200) normals[v] = {0, 0, 0};  // one in two hundred is let pass
  EXPECT_TRUE(NormalsAreDerivable(mesh, normals));
  for (size_t v = 0; v < normals.size(); v += 50) normals[v] = -mesh.positions[v];
  EXPECT_FALSE(NormalsAreDerivable(mesh, normals));
}

TEST(Normals, DegenerateTrianglesGiveSomething) {
  const TriangleMesh mesh = {{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}};
  for (const Vec3f& normal : DeriveNormals(mesh)) EXPECT_EQ(normal, (Vec3f{0, 0, 1}));
}

}  // namespace
}  // namespace lacerta
