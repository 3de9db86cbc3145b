// A family of primitives as one simplified surface in Draco form.
#ifndef LACERTA_PACK_SIMPLIFIED_H_
#define LACERTA_PACK_SIMPLIFIED_H_

#include <functional>
#include <vector>

#include "lacerta/codec.h"
#include "lacerta/status.h"
#include "pack/family_meter.h"
#include "pack/rounded.h"

namespace lacerta {

struct SimplifiedFamily {
  std::vector<Primitive> primitives;  // in the order of the meter's
  SurfaceErrors errors;               // against the meter's, as it measures
};

// Simplifies the meter's primitives (one mesh or meshes that touch) as one surface, so that their borders stay joined, and calls `round` with what
// is left. Leaves room in the targets for rounding: more of it where `round` fails with kUnsupported at first. Fails as SimplifyFamily.
StatusOr<RoundedFamily> SimplifyAndRound(const FamilyMeter& meter, const std::vector<double>& everywhere,
                                         const std::function<StatusOr<RoundedFamily>(SimplifiedFamily)>& round);

// The same, rounded by RoundFamily; at Effort::kBest with more and with less room for rounding as well, of which the smallest is kept. The errors of
// what is decoded, measured on the surface, meet the meter's targets and `everywhere` (as in ErrorTargets, for the attributes of
// FamilyMeter::original). Fails with kUnsupported where attributes cannot be interpolated (joints without a skin, application attributes) or the errors
// are not met.
StatusOr<RoundedFamily> SimplifyFamily(const FamilyMeter& meter, const std::vector<double>& everywhere = {}, Effort effort = Effort::kNormal);

}  // namespace lacerta

#endif  // LACERTA_PACK_SIMPLIFIED_H_
