// A family of primitives in Draco form, with all its vertices or simplified.
#ifndef LACERTA_PACK_FAMILY_CANDIDATE_H_
#define LACERTA_PACK_FAMILY_CANDIDATE_H_

#include <cstdint>
#include <vector>

#include "document/draco_encode.h"
#include "lacerta/gltf.h"
#include "lacerta/status.h"
#include "pack/family_context.h"
#include "pack/family_meter.h"

namespace lacerta {

// A primitive in Draco form, and what its report is to say then.
struct DracoCandidate {
  DracoEncoded encoded;
  PrimitiveReport report;
  std::vector<MorphTarget> targets;
};

// All members of a family in Draco form: parallel to Family::members.
struct FamilyCandidate {
  std::vector<DracoCandidate> members;
  uint64_t bytes = 0;  // with FamilyContext::DracoJsonBytes
};

// With all vertices, where that is no hopeless way to stay under `most_bytes`. Sets *everywhere to RoundedFamily's.
StatusOr<FamilyCandidate> WithAllVertices(const FamilyContext& context, const FamilyMeter& meter, uint64_t most_bytes,
                                          std::vector<double>* everywhere);

// Simplified. `everywhere`: of WithAllVertices.
StatusOr<FamilyCandidate> Simplified(const FamilyContext& context, const FamilyMeter& meter, const std::vector<double>& everywhere);

}  // namespace lacerta

#endif  // LACERTA_PACK_FAMILY_CANDIDATE_H_
