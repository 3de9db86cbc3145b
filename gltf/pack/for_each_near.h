// Walking over the points around one.
#ifndef LACERTA_PACK_FOR_EACH_NEAR_H_
#define LACERTA_PACK_FOR_EACH_NEAR_H_

#include <cstdint>

#include "pack/lattice_points.h"

namespace lacerta {

// Calls visit(point) for all that are no more than `reach` steps off in any of the coordinates, `around` first.
template <typename Visit>
void ForEachNear(const LatticePoint& around, uint32_t coordinates, int reach, const Visit& visit) {
  visit(around);
  LatticePoint offset = {};
  for (uint32_t c = 0; c < coordinates; ++c) offset[c] = -reach;
  for (;;) {
    LatticePoint point = around;
    for (uint32_t c = 0; c < coordinates; ++c) point[c] += offset[c];
    if (point != around) visit(point);
    uint32_t c = 0;
    while (c < coordinates && ++offset[c] > reach) offset[c++] = -reach;
    if (c == coordinates) return;
  }
}

}  // namespace lacerta

#endif  // LACERTA_PACK_FOR_EACH_NEAR_H_
