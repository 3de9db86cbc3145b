#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/keyed_sort.h"
#include "lacerta/attributed_mesh.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;

// For every corner 3f + k the first one that has the same vertex, group and rows. Corners are sorted around each vertex alone, which most have few of.
std::vector<uint32_t> FirstEqualCorner(const AttributedMesh& mesh) {
  const std::vector<Triangle>& triangles = mesh.surface.triangles;
  const auto num_corners = static_cast<uint32_t>(3 * triangles.size());
  const auto vertex_of = [&](uint32_t corner) { return triangles[corner / 3][corner % 3]; };
  std::vector<uint32_t> end(mesh.surface.positions.size(), 0);  // of the corners of a vertex; first their number, then their beginning
  for (uint32_t corner = 0; corner < num_corners; ++corner) ++end[vertex_of(corner)];
  uint32_t begin = 0;
  for (uint32_t& e : end) begin += std::exchange(e, begin);
  std::vector<KeyedIndex> around(num_corners);
  for (uint32_t corner = 0; corner < num_corners; ++corner) around[end[vertex_of(corner)]++].index = corner;
  std::vector<uint32_t> first(num_corners);
  begin = 0;
  for (const uint32_t e : end) {
    for (uint32_t i = begin; i < e; ++i) first[around[i].index] = around[begin].index;
    // By one column after the other: what was equal so far and is equal in it stays so.
    for (size_t column = 0; column <= mesh.attributes.size() && e - begin > 1; ++column) {
      for (uint32_t i = begin; i < e; ++i) {
        const uint32_t c = around[i].index, value = column == 0 ? mesh.GroupOf(c / 3) : mesh.attributes[column - 1].corners[c / 3][c % 3];
        around[i].key = uint64_t{first[c]} << 32 | value;
      }
      FindFirstEqual(&around, begin, e, &first);
    }
    begin = e;
  }
  return first;
}

// Adds the values of a corner to those attributes of the soup that it has.
void AppendVertex(const AttributedMesh& mesh, uint32_t corner, VertexSoup* soup) {
  soup->positions.push_back(mesh.surface.positions[mesh.surface.triangles[corner / 3][corner % 3]]);
  size_t present = 0;
  for (const MeshAttribute& attribute : mesh.attributes) {
    const uint32_t row = attribute.corners[corner / 3][corner % 3];
    if (row == kNone) continue;
    const float* const values = attribute.values.data() + size_t{row} * attribute.components;
    std::vector<float>* const to = &soup->attributes[present++].values;
    to->insert(to->end(), values, values + attribute.components);
  }
}

}  // namespace

std::vector<VertexSoup> SplitIntoSoups(const AttributedMesh& mesh, uint32_t num_groups) {
  const std::vector<uint32_t> first = FirstEqualCorner(mesh);
  std::vector<uint32_t> number(first.size());
  std::vector<VertexSoup> soups(num_groups);
  for (uint32_t f = 0; f < mesh.surface.triangles.size(); ++f) {
    VertexSoup& soup = soups[mesh.GroupOf(f)];
    if (soup.triangles.empty()) {
      for (const MeshAttribute& a : mesh.attributes) {
        if (a.corners[f][0] != kNone) soup.attributes.push_back({a.name, a.kind, a.components, {}});
      }
    }
    for (uint32_t corner = 3 * f; corner < 3 * f + 3; ++corner) {
      if (first[corner] != corner) {
        number[corner] = number[first[corner]];
        continue;
      }
      number[corner] = static_cast<uint32_t>(soup.positions.size());
      AppendVertex(mesh, corner, &soup);
    }
    soup.triangles.push_back({number[size_t{3} * f], number[size_t{3} * f + 1], number[size_t{3} * f + 2]});
  }
  return soups;
}

}  // namespace lacerta
