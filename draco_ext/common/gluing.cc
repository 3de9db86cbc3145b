#include "common/gluing.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "common/base_tags.h"
#include "common/keyed_sort.h"
#include "common/subdivision.h"

namespace lacerta {

std::vector<uint32_t> PairHalfEdges(Span<const std::array<int32_t, 3>> lattice, const std::vector<Triangle>& triangles) {
  const std::vector<uint32_t> place = FirstAtSamePoint(lattice);
  std::vector<KeyedIndex> keyed(3 * triangles.size());
  const auto ends_of = [&](uint32_t h) {
    const Triangle& t = triangles[h / 3];
    return std::pair<uint64_t, uint64_t>(place[t[(h + 1) % 3]], place[t[(h + 2) % 3]]);
  };
  for (uint32_t h = 0; h < keyed.size(); ++h) {
    const auto [a, b] = ends_of(h);
    keyed[h] = {std::min(a, b) << 32 | std::max(a, b), h};
  }
  SortKeyed(&keyed, 0, keyed.size());
  std::vector<uint32_t> twins(keyed.size(), kNone);
  for (size_t begin = 0, end = 0; begin < keyed.size(); begin = end) {
    while (end < keyed.size() && keyed[end].key == keyed[begin].key) ++end;
    if (end - begin != 2) continue;
    const uint32_t h = keyed[begin].index, twin = keyed[begin + 1].index;
    const auto [from, to] = ends_of(h);
    if (from == to || ends_of(twin).first == from) continue;
    twins[h] = twin;
    twins[twin] = h;
  }
  return twins;
}

GluedCorners GlueCorners(Span<const uint8_t> is_in, Span<const uint32_t> twins) {
  std::vector<uint32_t> parent(3 * is_in.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto find = [&](uint32_t c) {
    while (parent[c] != c) c = parent[c] = parent[parent[c]];
    return c;
  };
  const auto join = [&](uint32_t a, uint32_t b) {
    const auto [first, second] = std::minmax({find(a), find(b)});
    parent[second] = first;  // halving paths keeps this O(n log n)
  };
  const auto next = [](uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; };
  for (uint32_t h = 0; h < twins.size(); ++h) {
    const uint32_t twin = twins[h];
    if (twin == kNone || twin < h || is_in[h / 3] == 0 || is_in[twin / 3] == 0) continue;
    join(next(h), next(next(twin)));
    join(next(next(h)), next(twin));
  }
  GluedCorners glued;
  glued.vertices.resize(is_in.size());
  std::vector<uint32_t> number(parent.size(), kNone);
  for (uint32_t c = 0; c < parent.size(); ++c) {
    if (is_in[c / 3] == 0) {
      glued.vertices[c / 3][c % 3] = kNone;
      continue;
    }
    uint32_t& n = number[find(c)];
    if (n == kNone) {
      n = static_cast<uint32_t>(glued.first_corner.size());
      glued.first_corner.push_back(c);
    }
    glued.vertices[c / 3][c % 3] = n;
  }
  return glued;
}

}  // namespace lacerta
