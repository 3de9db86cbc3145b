#include "draco/memory_plan.h"

#include <algorithm>
#include <string>

namespace lacerta {
namespace {

// Inputs of more triangles are taken in parts first, whatever the memory: measuring by way of LeanTree takes a tenth of the time more, a third less memory.
constexpr uint64_t kDense = 2'000'000;

// Bytes, seen with docs/results/memory_table.md. Of any encoding, and of the two threads that simplify parts; of a triangle of the input beside the mesh: in the
// usual way, measured by way of LeanTree, and while parts are simplified beside that tree.
constexpr uint64_t kAny = 80'000'000, kParts = 100'000'000;
constexpr uint64_t kPerUsual = 127, kPerLean = 11, kPerReduced = 26;
// Of a triangle of a run of simplification, of what is remeshed, and of a mesh whose subdivision is looked for.
constexpr uint64_t kPerSimplified = 600, kPerRemeshed = 3000, kPerSubdivided = 250;
// What stands for an input has at least so many triangles, and takes so many bytes: fewer would not take less memory in all.
constexpr uint64_t kFewest = 50'000, kLeastToRemesh = 115'000'000;

uint64_t BytesOf(uint64_t num_vertices, uint64_t num_triangles) { return sizeof(Vec3f) * num_vertices + sizeof(Triangle) * num_triangles; }

uint32_t AsCount(uint64_t count) { return static_cast<uint32_t>(std::min<uint64_t>(count, std::numeric_limits<uint32_t>::max())); }

}  // namespace

uint64_t LeastMemory(uint64_t num_vertices, uint64_t num_triangles) {
  return BytesOf(num_vertices, num_triangles) + std::max(kParts + kPerReduced * num_triangles, kAny + kLeastToRemesh + kPerLean * num_triangles);
}

StatusOr<MemoryPlan> PlanMemory(uint64_t num_vertices, uint64_t num_triangles, uint64_t memory) {
  MemoryPlan plan;
  InputProxyOptions& proxy = plan.proxy;
  plan.is_lean = num_triangles > kDense;
  if (memory == 0) return plan;
  const uint64_t least = LeastMemory(num_vertices, num_triangles), mesh = BytesOf(num_vertices, num_triangles);
  if (num_triangles > kFewest && memory < least) {
    constexpr uint64_t kMegabyte = 1'000'000;
    return LimitExceeded("not enough memory: " + std::to_string(num_triangles) + " triangles take at least " + std::to_string(least / kMegabyte + 1) +
                         " MB, of which " + std::to_string(memory / kMegabyte) + " are allowed; simplify the mesh first, or cut it into several");
  }
  const uint64_t remeshed = num_triangles > 2 * uint64_t{proxy.fewest_triangles} ? proxy.fewest_triangles : num_triangles;
  plan.is_lean = plan.is_lean || memory < kAny + mesh + kPerUsual * num_triangles + kPerRemeshed * remeshed;
  const uint64_t input = kAny + mesh + kPerLean * num_triangles;
  const uint64_t left = memory - std::min(memory, input);
  plan.may_unsubdivide = left >= kPerSubdivided * num_triangles;
  proxy.most_as_a_whole = AsCount(std::max(left / kPerSimplified, kFewest));
  proxy.most_triangles = AsCount(std::max(left / kPerRemeshed, kFewest));
  proxy.fewest_triangles = std::min(proxy.fewest_triangles, std::max(proxy.most_triangles / 2, AsCount(kFewest / 2)));
  return plan;
}

}  // namespace lacerta
