// The search of the precisions at which one remesh with attributes just meets error targets.
#ifndef LACERTA_DRACO_PRECISION_SEARCH_H_
#define LACERTA_DRACO_PRECISION_SEARCH_H_

#include "draco/attributed_candidate.h"
#include "lacerta/status.h"
#include "remesh/attributed_remesh.h"
#include "remesh/simplify_to_errors.h"

namespace lacerta {

// input: what `mesh` comes from. remesh: errors of `mesh` before anything is quantized. Else as AttributedCandidate::Meet.
StatusOr<AttributedTrial> SearchPrecisions(const AttributedNormalMesh& mesh, const SurfaceErrors& remesh, const AttributedSurface& input,
                                           const ErrorTargets& targets, const MeetOptions& options);

}  // namespace lacerta

#endif  // LACERTA_DRACO_PRECISION_SEARCH_H_
