#include "remesh/attributed_simplify.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "remesh/attribute_values.h"
#include "remesh/attributed_simplifier.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;

// Index by index where each thing is after the merges, which are in order.
template <typename Merge>
std::vector<uint32_t> FollowMerges(size_t count, const Merge* merges, size_t num_merges) {
  std::vector<uint32_t> becomes(count);
  std::iota(becomes.begin(), becomes.end(), 0u);
  for (size_t i = num_merges; i-- > 0;) becomes[merges[i].removed] = becomes[merges[i].kept];
  return becomes;
}

template <typename Event>
size_t CountUpTo(const std::vector<Event>& events, size_t num_collapses) {
  const auto end = std::partition_point(events.begin(), events.end(), [&](const Event& e) { return e.num_collapses <= num_collapses; });
  return static_cast<size_t>(end - events.begin());
}

}  // namespace

AttributedSimplification::AttributedSimplification(AttributedMesh input, const std::vector<double>& weights, const std::vector<uint8_t>& held, const SimplificationBounds& bounds)
    : input_(std::move(input)), start_(MakeWedgeMesh(input_)), histories_(input_.attributes.size()) {
  for (uint32_t v = 0; v < start_.num_vertices() && !held.empty(); ++v) {
    if (held[start_.source_vertex[v]] != 0) start_.freedom[v] = VertexFreedom::kHeld;
  }
  if (!start_.mesh.triangles.empty()) AttributedSimplifier(input_, start_, weights, bounds, this).Run();
}

void AttributedSimplification::WriteValues(size_t num_collapses, const NodeHistory& history, const AttributeNodes& nodes,
                                           const MeshAttribute& input, MeshAttribute* output, std::vector<uint32_t>* becomes) const {
  const size_t columns = input.components;
  *becomes = FollowMerges(nodes.values.size(), history.merges.data(), CountUpTo(history.merges, num_collapses));
  const ValueRange range(input);
  output->values.resize(nodes.values.size() * columns);
  for (size_t node = 0; node < nodes.values.size(); ++node) {
    std::copy_n(&input.values[nodes.values[node] * columns], columns, &output->values[node * columns]);
  }
  std::vector<uint32_t> last_move(nodes.values.size(), kNone);
  for (uint32_t i = 0; i < CountUpTo(history.moves, num_collapses); ++i) last_move[history.moves[i].node] = i;
  for (size_t node = 0; node < last_move.size(); ++node) {
    if (last_move[node] == kNone) continue;
    float* row = &output->values[node * columns];
    std::copy_n(&history.values[last_move[node] * columns], columns, row);
    range.Legalize(row);
  }
}

AttributedMesh AttributedSimplification::MeshWith(uint32_t num_triangles) const {
  size_t num_collapses = 0;
  if (num_triangles < num_input_triangles()) {
    const auto enough =
        std::partition_point(collapses_.begin(), collapses_.end(), [&](const Collapse& c) { return c.num_triangles > num_triangles; });
    num_collapses = static_cast<size_t>(enough - collapses_.begin()) + (enough != collapses_.end());
  }
  AttributedMesh result;
  result.surface.positions = start_.mesh.positions;
  for (size_t i = 0; i < num_collapses; ++i) result.surface.positions[collapses_[i].kept] = collapses_[i].position;
  const std::vector<uint32_t> vertex = FollowMerges(start_.num_vertices(), collapses_.data(), num_collapses);
  std::vector<std::vector<uint32_t>> node(input_.attributes.size());
  for (size_t a = 0; a < input_.attributes.size(); ++a) {
    const MeshAttribute& input = input_.attributes[a];
    result.attributes.push_back({input.name, input.kind, input.components, {}, {}});
    WriteValues(num_collapses, histories_[a], start_.attributes[a], input, &result.attributes[a], &node[a]);
  }
  for (size_t f = 0; f < start_.mesh.triangles.size(); ++f) {
    const auto in_order_of_input = [&](Triangle t) {
      if (start_.flipped[f] != 0) std::swap(t[1], t[2]);
      return t;
    };
    Triangle t = start_.mesh.triangles[f];
    for (uint32_t& v : t) v = vertex[v];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    result.surface.triangles.push_back(in_order_of_input(t));
    if (!input_.groups.empty()) result.groups.push_back(input_.groups[start_.source_face[f]]);
    for (size_t a = 0; a < node.size(); ++a) {
      Triangle corners = start_.attributes[a].nodes[f];
      for (uint32_t& n : corners) n = n == kNone ? kNone : node[a][n];
      result.attributes[a].corners.push_back(in_order_of_input(corners));
    }
  }
  WeldExactly(&result);
  return result;
}

}  // namespace lacerta
