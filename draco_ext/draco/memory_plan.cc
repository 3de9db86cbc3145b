#include "draco/memory_plan.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace lacerta {
namespace {

// Inputs of more triangles have a proxy, so that nothing but the measure looks at all of them.
constexpr uint64_t kDense = 400'000;

}  // namespace

StatusOr<MemoryPlan> PlanMemory(uint64_t num_vertices, uint64_t num_triangles, uint64_t memory) {
  (void)num_vertices;
  MemoryPlan plan;
  plan.is_lean = num_triangles > kDense;
  if (memory == 0) return plan;
  if (const char* s = getenv("H1_PLAN")) {
    unsigned a = 0, b = 0, c = 0;
    sscanf(s, "%u %u %u", &a, &b, &c);
    plan.is_lean = true;
    plan.may_unsubdivide = false;
    plan.proxy.most_at_once = a;
    plan.proxy.most_triangles = b;
    plan.proxy.part_triangles = c;
    plan.proxy.fewest_triangles = std::min(200'000u, b / 2);
  }
  return plan;
}

}  // namespace lacerta
