// Work on the vertices of a large mesh range by range, so that what is sorted at a time stays small.
#ifndef LACERTA_GEOMETRY_VERTEX_RANGES_H_
#define LACERTA_GEOMETRY_VERTEX_RANGES_H_

#include <algorithm>
#include <cstdint>
#include <vector>

namespace lacerta {

struct VertexRange {
  uint32_t first, last;  // the last is not part of it
  bool Has(uint32_t v) const { return first <= v && v < last; }
};

// The vertices in ranges with at most `most` things each, but where a 4096th of the vertices has more.
//   for_each  (visit): calls visit(v) for each thing, v being the vertex that it belongs to
template <typename ForEach>
std::vector<VertexRange> CutVertices(uint32_t num_vertices, uint64_t most, const ForEach& for_each) {
  constexpr uint32_t kBlocks = 4096;
  const uint32_t size = num_vertices / kBlocks + 1;
  std::vector<uint64_t> counts(num_vertices / size + 1, 0);
  for_each([&](uint32_t v) { ++counts[v / size]; });
  std::vector<VertexRange> ranges;
  uint64_t count = 0;
  for (uint32_t block = 0; block < counts.size(); ++block) {
    const uint32_t first = block * size, last = std::min(num_vertices, first + size);
    if (ranges.empty() || count + counts[block] > most) {
      ranges.push_back({first, last});
      count = 0;
    }
    ranges.back().last = last;
    count += counts[block];
  }
  return ranges;
}

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_VERTEX_RANGES_H_
