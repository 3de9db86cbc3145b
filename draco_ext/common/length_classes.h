// Long edges have larger details than short ones, even where the details around are known: what the lengths of the base say about the
// coefficients of all levels (docs/decisions/0023-length-classes.md). Specified in docs/format.md, "Contexts".
#ifndef LACERTA_COMMON_LENGTH_CLASSES_H_
#define LACERTA_COMMON_LENGTH_CLASSES_H_

#include <array>
#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"

namespace lacerta {

enum LengthClass : uint8_t { kUsualLength, kShortLength, kLongLength };

// Classes of the edges of a base: #E. Short is an edge whose squared length is under a half of the mean, long one over three halves,
// all modulo 2^64: lattices that are legal and reach that have edges of any class.
//   lattice  #V0 points, magnitudes below 2^24
std::vector<uint8_t> LengthClasses(const Topology& base, Span<const std::array<int32_t, 3>> lattice);

}  // namespace lacerta

#endif  // LACERTA_COMMON_LENGTH_CLASSES_H_
