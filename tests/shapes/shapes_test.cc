// The shapes are what their descriptions say.
#include "shapes/shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace lacerta::shapes {
namespace {

struct Topology {
  bool edges_manifold = true, vertices_manifold = true, oriented = true;
  int euler_characteristic = 0, num_components = 0, num_borders = 0;
};

uint32_t Root(std::vector<uint32_t>* parents, uint32_t v) {
  while ((*parents)[v] != v) v = (*parents)[v] = (*parents)[(*parents)[v]];
  return v;
}

int CountRoots(std::vector<uint32_t>* parents, const std::set<uint32_t>& members) {
  std::set<uint32_t> roots;
  for (const uint32_t v : members) roots.insert(Root(parents, v));
  return static_cast<int>(roots.size());
}

Topology Describe(const TriangleMesh& mesh) {
  Topology result;
  std::map<std::pair<uint32_t, uint32_t>, int> half_edges, edges;
  std::set<uint32_t> used, on_border;
  std::vector<uint32_t> component(mesh.positions.size()), border(mesh.positions.size());
  std::iota(component.begin(), component.end(), 0u);
  std::iota(border.begin(), border.end(), 0u);
  std::map<uint32_t, int> faces_at, edges_at, border_edges_at;
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = t[k], b = t[(k + 1) % 3];
      result.oriented = ++half_edges[{a, b}] == 1 && result.oriented;
      result.edges_manifold = ++edges[std::minmax(a, b)] <= 2 && result.edges_manifold;
      component[Root(&component, a)] = Root(&component, b);
      used.insert(a);
      ++faces_at[a];
    }
  }
  for (const auto& [edge, count] : edges) {
    for (const uint32_t v : {edge.first, edge.second}) {
      ++edges_at[v];
      border_edges_at[v] += count == 1;
      if (count == 1) on_border.insert(v);
    }
    if (count == 1) border[Root(&border, edge.first)] = Root(&border, edge.second);
  }
  // One fan: as many edges as faces, or one more and two of them on the border; and the faces hang together around it.
  for (const uint32_t v : used) {
    std::vector<uint32_t> link(mesh.positions.size());
    std::iota(link.begin(), link.end(), 0u);
    std::set<uint32_t> around;
    for (const Triangle& t : mesh.triangles) {
      const auto at = std::find(t.begin(), t.end(), v) - t.begin();
      if (at == 3) continue;
      const uint32_t a = t[(at + 1) % 3], b = t[(at + 2) % 3];
      around.insert({a, b});
      link[Root(&link, a)] = Root(&link, b);
    }
    const bool one_fan = CountRoots(&link, around) == 1 && edges_at[v] == faces_at[v] + border_edges_at[v] / 2 &&
                         border_edges_at[v] <= 2;
    result.vertices_manifold = one_fan && result.vertices_manifold;
  }
  result.euler_characteristic =
      static_cast<int>(used.size()) - static_cast<int>(edges.size()) + static_cast<int>(mesh.triangles.size());
  result.num_components = CountRoots(&component, used);
  result.num_borders = CountRoots(&border, on_border);
  return result;
}

TEST(Shapes, AreWhatTheySay) {
  std::set<std::string> names;
  for (const NamedShape& shape : AllShapes()) {
    SCOPED_TRACE(shape.name);
    EXPECT_TRUE(names.insert(shape.name).second);
    ASSERT_FALSE(shape.mesh.triangles.empty());
    for (const Triangle& t : shape.mesh.triangles) {
      for (const uint32_t v : t) ASSERT_LT(v, shape.mesh.positions.size());
    }
    const Topology topology = Describe(shape.mesh);
    EXPECT_EQ(topology.edges_manifold && topology.vertices_manifold, shape.manifold);
    EXPECT_EQ(topology.oriented, shape.oriented);
    if (!shape.manifold) continue;
    EXPECT_EQ(topology.num_borders, shape.num_borders);
    EXPECT_EQ(topology.euler_characteristic, 2 * topology.num_components - 2 * shape.genus - shape.num_borders);
  }
}

TEST(Shapes, ClosedOnesLookOutwards) {
  for (const NamedShape& shape : AllShapes()) {
    if (!shape.manifold || !shape.oriented || shape.num_borders > 0) continue;
    double volume = 0.0;
    for (const Triangle& t : shape.mesh.triangles) {
      const Vec3d a = Vec3Cast<double>(shape.mesh.positions[t[0]]), b = Vec3Cast<double>(shape.mesh.positions[t[1]]);
      volume += Dot(Cross(a, b), Vec3Cast<double>(shape.mesh.positions[t[2]])) / 6.0;
    }
    EXPECT_GT(volume, 0.005) << shape.name;
    EXPECT_LT(volume, 15.0) << shape.name;
  }
}

TEST(Shapes, IcosphereLiesOnTheSphere) {
  const TriangleMesh mesh = Icosphere(3, 2.5f);
  EXPECT_EQ(mesh.triangles.size(), 20u * 64u);
  for (const Vec3f& p : mesh.positions) EXPECT_NEAR(Norm(p), 2.5f, 1e-6f);
}

}  // namespace
}  // namespace lacerta::shapes
