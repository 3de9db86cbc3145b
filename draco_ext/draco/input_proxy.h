// A mesh of fewer triangles that stands for a large input where it is remeshed, fitted and simplified: those take time and memory with every
// triangle, and what a dense scan has beyond the error that is asked for is noise to them. Errors are measured to the input itself.
#ifndef LACERTA_DRACO_INPUT_PROXY_H_
#define LACERTA_DRACO_INPUT_PROXY_H_

#include <cstdint>
#include <optional>

#include "draco/candidate_search.h"
#include "lacerta/mesh.h"
#include "lacerta/surface_distance.h"

namespace lacerta {

struct InputProxyOptions {
  uint32_t fewest_triangles = 200'000;
  double share = 0.15; // of the distance that the stream may have, at most
};

// The input, simplified to as few triangles as the options allow, by powers of two; none where that does not halve them.
//   cleaned  what Clean returned of the input
//   meter    of the input
//   target   of the stream
std::optional<TriangleMesh> InputProxy(const TriangleMesh& cleaned, const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                       const InputProxyOptions& options = {});

}  // namespace lacerta

#endif  // LACERTA_DRACO_INPUT_PROXY_H_
