// How finely positions and attributes of a family are rounded.
#ifndef LACERTA_PACK_ROUNDING_LEVELS_H_
#define LACERTA_PACK_ROUNDING_LEVELS_H_

#include <algorithm>
#include <functional>
#include <vector>

namespace lacerta {

// Levels as in pack/rounded_attributes.h; those of attributes beyond kMostLevel: exact.
struct RoundingLevels {
  int positions = 0;
  std::vector<int> attributes;

  bool operator<(const RoundingLevels& other) const {
    return positions != other.positions ? positions < other.positions : attributes < other.attributes;
  }
  bool IsAsFineAs(const RoundingLevels& other) const {  // in everything
    return positions >= other.positions && std::equal(attributes.begin(), attributes.end(), other.attributes.begin(), std::greater_equal<>());
  }
};

}  // namespace lacerta

#endif  // LACERTA_PACK_ROUNDING_LEVELS_H_
