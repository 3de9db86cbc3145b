// The header of a base in compact form (docs/format.md, "Compact base").
#ifndef LACERTA_COMMON_COMPACT_BASE_LAYOUT_H_
#define LACERTA_COMMON_COMPACT_BASE_LAYOUT_H_

#include <array>
#include <cstdint>

#include "lacerta/vec3.h"

namespace lacerta {

struct CompactBaseHeader {
  uint32_t num_vertices = 0;
  uint32_t num_borders = 0;
  float step = 0;                    // model units
  Vec3f offset{0, 0, 0};             // model units
  int extent_bits = 0;               // of the largest difference between two values of a coordinate
  std::array<int32_t, 3> origin{};   // of the first vertex
};

inline constexpr int kMaxExtentBits = 25;

}  // namespace lacerta

#endif  // LACERTA_COMMON_COMPACT_BASE_LAYOUT_H_
