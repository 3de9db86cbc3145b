// A family of primitives with morph targets as one simplified surface.
#ifndef LACERTA_PACK_SIMPLIFIED_MORPHS_H_
#define LACERTA_PACK_SIMPLIFIED_MORPHS_H_

#include <cstdint>
#include <vector>

#include "lacerta/status.h"
#include "pack/family_meter.h"
#include "pack/morphs.h"
#include "pack/rounded.h"

namespace lacerta {

struct MorphedFamily {
  RoundedFamily rounded;
  std::vector<std::vector<MorphTarget>> targets;  // of each member, in the order of its decoded vertices
};

// SimplifyFamily of primitives with these targets (parallel to the meter's primitives), whose offsets are simplified
// with them, and rounded (RoundTargets) or left floats. With each of the targets at weight 1, and in each of the mixes, the surface is within the meter's error.
// Fails like SimplifyFamily and WithTargets.
StatusOr<MorphedFamily> SimplifyMorphedFamily(const FamilyMeter& meter,
                                              const std::vector<const std::vector<MorphTarget>*>& targets,
                                              const std::vector<TargetMix>& mixes, bool round_targets, uint64_t texel_side,
                                              const std::vector<double>& everywhere);

}  // namespace lacerta

#endif  // LACERTA_PACK_SIMPLIFIED_MORPHS_H_
