// The uniform quantizer, of details and of base positions.
#ifndef LACERTA_ENCODER_QUANTIZER_H_
#define LACERTA_ENCODER_QUANTIZER_H_

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/coefficient_sets.h"
#include "lacerta/decoder.h"
#include "lacerta/mesh.h"

namespace lacerta {

// The index of the bin that holds `value`, within what a stream can hold; 0 where the step is 0 (set not coded) or the
// value not a number.
inline int32_t RoundToStep(float value, float step) {
  if (!(step > 0) || std::isnan(value)) return 0;
  constexpr auto kLimit = static_cast<float>(kMaxMagnitude);
  return static_cast<int32_t>(std::clamp(std::nearbyint(value / step), -kLimit, kLimit));
}

// `mesh` on the lattice of about `step`: the step is shortened to 8 significant bits, so that floats hold lattice points exactly; to
// fewer, 2 at least, where the mesh lies farther from zero than 2^16 steps; and raised where it lies farther than 2^22. A step that is
// not a number counts as 0, an infinite one as the largest float.
BaseMesh RoundToLattice(const TriangleMesh& mesh, float step);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_QUANTIZER_H_
