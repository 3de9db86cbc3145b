#include "encoder/closed_mesh.h"

#include <algorithm>
#include <utility>

namespace lacerta {
namespace {

std::vector<uint32_t> FindTwins(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<uint64_t, uint32_t>> keyed;
  keyed.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (size_t k = 0; k < 3; ++k) {
      const uint64_t a = t[(k + 1) % 3], b = t[(k + 2) % 3];
      keyed.emplace_back(std::min(a, b) << 32 | std::max(a, b), static_cast<uint32_t>(keyed.size()));
    }
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<uint32_t> twin(keyed.size());
  for (size_t i = 0; i + 1 < keyed.size(); i += 2) {
    twin[keyed[i].second] = keyed[i + 1].second;
    twin[keyed[i + 1].second] = keyed[i].second;
  }
  return twin;
}

}  // namespace

ClosedMesh CloseBorders(const Topology& t) {
  ClosedMesh closed;
  closed.num_vertices = t.num_vertices;
  closed.num_real_triangles = t.num_faces();
  closed.triangles = t.triangles;
  // The vertex after each on the border, as the triangle there runs.
  std::vector<uint32_t> next(t.num_vertices, kNone);
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    if (t.is_border(e)) next[t.edges[e][0]] = t.edges[e][1];
  }
  for (uint32_t first = 0; first < t.num_vertices; ++first) {
    if (next[first] == kNone) continue;
    const uint32_t dummy = t.num_vertices + closed.num_dummies++;
    for (uint32_t v = first; next[v] != kNone;) {
      const uint32_t w = std::exchange(next[v], kNone);
      closed.triangles.push_back({w, v, dummy});
      v = w;
    }
  }
  closed.twin = FindTwins(closed.triangles);
  closed.valence.assign(closed.num_vertices + closed.num_dummies, 0);
  for (const Triangle& triangle : closed.triangles) {
    for (const uint32_t v : triangle) ++closed.valence[v];
  }
  return closed;
}

}  // namespace lacerta
