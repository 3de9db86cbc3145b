// Unit vectors as points of a square: the octahedron unfolded, in the orientation and with the lattice of Draco's NORMAL attributes.
#ifndef LACERTA_COMMON_OCTAHEDRAL_H_
#define LACERTA_COMMON_OCTAHEDRAL_H_

#include <array>
#include <cstdint>

#include "lacerta/vec3.h"

namespace lacerta {

inline constexpr int kLeastOctahedralBits = 2, kMostOctahedralBits = 16;

// The lattice point, both coordinates in 0 .. 2^bits - 2, nearest to a direction on the unfolded octahedron. Points at the rim that stand
// for one direction are one: the one with the smaller coordinates. A vector without direction gives that of +x.
std::array<int32_t, 2> OctahedralFromNormal(const Vec3f& normal, int bits);

// The direction of a lattice point, of unit length.
Vec3f NormalFromOctahedral(const std::array<int32_t, 2>& point, int bits);

}  // namespace lacerta

#endif  // LACERTA_COMMON_OCTAHEDRAL_H_
