#include "baselines/edge_trees.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "shapes/shapes.h"

namespace lacerta::baselines {
namespace {

std::vector<Topology> Levels(const TriangleMesh& mesh, int count) {
  std::vector<Topology> levels = {BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles).value()};
  while (static_cast<int>(levels.size()) < count) levels.push_back(Refine(levels.back()));
  return levels;
}

// Middle of the edge that a node stands for.
Vec3f Middle(const std::vector<Vec3f>& positions, const Topology& t, uint32_t e) {
  return (positions[t.edges[e][0]] + positions[t.edges[e][1]]) * 0.5f;
}

TEST(EdgeTrees, EveryFinerEdgeHasOneParent) {
  for (const TriangleMesh& mesh : {shapes::Icosphere(0), shapes::GridWithBorder(2, 3)}) {
    const std::vector<Topology> levels = Levels(mesh, 3);
    const EdgeTrees trees = BuildEdgeTrees(levels);
    ASSERT_EQ(trees.num_levels(), 3);
    std::vector<int> parents(trees.num_nodes(), 0);
    for (const auto& children : trees.children) {
      for (const uint32_t c : children) {
        if (c != kNone) ++parents[c];
      }
    }
    EXPECT_EQ(std::count(parents.begin(), parents.begin() + trees.first[1], 0), levels[0].num_edges());
    EXPECT_EQ(std::count(parents.begin() + trees.first[1], parents.end(), 1),
              levels[1].num_edges() + levels[2].num_edges());
  }
}

TEST(EdgeTrees, ChildrenAreHalvesAndParallelInnerEdges) {
  const TriangleMesh mesh = shapes::Icosphere(0);
  const std::vector<Topology> levels = Levels(mesh, 2);
  const EdgeTrees trees = BuildEdgeTrees(levels);
  std::vector<Vec3f> fine = mesh.positions;
  for (uint32_t e = 0; e < levels[0].num_edges(); ++e) fine.push_back(Middle(mesh.positions, levels[0], e));
  for (uint32_t e = 0; e < levels[0].num_edges(); ++e) {
    const Vec3f edge = Normalized(mesh.positions[levels[0].edges[e][1]] - mesh.positions[levels[0].edges[e][0]]);
    for (int k = 0; k < 4; ++k) {
      const auto& ends = levels[1].edges[trees.children[e][k] - trees.first[1]];
      EXPECT_NEAR(std::fabs(Dot(Normalized(fine[ends[1]] - fine[ends[0]]), edge)), 1.0f, 1e-5f);
      const bool is_half = ends[0] == levels[0].num_vertices + e || ends[1] == levels[0].num_vertices + e;
      EXPECT_EQ(is_half, k < 2);
    }
  }
}

TEST(EdgeTrees, BorderEdgesHaveThreeChildren) {
  const std::vector<Topology> levels = Levels(shapes::GridWithBorder(2, 2), 2);
  const EdgeTrees trees = BuildEdgeTrees(levels);
  for (uint32_t e = 0; e < levels[0].num_edges(); ++e) {
    EXPECT_EQ(std::count(trees.children[e].begin(), trees.children[e].end(), kNone), levels[0].is_border(e) ? 1 : 0);
  }
  EXPECT_TRUE(trees.is_leaf(trees.first[1]));
  EXPECT_FALSE(trees.is_leaf(0));
}

}  // namespace
}  // namespace lacerta::baselines
