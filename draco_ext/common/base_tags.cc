#include "common/base_tags.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace lacerta {
namespace {

void ClearIfZero(std::vector<uint8_t>* flags) {
  if (std::all_of(flags->begin(), flags->end(), [](uint8_t flag) { return flag == 0; })) flags->clear();
}

}  // namespace

std::vector<uint32_t> FirstAtSamePoint(Span<const std::array<int32_t, 3>> lattice) {
  std::vector<uint32_t> order(lattice.size()), first(lattice.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return lattice[a] != lattice[b] ? lattice[a] < lattice[b] : a < b;
  });
  for (size_t i = 0; i < order.size(); ++i) {
    first[order[i]] = i > 0 && lattice[order[i - 1]] == lattice[order[i]] ? first[order[i - 1]] : order[i];
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
