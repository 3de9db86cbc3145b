// The steps of the lattice of one simplified mesh at which its stream meets a target.
#ifndef LACERTA_DRACO_ZERO_LEVEL_STEPS_H_
#define LACERTA_DRACO_ZERO_LEVEL_STEPS_H_

#include <cstddef>

#include "draco/rate_control.h"
#include "draco/zero_level.h"
#include "draco/zero_level_candidate.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"
#include "lacerta/surface_distance.h"

namespace lacerta {

struct ZeroLevelStream {
  Bytes stream;
  BaseCoding coding = BaseCoding::kStock;  // of the stream
  TriangleMesh mesh;   // as decoded
  double distance = 0;  // d_S to the input, model units
  double psnr = 0;      // dB
  bool meets_target = false;
  int measurements = 0;  // of the surface distance that led to the stream
};

// A coded mesh with its distance, by that many samples, and whether it meets the target.
ZeroLevelStream MeasuredZeroLevel(CodedZeroLevel coded, const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                  const SurfaceDistanceOptions& samples = SurfaceDistanceOptions::RmsOnly());

// What a mesh promises, by the samples of its fit.
struct ZeroLevelTrial {
  size_t num_triangles = 0;
  double fit_distortion = 0;  // squared d_S without a lattice, model units
  double step = 0;            // of the coding that came nearest to the target
  size_t bytes = 0;
  double distortion = 0;  // squared d_S
  double score = 0;       // less is better
  bool meets = false;
};

// Fits the candidate for its rate and codes it quickly, some times. meter: of the input. bias: of squared distances measured in full against those by the samples.
// Fails as EncodeLatticeMesh does.
StatusOr<ZeroLevelTrial> TrySteps(const ResolvedTarget& target, const SurfaceDistanceMeter& meter, double bias, ZeroLevelCandidate* candidate);

struct FinishedZeroLevel {
  ZeroLevelStream stream;
  double bias = 1;  // as TrySteps takes it
};

// The best of some codings, measured in full where they may be that. step: to begin with. tries: SearchEffort::zero_level_tries. Fails as EncodeLatticeMesh does.
StatusOr<FinishedZeroLevel> FinishSteps(const ResolvedTarget& target, const SurfaceDistanceMeter& meter, const ZeroLevelCandidate& candidate, double step, double tries);

}  // namespace lacerta

#endif  // LACERTA_DRACO_ZERO_LEVEL_STEPS_H_
