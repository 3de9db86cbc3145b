#include "pack/value_wedges.h"

#include "geometry/equal_rows.h"

namespace lacerta {
namespace {

// All components, one vertex after the other.
void Append(const AccessorData& data, uint64_t vertex, std::vector<float>* row) {
  for (uint32_t c = 0; c < data.components; ++c) row->push_back(data.Float(vertex, c));
}

}  // namespace

void AddTriangle(const std::array<uint32_t, 3>& corners, const TriangleMesh& surface, const Triangle& triangle, ValueWedges* wedges) {
  if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
  const Vec3d a = Vec3Cast<double>(surface.positions[triangle[0]]);
  wedges->areas.push_back(0.5 * Norm(Cross(Vec3Cast<double>(surface.positions[triangle[1]]) - a, Vec3Cast<double>(surface.positions[triangle[2]]) - a)));
  wedges->triangles.push_back(corners);
}

void FindCorners(ValueWedges* wedges) {
  wedges->first_corner.assign(wedges->size() + 1, 0);
  for (const std::array<uint32_t, 3>& t : wedges->triangles) {
    for (const uint32_t w : t) ++wedges->first_corner[w + 1];
  }
  for (size_t w = 0; w < wedges->size(); ++w) wedges->first_corner[w + 1] += wedges->first_corner[w];
  std::vector<uint32_t> next = wedges->first_corner;
  wedges->corners.resize(3 * wedges->triangles.size());
  for (uint32_t corner = 0; corner < wedges->corners.size(); ++corner) wedges->corners[next[wedges->triangles[corner / 3][corner % 3]]++] = corner;
}

ValueWedges WedgesOf(const Primitive& primitive, const std::vector<Vec3f>& positions, const AccessorData& wanted, const AccessorData& rounded, bool is_direction) {
  std::vector<float> rows;
  for (uint64_t v = 0; v < primitive.num_vertices; ++v) {
    rows.insert(rows.end(), {positions[v].x, positions[v].y, positions[v].z});
    Append(rounded, v, &rows);
  }
  const std::vector<uint32_t> first = FirstEqualRow(Span<const float>(rows), 3 + rounded.components);
  ValueWedges wedges;
  wedges.of_vertex.resize(first.size());
  for (uint32_t v = 0; v < first.size(); ++v) {
    if (first[v] != v) {
      wedges.of_vertex[v] = wedges.of_vertex[first[v]];
      continue;
    }
    wedges.of_vertex[v] = static_cast<uint32_t>(wedges.size());
    wedges.positions.push_back(Vec3Cast<double>(positions[v]));
    wedges.wanted.push_back(ValueAt(wanted, v, is_direction));
  }
  const TriangleMesh surface = Surface(primitive);
  for (const Triangle& t : primitive.triangles) AddTriangle({wedges.of_vertex[t[0]], wedges.of_vertex[t[1]], wedges.of_vertex[t[2]]}, surface, t, &wedges);
  FindCorners(&wedges);
  return wedges;
}

}  // namespace lacerta
