// How far the values of an attribute may descend.
#ifndef LACERTA_PACK_DESCENTS_WITHIN_H_
#define LACERTA_PACK_DESCENTS_WITHIN_H_

#include <functional>
#include <vector>

#include "document/primitive.h"
#include "lacerta/mesh.h"
#include "pack/rounded_attributes.h"

namespace lacerta {

struct DescendedValues {
  int level = 0;
  std::vector<AccessorData> values;  // of each part, on lattice points, in the order of its primitive's vertices
  double error = 0.0;                // in the unit of the target
};

// By ValueDescent, on lattices near that of `level` on which it may take the fewest bits, with the steepest slope each for which error_of the values stays
// within `most_error` (in the unit of the target). None where there are no such values.
std::vector<DescendedValues> DescentsWithin(const std::vector<const Primitive*>& primitives, const std::vector<std::vector<Vec3f>>& positions,
                                            const RoundedAttribute& attribute, const std::vector<AccessorData>& values, int level, double most_error,
                                            const std::function<double(const std::vector<AccessorData>&)>& error_of);

}  // namespace lacerta

#endif  // LACERTA_PACK_DESCENTS_WITHIN_H_
