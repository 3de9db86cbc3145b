// A surface of fewer triangles that stands for a dense one with attributes where that is simplified and remeshed: those take time and memory
// with every triangle, and several runs. Errors are measured to the original itself.
#ifndef LACERTA_REMESH_ATTRIBUTED_PROXY_H_
#define LACERTA_REMESH_ATTRIBUTED_PROXY_H_

#include <cstdint>
#include <optional>

#include "lacerta/attributed_mesh.h"
#include "lacerta/status.h"
#include "remesh/surface_errors.h"

namespace lacerta {

struct AttributedProxyOptions {
  uint32_t fewest_triangles = 100'000;
  // Inputs of at least twice that are simplified to so many part by part first (simplify_in_parts.h), which keeps memory per triangle low and all
  // threads busy; then, where that is not near enough, to `most_at_once`, and as a whole only where that is more than half of them.
  uint32_t first_at_once = 250'000, most_at_once = 1'000'000;
  uint32_t part_triangles = 125'000;
  // What more triangles would take away from an error, over what is left of the error allowed beside the noise that simplification smooths
  // away (error_floor.h), at most:
  double share = 0.15;            // of the distance
  double attribute_share = 0.25;  // of every attribute's error and of the turned area
};

// The original, simplified to as few triangles as the options allow, by powers of two; none where that does not halve them. One that cannot
// be measured, as where a group has lost its area, does not count. Fails with kUnsupported, with the reason, where simplification is of no use at
// all: seams keep more than half of the triangles, errors at the largest size tried tell that nearly all are needed, or so many as
// `most_at_once` leave no room beside the targets.
//   original  one that CheckAttributedMesh accepts
//   meter     of the original
//   targets   of what it stands for; `everywhere` is left alone
StatusOr<std::optional<AttributedMesh>> AttributedProxy(const AttributedMesh& original, const SurfaceErrorMeter& meter,
                                                        const ErrorTargets& targets, const AttributedProxyOptions& options = {});

}  // namespace lacerta

#endif  // LACERTA_REMESH_ATTRIBUTED_PROXY_H_
