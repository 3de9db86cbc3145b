#include "remesh/crease_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shapes/shapes.h"

namespace lacerta {
namespace {

// A flat sheet of 32 x 32 squares; curves are named by the squares they run along.
class CreaseGraphTest : public ::testing::Test {
 protected:
  static Topology Build(const TriangleMesh& mesh) {
    StatusOr<Topology> topology = BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles);
    EXPECT_TRUE(topology.ok());
    return std::move(topology).value();
  }
  // The edges from (x0, y) to (x1, y), or (x, y0) to (x, y1).
  void Line(int x0, int y0, int x1, int y1, uint8_t value, std::vector<uint8_t>* selected) const {
    const auto within = [&](uint32_t v) {
      const float x = mesh_.positions[v].x * 32, y = mesh_.positions[v].y * 32;
      return x >= static_cast<float>(x0) && x <= static_cast<float>(x1) && y >= static_cast<float>(y0) &&
             y <= static_cast<float>(y1);
    };
    for (uint32_t e = 0; e < topology_.num_edges(); ++e) {
      if (within(topology_.edges[e][0]) && within(topology_.edges[e][1])) (*selected)[e] = value;
    }
  }
  static std::ptrdiff_t Count(const std::vector<uint8_t>& selected) {
    return std::count(selected.begin(), selected.end(), 1);
  }

  const TriangleMesh mesh_ = shapes::GridWithBorder(32, 32);
  const Topology topology_ = Build(mesh_);
  const CreaseGraph graph_{mesh_, topology_};
  const std::vector<uint8_t> none_ = std::vector<uint8_t>(topology_.num_edges(), 0);
};

TEST_F(CreaseGraphTest, EdgesAtIsTheStar) {
  for (uint32_t v = 0; v < topology_.num_vertices; ++v) {
    ASSERT_EQ(graph_.edges_at(v).size(), topology_.valence[v]);
    for (const uint32_t e : graph_.edges_at(v)) EXPECT_TRUE(topology_.edges[e][0] == v || topology_.edges[e][1] == v);
  }
}

TEST_F(CreaseGraphTest, ClosesGapsOfOneAndTwoEdges) {
  for (const int gap : {1, 2, 3}) {
    for (const double bend : {0.5, 0.1}) {
      std::vector<uint8_t> selected = none_;
      Line(4, 16, 12, 16, 1, &selected);
      Line(12 + gap, 16, 28, 16, 1, &selected);
      std::vector<double> bends(topology_.num_edges(), 0.0);
      for (uint32_t e = 0; e < bends.size(); ++e) {  // only along the line
        bends[e] = mesh_.positions[topology_.edges[e][0]].y == 0.5f && mesh_.positions[topology_.edges[e][1]].y == 0.5f
                       ? bend
                       : 0;
      }
      graph_.CloseGaps(bends, 0.2, 0.6, &selected);
      EXPECT_EQ(Count(selected), gap == 3 || bend < 0.2 ? 24 - gap : 24) << gap << " " << bend;
    }
  }
}

TEST_F(CreaseGraphTest, DropsSpursUntilThereAreNone) {
  std::vector<uint8_t> selected = none_;
  Line(0, 16, 32, 16, 1, &selected);  // from border to border
  const std::vector<uint8_t> line = selected;
  Line(10, 16, 10, 21, 1, &selected);  // of five edges
  Line(10, 19, 12, 19, 1, &selected);  // and a spur on it
  graph_.DropSpurs(6, &selected);
  EXPECT_EQ(selected, line);
  Line(10, 16, 10, 22, 1, &selected);
  const std::vector<uint8_t> with_long_end = selected;
  graph_.DropSpurs(6, &selected);
  EXPECT_EQ(selected, with_long_end);
  // Ends on the border are none.
  Line(20, 29, 20, 32, 1, &selected);
  Line(16, 29, 20, 29, 1, &selected);
  Line(16, 29, 16, 32, 1, &selected);
  const std::vector<uint8_t> with_bridge = selected;
  graph_.DropSpurs(6, &selected);
  EXPECT_EQ(selected, with_bridge);
}

TEST_F(CreaseGraphTest, DropsSmallNetworks) {
  std::vector<uint8_t> ring = none_, line = none_;
  Line(4, 4, 6, 4, 1, &ring);
  Line(4, 6, 6, 6, 1, &ring);
  Line(4, 4, 4, 6, 1, &ring);
  Line(6, 4, 6, 6, 1, &ring);
  Line(20, 20, 28, 20, 1, &line);
  std::vector<uint8_t> both = ring;
  for (size_t e = 0; e < both.size(); ++e) both[e] |= line[e];
  const auto kept = [&](uint32_t min_open, uint32_t min_closed) {
    std::vector<uint8_t> selected = both;
    graph_.DropSmall(min_open, min_closed, &selected);
    return selected;
  };
  EXPECT_EQ(kept(8, 8), both);
  EXPECT_EQ(kept(9, 8), ring);
  EXPECT_EQ(kept(8, 9), line);
  EXPECT_EQ(kept(9, 9), none_);
}

}  // namespace
}  // namespace lacerta
