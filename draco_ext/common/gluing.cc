#include "common/gluing.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "common/base_tags.h"
#include "common/subdivision.h"

namespace lacerta {

std::vector<uint32_t> PairHalfEdges(Span<const std::array<int32_t, 3>> lattice, const std::vector<Triangle>& triangles) {
  const std::vector<uint32_t> place = FirstAtSamePoint(lattice);
  struct Keyed {
    uint64_t key;
    uint32_t half_edge;
    bool is_reversed;
  };
  std::vector<Keyed> keyed;
  keyed.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (size_t k = 0; k < 3; ++k) {
      const uint64_t a = place[t[(k + 1) % 3]], b = place[t[(k + 2) % 3]];
      keyed.push_back({std::min(a, b) << 32 | std::max(a, b), static_cast<uint32_t>(keyed.size()), a > b});
    }
  }
  std::sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) { return std::tie(a.key, a.half_edge) < std::tie(b.key, b.half_edge); });
  std::vector<uint32_t> twins(keyed.size(), kNone);
  for (size_t begin = 0, end = 0; begin < keyed.size(); begin = end) {
    while (end < keyed.size() && keyed[end].key == keyed[begin].key) ++end;
    if (end - begin != 2 || keyed[begin].is_reversed == keyed[begin + 1].is_reversed) continue;
    twins[keyed[begin].half_edge] = keyed[begin + 1].half_edge;
    twins[keyed[begin + 1].half_edge] = keyed[begin].half_edge;
  }
  return twins;
}

GluedCorners GlueCorners(size_t num_triangles, Span<const uint32_t> twins, const std::function<bool(uint32_t)>& is_in,
                         const std::function<bool(uint32_t, uint32_t)>& is_glued) {
  std::vector<uint32_t> parent(3 * num_triangles);
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
    if (twin == kNone || twin < h || !is_in(h / 3) || !is_in(twin / 3) || !is_glued(h, twin)) continue;
    join(next(h), next(next(twin)));
    join(next(next(h)), next(twin));
  }
  GluedCorners glued;
  glued.vertices.resize(num_triangles);
  std::vector<uint32_t> number(parent.size(), kNone);
  for (uint32_t c = 0; c < parent.size(); ++c) {
    if (!is_in(c / 3)) {
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
