// The smallest progressive stream of a surface with attributes that meets error targets.
#ifndef LACERTA_DRACO_ATTRIBUTED_SEARCH_H_
#define LACERTA_DRACO_ATTRIBUTED_SEARCH_H_

#include <cstddef>
#include <cstdint>
#include <limits>

#include "draco/attributed_candidate.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/codec.h"
#include "lacerta/status.h"
#include "remesh/simplify_to_errors.h"

namespace lacerta {

struct AttributedSearchOptions {
  Effort effort = Effort::kNormal;
  // Streams of so many bytes or more are of no use: the search ends as soon as none seems to get below.
  size_t most_bytes = std::numeric_limits<size_t>::max();
  uint64_t num_samples = 100'000;  // of the measure that the stream is held to
  AttributeMeaning meaning = {};
};

// Walks over base sizes, from a usual one for as long as streams get smaller, and at each over precisions; ends early where most_bytes
// seem out of reach. meter: of `mesh`, or of what it is the AttributedProxy of, with the texture size that texels in `targets` refer to.
// kUnsupported, with the reason, where the surface cannot be remeshed with its seams, where no base leads to the targets, and where
// most_bytes are not enough; all that is returned meets the targets, `turned` among them where it is bounded.
StatusOr<AttributedTrial> SmallestAttributedStream(const AttributedMesh& mesh, const SurfaceErrorMeter& meter, const ErrorTargets& targets,
                                                   const AttributedSearchOptions& options = {});

}  // namespace lacerta

#endif  // LACERTA_DRACO_ATTRIBUTED_SEARCH_H_
