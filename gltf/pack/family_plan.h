// What becomes of the primitives of a family: the smallest of what meets the target.
#ifndef LACERTA_PACK_FAMILY_PLAN_H_
#define LACERTA_PACK_FAMILY_PLAN_H_

#include <vector>

#include "lacerta/status.h"
#include "pack/family_context.h"
#include "pack/plan.h"

namespace lacerta {

// The plan of a primitive that stays as it is.
PrimitivePlan UntouchedPlan(const PackedScene& scene, size_t source);

// Why the surface of a source alone cannot be a stream; empty when it can. Sets *smooth where normals go with the surface.
std::string ReasonAgainstProgressive(const FamilyContext& context, size_t source, bool* smooth);

// Parallel to the members. Targets in bytes or bits per vertex hold for a single surface that can be a stream alone, with others they
// say nothing. Fails where the options do not go together, naming the primitive.
StatusOr<std::vector<PrimitivePlan>> PlanFamily(const FamilyContext& context);

}  // namespace lacerta

#endif  // LACERTA_PACK_FAMILY_PLAN_H_
