#include "baselines/edge_trees.h"

namespace lacerta::baselines {

EdgeTrees BuildEdgeTrees(Span<const Topology> topologies) {
  EdgeTrees trees;
  trees.first = {0};
  for (size_t level = 0; level < topologies.size(); ++level) {
    const Topology& t = topologies[level];
    const uint32_t finer = trees.first.back() + t.num_edges();
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      std::array<uint32_t, 4> children = {kNone, kNone, kNone, kNone};
      if (level + 1 < topologies.size()) {
        children[0] = finer + 2 * e;
        children[1] = finer + 2 * e + 1;
        for (int side = 0; side < 2; ++side) {
          const uint32_t f = t.edge_faces[e][side];
          if (f != kNone)
            children[2 + side] = finer + 2 * t.num_edges() + 3 * f + static_cast<uint32_t>(EdgeCorner(t, f, e));
        }
      }
      trees.children.push_back(children);
    }
    trees.first.push_back(finer);
  }
  return trees;
}

}  // namespace lacerta::baselines
