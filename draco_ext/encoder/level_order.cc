#include "encoder/level_order.h"

#include <string>
#include <utility>

#include "common/subdivision.h"

namespace lacerta {
namespace {

// The split triangles in both orders, each on its way down the levels.
struct OrderedLevel {
  Topology coded, source;
  std::vector<FaceSource> faces;  // #F of `coded`

  uint32_t SourceEdge(uint32_t e) const {
    const uint32_t f = coded.edge_faces[e][0];
    const uint32_t k = static_cast<uint32_t>(EdgeCorner(coded, f, e));
    return source.face_edges[faces[f].face][(k + faces[f].rotation) % 3];
  }
};

StatusOr<OrderedLevel> BaseLevel(const LevelOrder& order) {
  if (order.coded.size() != order.faces.size() || order.source.size() != order.faces.size()) return InvalidArgument("the two orders have not the same triangles");
  std::vector<uint8_t> is_split(order.source.size(), 1);
  for (size_t f = 0; f < order.still.size(); ++f) is_split[order.faces[f].face] = order.still[f] == 0;
  std::vector<uint32_t> number(order.source.size(), kNone);
  std::vector<Triangle> source, coded;
  for (size_t f = 0; f < order.source.size(); ++f) {
    if (is_split[f] == 0 || order.source[f][0] == kNone) continue;
    number[f] = static_cast<uint32_t>(source.size());
    source.push_back(order.source[f]);
  }
  OrderedLevel level;
  for (size_t f = 0; f < order.coded.size(); ++f) {
    const FaceSource from = order.faces[f];
    if (is_split[from.face] == 0 || order.coded[f][0] == kNone) continue;
    if (number[from.face] == kNone) return InvalidArgument("triangle " + std::to_string(from.face) + " has no value");
    coded.push_back(order.coded[f]);
    level.faces.push_back({number[from.face], from.rotation});
  }
  LACERTA_ASSIGN_OR_RETURN(level.coded, BuildTopology(order.num_coded_rows, coded));
  LACERTA_ASSIGN_OR_RETURN(level.source, BuildTopology(order.num_source_rows, source));
  return level;
}

void RefineOrder(OrderedLevel* level) {
  level->coded = Refine(level->coded);
  level->source = Refine(level->source);
  std::vector<FaceSource> finer;
  finer.reserve(4 * level->faces.size());
  for (const FaceSource& f : level->faces) {
    // Corner faces begin at their corner, whatever the rotation; the middle face turns with its parent.
    for (uint32_t k = 0; k < 3; ++k) finer.push_back({4 * f.face + (k + f.rotation) % 3, 0});
    finer.push_back({4 * f.face + 3, f.rotation});
  }
  level->faces = std::move(finer);
}

}  // namespace

StatusOr<std::vector<uint32_t>> SourceRows(const LevelOrder& order, int num_levels) {
  LACERTA_ASSIGN_OR_RETURN(OrderedLevel level, BaseLevel(order));
  std::vector<uint32_t> rows(order.num_coded_rows, kNone);
  for (size_t f = 0; f < order.coded.size(); ++f) {
    const FaceSource from = order.faces[f];
    if (order.coded[f][0] == kNone) continue;
    for (uint32_t k = 0; k < 3; ++k) rows[order.coded[f][k]] = order.source[from.face][(k + from.rotation) % 3];
  }
  for (int i = 0; i < num_levels; ++i) {
    if (i > 0) RefineOrder(&level);
    for (uint32_t e = 0; e < level.coded.num_edges(); ++e) rows.push_back(level.source.num_vertices + level.SourceEdge(e));
  }
  return rows;
}

StatusOr<std::vector<uint32_t>> SourceEdges(const LevelOrder& order) {
  LACERTA_ASSIGN_OR_RETURN(const OrderedLevel level, BaseLevel(order));
  std::vector<uint32_t> edges;
  for (uint32_t e = 0; e < level.coded.num_edges(); ++e) edges.push_back(level.SourceEdge(e));
  return edges;
}

}  // namespace lacerta
