#include "pack/value_wedges.h"

#include <utility>

#include "geometry/equal_rows.h"
#include "geometry/vertex_area_vectors.h"

namespace lacerta {

void AddTriangle(const std::array<uint32_t, 3>& corners, const TriangleMesh& surface, const Triangle& triangle, ValueWedges* wedges) {
  if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
  wedges->areas.push_back(0.5 * Norm(AreaVector(surface.positions, triangle)));
  wedges->triangles.push_back(corners);
}

ValueWedges WedgesOf(const Primitive& primitive, const std::vector<Vec3f>& positions, const AccessorData& wanted, const AccessorData& rounded, bool is_direction) {
  std::vector<float> rows;
  for (uint64_t v = 0; v < primitive.num_vertices; ++v) {
    rows.insert(rows.end(), {positions[v].x, positions[v].y, positions[v].z});
    for (uint32_t c = 0; c < rounded.components; ++c) rows.push_back(rounded.Float(v, c));
  }
  DistinctRows distinct = NumberRows(Span<const float>(rows), 3 + rounded.components);
  ValueWedges wedges;
  for (const uint32_t v : distinct.rows) {
    wedges.positions.push_back(Vec3Cast<double>(positions[v]));
    wedges.wanted.push_back(ValueAt(wanted, v, is_direction));
  }
  wedges.of_vertex = std::move(distinct.of_row);
  const TriangleMesh surface = Surface(primitive);
  for (const Triangle& t : primitive.triangles) AddTriangle({wedges.of_vertex[t[0]], wedges.of_vertex[t[1]], wedges.of_vertex[t[2]]}, surface, t, &wedges);
  wedges.corners = PlacesByVertex(wedges.triangles, wedges.size());
  return wedges;
}

}  // namespace lacerta
