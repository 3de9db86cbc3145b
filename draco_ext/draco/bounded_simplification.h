// The simplification that streams without levels are made of.
#ifndef LACERTA_DRACO_BOUNDED_SIMPLIFICATION_H_
#define LACERTA_DRACO_BOUNDED_SIMPLIFICATION_H_

#include "draco/rate_control.h"
#include "lacerta/mesh.h"
#include "lacerta/surface_distance.h"
#include "remesh/simplify.h"

namespace lacerta {

// The collapses of a mesh. At a PSNR none takes a point farther from it than kFarthestOverMean of the distance that this stands for, which a mean over the area does
// not see; at a rate, which may be below what that takes, they go wherever they are cheapest. meter: gives the diagonal.
SimplificationSequence BoundedSimplification(const TriangleMesh& mesh, const SurfaceDistanceMeter& meter, const ResolvedTarget& target);

}  // namespace lacerta

#endif  // LACERTA_DRACO_BOUNDED_SIMPLIFICATION_H_
