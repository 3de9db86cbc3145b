#include "remesh/edge_corners.h"

#include <algorithm>
#include <utility>

namespace lacerta {

EdgeCorners GroupByEdge(size_t num_vertices, const std::vector<Triangle>& triangles) {
  const uint32_t num_corners = static_cast<uint32_t>(triangles.size() * 3);
  const auto low = [&](uint32_t c) { return std::min(StartOfEdge(triangles, c), EndOfEdge(triangles, c)); };
  const auto high = [&](uint32_t c) { return std::max(StartOfEdge(triangles, c), EndOfEdge(triangles, c)); };
  // One bucket per lower vertex, then a sort by the higher one: faster than one sort, and as bounded.
  std::vector<uint32_t> bucket(num_vertices + 1, 0);
  for (uint32_t c = 0; c < num_corners; ++c) ++bucket[low(c) + 1];
  for (size_t v = 0; v < num_vertices; ++v) bucket[v + 1] += bucket[v];
  std::vector<std::pair<uint32_t, uint32_t>> keyed(num_corners);
  std::vector<uint32_t> fill(bucket.begin(), bucket.end() - 1);
  for (uint32_t c = 0; c < num_corners; ++c) keyed[fill[low(c)]++] = {high(c), c};

  EdgeCorners result;
  result.corners.reserve(num_corners);
  for (size_t v = 0; v < num_vertices; ++v) {
    std::sort(keyed.begin() + bucket[v], keyed.begin() + bucket[v + 1]);
    for (uint32_t i = bucket[v]; i < bucket[v + 1]; ++i) {
      if (i == bucket[v] || keyed[i].first != keyed[i - 1].first) result.begin.push_back(i);
      result.corners.push_back(keyed[i].second);
    }
  }
  result.begin.push_back(num_corners);
  return result;
}

}  // namespace lacerta
