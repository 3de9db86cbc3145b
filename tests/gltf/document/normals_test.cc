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

struct FlatSphere {
  TriangleMesh mesh = Sphere();
  std::vector<Triangle> corners;  // one row a face
  std::vector<Vec3f> normals;

  FlatSphere() {
    for (const Triangle& t : mesh.triangles) {
      const auto row = static_cast<uint32_t>(normals.size());
      corners.push_back({row, row, row});
      normals.push_back(Normalized(Cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]])));
    }
  }
  bool IsFlat() const {
    return NormalsAreFlat(mesh.triangles, [this](uint32_t v) { return mesh.positions[v]; }, corners, [this](uint32_t row) { return normals[row]; });
  }
};

TEST(Normals, ThoseOfFacesAreFlat) {
  FlatSphere sphere;
  EXPECT_TRUE(sphere.IsFlat());
  for (Vec3f& normal : sphere.normals) normal = Normalized(normal + Vec3f{0.01f, -0.01f, 0.01f});  // as by eight bits
  EXPECT_TRUE(sphere.IsFlat());
  sphere.corners[7] = {MeshAttribute::kNoValue, MeshAttribute::kNoValue, MeshAttribute::kNoValue};
  sphere.mesh.triangles[8][1] = sphere.mesh.triangles[8][0];  // has no direction
  EXPECT_TRUE(sphere.IsFlat());
}

TEST(Normals, OneFaceThatIsShadedSmoothIsEnough) {
  FlatSphere sphere;
  sphere.corners[5][1] = 6;
  EXPECT_FALSE(sphere.IsFlat());
  const TriangleMesh fine = testing::WavySphere(200, 400);  // where smooth and flat normals hardly differ
  const auto position_at = [&](uint32_t v) { return fine.positions[v]; };
  EXPECT_FALSE(NormalsAreFlat(fine.triangles, position_at, fine.triangles, position_at));
}

TEST(Normals, ThatTurnAwayFromTheirFacesAreNotFlat) {
  FlatSphere sphere;
  for (size_t f = 0; f < sphere.normals.size(); f += 200) sphere.normals[f] = {0, 0, 0};
  for (size_t f = 1; f < sphere.normals.size(); f += 200) sphere.normals[f] = -sphere.normals[f];
  EXPECT_TRUE(sphere.IsFlat());
  for (size_t f = 2; f < sphere.normals.size(); f += 50) sphere.normals[f] = -sphere.normals[f];
  EXPECT_FALSE(sphere.IsFlat());
}

}  // namespace
}  // namespace lacerta
