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

}  // namespace
}  // namespace lacerta
