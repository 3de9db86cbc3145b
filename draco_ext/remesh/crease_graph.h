// The graph of crease edges while it is being built: selection and repair.
#ifndef LACERTA_REMESH_CREASE_GRAPH_H_
#define LACERTA_REMESH_CREASE_GRAPH_H_

#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"

namespace lacerta {

class CreaseGraph {
 public:
  // Keeps references.
  CreaseGraph(const TriangleMesh& mesh, const Topology& topology);

  Span<const uint32_t> edges_at(uint32_t vertex) const {
    return {incident_.data() + begin_[vertex], size_t{begin_[vertex + 1]} - begin_[vertex]};
  }
  // Cosine of the turn from edge a to edge b at their vertex: 1 where they run straight on.
  double TurnCosine(uint32_t a, uint32_t b, uint32_t vertex) const;

  // Joins free ends to selected edges ahead of them over one or two edges that bend by min_bend (radians) at least.
  void CloseGaps(const std::vector<double>& bends, double min_bend, double min_cosine,
                 std::vector<uint8_t>* selected) const;
  // Drops chains with a free end that have fewer edges than `min_free`, until there are none.
  void DropSpurs(uint32_t min_free, std::vector<uint8_t>* selected) const;
  // Drops connected networks of fewer edges than `min_open` where one ends in the middle of the surface, else than
  // `min_closed`.
  void DropSmall(uint32_t min_open, uint32_t min_closed, std::vector<uint8_t>* selected) const;

 private:
  std::vector<uint32_t> SelectedDegrees(const std::vector<uint8_t>& selected) const;
  uint32_t OtherEnd(uint32_t edge, uint32_t vertex) const {
    const auto& ends = topology_.edges[edge];
    return ends[0] == vertex ? ends[1] : ends[0];
  }

  const TriangleMesh& mesh_;
  const Topology& topology_;
  std::vector<uint32_t> begin_, incident_;  // edges of each vertex
  std::vector<uint8_t> on_border_;          // #V: where a crease may end
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_CREASE_GRAPH_H_
