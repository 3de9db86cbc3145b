// How far a mesh may be simplified.
#ifndef LACERTA_DRACO_SIMPLIFIED_SIZE_H_
#define LACERTA_DRACO_SIMPLIFIED_SIZE_H_

#include <cmath>
#include <cstdint>

#include "draco/decoded_distance.h"
#include "lacerta/surface_distance.h"
#include "remesh/simplify.h"

namespace lacerta {

// About the fewest triangles at which the simplified mesh is within `distance` (d_S, model units) of the meter's original: by
// bisection of their logarithm down to `tolerance`. Between fewest_triangles() and num_input_triangles().
inline double SimplifiedSize(const SimplificationSequence& sequence, const SurfaceDistanceMeter& meter, double distance,
                             uint64_t num_samples, double tolerance) {
  double low = std::log(sequence.fewest_triangles()), high = std::log(sequence.num_input_triangles());
  while (high - low > tolerance) {
    const double middle = (low + high) / 2;
    const TriangleMesh simplified = sequence.MeshWith(static_cast<uint32_t>(std::exp(middle)));
    (DecodedDistance(meter, simplified, SurfaceDistanceOptions::RmsOnly(num_samples)) <= distance ? high : low) = middle;
  }
  return std::exp(high);
}

}  // namespace lacerta

#endif  // LACERTA_DRACO_SIMPLIFIED_SIZE_H_
