#include "remesh/collapse_queue.h"

#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <vector>

namespace lacerta {
namespace {

struct Edge {
  int id = 0;
  double cost = 0;
  bool operator<(const Edge& b) const { return cost > b.cost; }
};

int NextId(CollapseQueue<Edge>* queue, uint32_t num_alive, const std::set<int>& voided = {}) {
  const std::optional<Edge> next = queue->Next(num_alive, [&](const Edge& e) { return voided.count(e.id) > 0; });
  return next ? next->id : -1;
}

TEST(CollapseQueue, TheCheapestThatIsNotVoidComesFirst) {
  CollapseQueue<Edge> queue(100);
  for (const Edge& e : std::vector<Edge>{{1, 3.0}, {2, 1.0}, {3, 2.0}}) queue.Push(e);
  EXPECT_EQ(NextId(&queue, 100, {2}), 3);
  EXPECT_EQ(NextId(&queue, 100), 1);
  EXPECT_EQ(NextId(&queue, 100), -1);
}

TEST(CollapseQueue, BlockedEdgesComeBackWhenATenthOfTheTrianglesHasGone) {
  CollapseQueue<Edge> queue(100);
  queue.Push({1, 5.0});
  queue.Block({2, 1.0});
  EXPECT_EQ(NextId(&queue, 90), 1);  // a tenth, not more
  queue.Push({1, 5.0});
  EXPECT_EQ(NextId(&queue, 89), 2);
  EXPECT_EQ(NextId(&queue, 89), 1);
}

TEST(CollapseQueue, WithNothingElseLeftBlockedEdgesComeBackOnceAnyTriangleHasGone) {
  CollapseQueue<Edge> queue(100);
  queue.Block({1, 1.0});
  queue.Block({2, 2.0});
  EXPECT_EQ(NextId(&queue, 100), -1);
  EXPECT_EQ(NextId(&queue, 99, {1}), 2);
  queue.Block({2, 2.0});
  EXPECT_EQ(NextId(&queue, 99), -1);  // none has gone since
  EXPECT_EQ(NextId(&queue, 98), 2);
  EXPECT_EQ(NextId(&queue, 0), -1);
}

}  // namespace
}  // namespace lacerta
