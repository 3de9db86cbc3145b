#ifndef LACERTA_COMMON_LATTICE_POINT_H_
#define LACERTA_COMMON_LATTICE_POINT_H_

#include <array>
#include <cstdint>

namespace lacerta {

using LatticePoint = std::array<int32_t, 3>;

}  // namespace lacerta

#endif  // LACERTA_COMMON_LATTICE_POINT_H_
