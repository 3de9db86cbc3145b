// How far a decoded mesh is from the input.
#ifndef LACERTA_DRACO_DECODED_DISTANCE_H_
#define LACERTA_DRACO_DECODED_DISTANCE_H_

#include <cstdint>

#include "lacerta/mesh.h"
#include "lacerta/surface_distance.h"

namespace lacerta {

// d_S in model units. A lattice may be so coarse that no area is left to measure: then the mesh is as far off as the input is large.
inline double DecodedDistance(const SurfaceDistanceMeter& meter, const TriangleMesh& decoded,
                              const SurfaceDistanceOptions& options = SurfaceDistanceOptions::RmsOnly()) {
  const StatusOr<SurfaceDistance> distance = meter.Measure(decoded, options);
  return distance.ok() ? distance.value().Rms() : meter.diagonal();
}

// The same as PSNR, dB, from so many samples.
inline double DecodedPsnr(const SurfaceDistanceMeter& meter, const TriangleMesh& decoded, uint64_t num_samples) {
  return Psnr(DecodedDistance(meter, decoded, SurfaceDistanceOptions::RmsOnly(num_samples)), meter.diagonal());
}

}  // namespace lacerta

#endif  // LACERTA_DRACO_DECODED_DISTANCE_H_
