// How an input is encoded within the memory that is allowed.
#ifndef LACERTA_DRACO_MEMORY_PLAN_H_
#define LACERTA_DRACO_MEMORY_PLAN_H_

#include <cstdint>

#include "draco/input_proxy.h"
#include "lacerta/status.h"

namespace lacerta {

struct MemoryPlan {
  bool is_lean = false;          // cleaned in place, measured by SurfaceDistanceMeter::CreateLean
  bool may_unsubdivide = true;   // whether to look for subdivision, which takes several times the memory of the input
  InputProxyOptions proxy;
};

// The plan for an input of so many vertices and triangles within `memory` bytes, 0: any. Fails with kLimitExceeded, naming the least that would do,
// where the input leaves no room for a mesh that could stand for it. It depends on these numbers alone.
StatusOr<MemoryPlan> PlanMemory(uint64_t num_vertices, uint64_t num_triangles, uint64_t memory);

// The fewest bytes that are planned with for inputs of more than 50,000 triangles.
uint64_t LeastMemory(uint64_t num_vertices, uint64_t num_triangles);

}  // namespace lacerta

#endif  // LACERTA_DRACO_MEMORY_PLAN_H_
