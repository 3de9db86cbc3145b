// A family of primitives, all vertices or those that simplification left, rounded as far as the errors allow.
#ifndef LACERTA_PACK_ROUNDED_H_
#define LACERTA_PACK_ROUNDED_H_

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "document/primitive.h"
#include "lacerta/status.h"
#include "pack/family_meter.h"
#include "pack/rounded_family.h"

namespace lacerta {

// `primitives` are the meter's or, if `own_errors` (against the meter's, as measured) is given, a simplification of
// these. All get one lattice of positions and one step for each attribute. Which is cheapest is forecast triangle by
// triangle, counting that rounded positions slide along the surface and take texture and normals with them; then what is
// decoded is measured and the forecast corrected, until it meets the meter's targets (and `everywhere` as in
// ErrorTargets) and no cheaper precision is expected to; in the end attributes use up what room their errors have (DescentsWithin). What cannot be measured (no area) is held to the forecast. Where
// `is_usable` refuses what came out, positions get finer.
// Fails with kUnsupported where no precision meets them or what does is expected to take far more than `most_bytes`, and like
// EncodeDracoPrimitive.
StatusOr<RoundedFamily> RoundFamily(const std::vector<const Primitive*>& primitives, const FamilyMeter& meter,
                                    const SurfaceErrors* own_errors = nullptr,
                                    const std::vector<double>& everywhere = {},
                                    const std::function<bool(const RoundedFamily&)>& is_usable = nullptr,
                                    uint64_t most_bytes = std::numeric_limits<uint64_t>::max());

}  // namespace lacerta

#endif  // LACERTA_PACK_ROUNDED_H_
