// Hierarchical trees over the details of a semi-regular mesh [Khodakovsky, Schroeder, Sweldens 2000, Sec. 3.2]: one
// detail per edge of the level that is split, so the trees are rooted at the edges of the base and every edge has four
// children: its two halves and, in each of its faces, the inner edge parallel to it. On the border three.
#ifndef LACERTA_TESTS_BASELINES_EDGE_TREES_H_
#define LACERTA_TESTS_BASELINES_EDGE_TREES_H_

#include <array>
#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"

namespace lacerta::baselines {

// Nodes are numbered level by level, those of a level as its edges, so that parents come before children.
struct EdgeTrees {
  std::vector<uint32_t> first;                    // L + 1: first node of each level, then the number of nodes
  std::vector<std::array<uint32_t, 4>> children;  // #nodes, kNone where there is none; leaves have none at all

  int num_levels() const { return static_cast<int>(first.size()) - 1; }
  uint32_t num_nodes() const { return first.back(); }
  bool is_leaf(uint32_t node) const { return children[node][0] == kNone; }
};

// topologies: of levels 0 .. L - 1, L >= 1, as BuildTopologies makes them.
EdgeTrees BuildEdgeTrees(Span<const Topology> topologies);

}  // namespace lacerta::baselines

#endif  // LACERTA_TESTS_BASELINES_EDGE_TREES_H_
