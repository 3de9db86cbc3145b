// What lies around every vertex, as lists in one array.
#ifndef LACERTA_GEOMETRY_BY_VERTEX_H_
#define LACERTA_GEOMETRY_BY_VERTEX_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// Lists of numbers by vertex: those of v are items[first[v]] .. items[first[v + 1] - 1].
struct ByVertex {
  std::vector<uint32_t> first;  // #V + 1
  std::vector<uint32_t> items;

  Span<const uint32_t> operator[](size_t v) const { return {items.data() + first[v], first[v + 1] - first[v]}; }
};

// rows: N vertices each, as triangles have. Of each vertex the places N * row + k where it stands, ascending.
template <size_t N>
ByVertex PlacesByVertex(const std::vector<std::array<uint32_t, N>>& rows, size_t num_vertices) {
  ByVertex result;
  result.first.assign(num_vertices + 1, 0);
  for (const auto& row : rows) {
    for (const uint32_t v : row) ++result.first[v + 1];
  }
  for (size_t v = 0; v < num_vertices; ++v) result.first[v + 1] += result.first[v];
  result.items.resize(N * rows.size());
  std::vector<uint32_t> next(result.first.begin(), result.first.end() - 1);
  for (uint32_t place = 0; place < result.items.size(); ++place) result.items[next[rows[place / N][place % N]]++] = place;
  return result;
}

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_BY_VERTEX_H_
