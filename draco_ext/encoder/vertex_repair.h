// Bounds the distance of every vertex to its own point of the input, which the sum that the descent lowers does not.
#ifndef LACERTA_ENCODER_VERTEX_REPAIR_H_
#define LACERTA_ENCODER_VERTEX_REPAIR_H_

#include "encoder/coefficient_descent.h"
#include "encoder/surface_target.h"

namespace lacerta {

// Rounds anew, in a closed loop, the coefficients and lattice points that leave a decoded vertex more than one step from its
// point along any axis of its local frame, or of the lattice. Sets in which nothing is left get step 0. Steps > 0.
void RepairVertices(const SurfaceTarget& target, CodedSurface* coded);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_VERTEX_REPAIR_H_
