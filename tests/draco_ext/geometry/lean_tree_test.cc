#include "geometry/lean_tree.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

#include "geometry/triangle_tree.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

Vec3f RandomPoint(std::mt19937* random, float half_size) {
  std::uniform_real_distribution<float> share(-half_size, half_size);
  const float x = share(*random), y = share(*random), z = share(*random);
  return {x, y, z};
}

Vec3f CenterOf(const TriangleMesh& mesh, size_t face) {
  const Triangle& t = mesh.triangles[face];
  return (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) * (1 / 3.0f);
}

TriangleMesh Moved(TriangleMesh mesh, const Vec3f& by, float scale) {
  for (Vec3f& p : mesh.positions) p = p * scale + by;
  return mesh;
}

// Triangles of any size anywhere in a cube.
TriangleMesh Soup(uint32_t num_triangles) {
  std::mt19937 random(3);
  TriangleMesh mesh;
  for (uint32_t f = 0; f < num_triangles; ++f) {
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(RandomPoint(&random, 1));
    mesh.triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
  }
  return mesh;
}

// TriangleTree is held against brute force by its own test.
TEST(LeanTree, DistancesAreThoseOfTriangleTree) {
  std::vector<TriangleMesh> meshes = {shapes::BumpySphere(5, 0.1f, 0.01f), Soup(500), Moved(shapes::Torus(60, 40), {1e5f, -3e5f, 7}, 1),
                                      Moved(shapes::Torus(20, 20), {}, 1e-20f), {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}};
  for (const shapes::NamedShape& shape : shapes::AllShapes()) meshes.push_back(shape.mesh);
  std::mt19937 random(7);
  for (size_t m = 0; m < meshes.size(); ++m) {
    SCOPED_TRACE(m);
    const TriangleMesh& mesh = meshes[m];
    const TriangleTree expected(mesh);
    const LeanTree tree(mesh);
    const float size = Norm(mesh.positions[mesh.triangles[0][0]]);
    for (int k = 0; k < 300; ++k) {
      Vec3f p = RandomPoint(&random, 2 * size);
      if (k % 2 == 1) p = CenterOf(mesh, random() % mesh.triangles.size()) + p * 1e-3f;
      uint32_t hint = k % 3 == 0 ? LeanTree::kNone : static_cast<uint32_t>(random());
      if (k % 3 == 1) hint %= static_cast<uint32_t>(mesh.triangles.size());
      const ClosestPointResult closest = expected.ClosestPoint(p);
      const double squared = tree.SquaredDistance(p, &hint);
      EXPECT_NEAR(squared, static_cast<double>(closest.squared_distance), 1e-6 * squared + 2e-45);  // floats end there
      ASSERT_LT(hint, mesh.triangles.size());
      uint32_t again = hint;
      EXPECT_EQ(tree.SquaredDistance(p, &again), squared);
    }
  }
}

TEST(LeanTree, HoldsEveryFaceOnceAndNeighborsTogether) {
  const TriangleMesh mesh = shapes::BumpySphere(6);
  const LeanTree tree(mesh);
  std::vector<uint8_t> seen(mesh.triangles.size(), 0);
  ASSERT_EQ(tree.faces_in_tree_order().size(), seen.size());
  double step = 0;
  for (size_t i = 0; i < seen.size(); ++i) {
    const uint32_t face = tree.faces_in_tree_order()[i];
    EXPECT_EQ(seen[face]++, 0);
    if (i > 0) step += Norm(CenterOf(mesh, face) - CenterOf(mesh, tree.faces_in_tree_order()[i - 1]));
  }
  EXPECT_LT(step / static_cast<double>(seen.size()), 0.1);  // at random it would be 4 / 3
}

TEST(LeanTree, DoesNotDependOnTheNumberOfThreads) {
  const TriangleMesh mesh = shapes::BumpySphere(6);
  const LeanTree many(mesh);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(LeanTree(mesh).faces_in_tree_order(), many.faces_in_tree_order());
}

TEST(LeanTree, CrowdingTellsSoupsFromSurfaces) {
  for (const TriangleMesh& mesh : {shapes::BumpySphere(5, 0.1f, 0.01f), shapes::ThinPlate(20), shapes::SpikySphere(5)}) {
    EXPECT_GE(LeanTree(mesh).Crowding(), 1);
    EXPECT_LE(LeanTree(mesh).Crowding(), 8);
  }
  for (const uint32_t size : {1000u, 4000u}) {
    const TriangleMesh soup = Soup(size);
    const double crowding = LeanTree(soup).Crowding();
    EXPECT_GT(crowding, 0.1 * size);
    EXPECT_LT(crowding, 0.6 * size);
    EXPECT_LT(crowding, TriangleTree(soup).Crowding());  // which counts whole leaves
  }
}

}  // namespace
}  // namespace lacerta
