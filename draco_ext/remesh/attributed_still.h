// The components of a surface with attributes that are not remeshed, with as few triangles as an error allows.
#ifndef LACERTA_REMESH_ATTRIBUTED_STILL_H_
#define LACERTA_REMESH_ATTRIBUTED_STILL_H_

#include "lacerta/status.h"
#include "remesh/attributed_parts.h"
#include "remesh/simplify_to_errors.h"

namespace lacerta {

// Simplifies parts->still until its own errors are at the targets (SimplifyToErrors): an oriented manifold comes out again, with the
// attributes and groups that it had. It stays as it is where it has no area, hangs together with parts->refined at some point, or
// would not stay a manifold. texture_size: as for SurfaceErrorMeter.
Status SimplifyStill(const ErrorTargets& targets, double texture_size, AttributedParts* parts);

}  // namespace lacerta

#endif  // LACERTA_REMESH_ATTRIBUTED_STILL_H_
