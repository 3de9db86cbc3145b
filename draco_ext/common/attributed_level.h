// Groups of the triangles of a level.
#ifndef LACERTA_COMMON_ATTRIBUTED_LEVEL_H_
#define LACERTA_COMMON_ATTRIBUTED_LEVEL_H_

#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// In the order of MeshAtLevel: those of the split triangles, 4^level each, then those of the still ones. base_groups: #F0, or empty.
inline std::vector<uint32_t> GroupsAtLevel(const std::vector<uint32_t>& base_groups, const BaseTags& tags, int level) {
  if (level == 0) return base_groups;
  std::vector<uint32_t> groups;
  const auto is_still = [&](size_t f) { return !tags.still.empty() && tags.still[f] != 0; };
  for (size_t f = 0; f < base_groups.size(); ++f) {
    if (!is_still(f)) groups.insert(groups.end(), size_t{1} << 2 * level, base_groups[f]);
  }
  for (size_t f = 0; f < base_groups.size(); ++f) {
    if (is_still(f)) groups.push_back(base_groups[f]);
  }
  return groups;
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_ATTRIBUTED_LEVEL_H_
