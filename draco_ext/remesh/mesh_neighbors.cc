#include "remesh/mesh_neighbors.h"

#include <algorithm>
#include <utility>

namespace lacerta {
namespace {

// rows: one array of vertices for each number.
template <size_t N>
ByVertex Invert(const std::vector<std::array<uint32_t, N>>& rows, size_t num_vertices) {
  ByVertex result = PlacesByVertex(rows, num_vertices);
  for (uint32_t& item : result.items) item /= N;
  return result;
}

}  // namespace

MeshNeighbors::MeshNeighbors(const TriangleMesh& mesh) : face_edges(mesh.triangles.size()) {
  struct Side {
    std::array<uint32_t, 2> edge;
    uint32_t corner;
    bool operator<(const Side& b) const { return edge != b.edge ? edge < b.edge : corner < b.corner; }
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (uint32_t corner = 0; corner < 3 * mesh.triangles.size(); ++corner) {
    const Triangle& t = mesh.triangles[corner / 3];
    const uint32_t a = t[(corner + 1) % 3], b = t[(corner + 2) % 3];
    sides.push_back({{std::min(a, b), std::max(a, b)}, corner});
  }
  std::sort(sides.begin(), sides.end());
  const auto across = [&](const Side& side) { return mesh.triangles[side.corner / 3][side.corner % 3]; };
  for (size_t i = 0; i < sides.size();) {
    size_t end = i;
    for (; end < sides.size() && sides[end].edge == sides[i].edge; ++end) {
      face_edges[sides[end].corner / 3][sides[end].corner % 3] = static_cast<uint32_t>(edges.size());
    }
    const std::array<uint32_t, 2> e = sides[i].edge;
    if (end - i == 2 && across(sides[i]) != across(sides[i + 1])) flaps.push_back({e[0], e[1], across(sides[i]), across(sides[i + 1])});
    edges.push_back(e);
    i = end;
  }
  const size_t num_vertices = mesh.positions.size();
  vertex_faces = Invert(mesh.triangles, num_vertices);
  vertex_edges = Invert(edges, num_vertices);
  vertex_flaps = Invert(flaps, num_vertices);
}

}  // namespace lacerta
