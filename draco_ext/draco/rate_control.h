// Meeting a target: the search over slopes of the rate-distortion curve for one candidate, and over base sizes for the best
// candidate.
#ifndef LACERTA_DRACO_RATE_CONTROL_H_
#define LACERTA_DRACO_RATE_CONTROL_H_

#include <functional>
#include <optional>

#include "draco/normal_mesh_candidate.h"
#include "lacerta/codec.h"
#include "lacerta/surface_distance.h"

namespace lacerta {

// A target with its unit resolved: either bytes or PSNR.
struct ResolvedTarget {
  bool is_rate = false;
  double bytes = 0;  // where is_rate: at most
  double psnr = 0;   // else: at least, dB
};

// Fails with kInvalidArgument where the value is not finite or out of a range that makes sense.
StatusOr<ResolvedTarget> ResolveTarget(const EncodeTarget& target, uint64_t num_input_vertices);

// A stream with what it was measured to be.
struct MeasuredStream {
  CodedStream stream;
  double psnr = 0;            // dB, two-sided, to the input
  double remesh_psnr = 0;     // of the unquantized remesh
  double normal_share = 0;
  bool meets_target = false;
};

// Codes the surface at the target with the base size that does best there: fewest bytes at a PSNR, highest PSNR at a number of
// bytes. Where no candidate reaches the target the nearest one is returned, with meets_target false.
// report: called with the share done, may be empty.
StatusOr<MeasuredStream> CodeAtTarget(const InputSurface& surface, const CollapseHistory& history,
                                      const SurfaceDistanceMeter& meter, const ResolvedTarget& target, EncodeMode mode,
                                      const std::function<void(double, const char*)>& progress);

}  // namespace lacerta

#endif  // LACERTA_DRACO_RATE_CONTROL_H_
