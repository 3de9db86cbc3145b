#include "common/base_tags.h"

#include <algorithm>
#include <utility>

#include "common/keyed_sort.h"

namespace lacerta {
namespace {

void ClearIfZero(std::vector<uint8_t>* flags) {
  if (std::all_of(flags->begin(), flags->end(), [](uint8_t flag) { return flag == 0; })) flags->clear();
}

}  // namespace

std::vector<uint32_t> FirstAtSamePoint(Span<const std::array<int32_t, 3>> lattice) {
  std::vector<uint32_t> first(lattice.size(), 0), column(lattice.size());
  for (size_t c = 0; c < 3; ++c) {
    for (size_t v = 0; v < lattice.size(); ++v) column[v] = static_cast<uint32_t>(lattice[v][c]);
    RefineEqual(column, &first);
  }
  return first;
}

bool JoinsAnything(const std::vector<uint32_t>& joined) {
  for (size_t v = 0; v < joined.size(); ++v) {
    if (joined[v] != v) return true;
  }
  return false;
}

BaseTags NormalizedTags(BaseTags tags) {
  ClearIfZero(&tags.still);
  ClearIfZero(&tags.crease);
  ClearIfZero(&tags.corner);
  if (!JoinsAnything(tags.joined)) tags.joined.clear();
  return tags;
}

size_t NumStill(const BaseTags& tags) {
  return static_cast<size_t>(std::count_if(tags.still.begin(), tags.still.end(), [](uint8_t flag) { return flag != 0; }));
}

std::vector<Triangle> WithStillTriangles(std::vector<Triangle> split, const std::vector<Triangle>& base_triangles,
                                         const BaseTags& tags) {
  split.reserve(split.size() + NumStill(tags));
  for (size_t f = 0; f < tags.still.size(); ++f) {
    if (tags.still[f] != 0) split.push_back(base_triangles[f]);
  }
  return split;
}

}  // namespace lacerta
