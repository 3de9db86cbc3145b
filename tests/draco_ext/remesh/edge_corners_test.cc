#include "remesh/edge_corners.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "shapes/shapes.h"

namespace lacerta {
namespace {

TEST(GroupByEdge, EveryCornerOnceUnderItsEdge) {
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    SCOPED_TRACE(shape.name);
    const EdgeCorners edges = GroupByEdge(shape.mesh.positions.size(), shape.mesh.triangles);
    std::vector<bool> seen(shape.mesh.triangles.size() * 3, false);
    std::set<std::pair<uint32_t, uint32_t>> keys;
    for (uint32_t e = 0; e < edges.num_edges(); ++e) {
      ASSERT_FALSE(edges.of(e).empty());
      EXPECT_TRUE(std::is_sorted(edges.of(e).begin(), edges.of(e).end()));
      const uint32_t first = edges.of(e)[0];
      const auto ends = [&](uint32_t c) {
        const uint32_t a = StartOfEdge(shape.mesh.triangles, c), b = EndOfEdge(shape.mesh.triangles, c);
        return std::pair<uint32_t, uint32_t>(std::min(a, b), std::max(a, b));
      };
      EXPECT_TRUE(keys.insert(ends(first)).second);
      for (const uint32_t c : edges.of(e)) {
        EXPECT_EQ(ends(c), ends(first));
        EXPECT_FALSE(seen[c]);
        seen[c] = true;
      }
    }
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](bool s) { return s; }));
  }
}

TEST(GroupByEdge, CornersLieOppositeTheirEdge) {
  const std::vector<Triangle> triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  const EdgeCorners edges = GroupByEdge(5, triangles);
  ASSERT_EQ(edges.num_edges(), 7u);
  EXPECT_THAT(std::vector<uint32_t>(edges.of(0).begin(), edges.of(0).end()), ::testing::ElementsAre(2, 5, 8));
  EXPECT_EQ(VertexOf(triangles, 5), 3u);
  EXPECT_EQ(StartOfEdge(triangles, 5), 1u);
  EXPECT_EQ(EndOfEdge(triangles, 5), 0u);
}

}  // namespace
}  // namespace lacerta
