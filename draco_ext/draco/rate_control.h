// Meeting a target with the base size that does best there.
#ifndef LACERTA_DRACO_RATE_CONTROL_H_
#define LACERTA_DRACO_RATE_CONTROL_H_

#include <cstddef>
#include <functional>
#include <vector>

#include "draco/candidate_search.h"
#include "draco/refinable_surface.h"
#include "lacerta/codec.h"
#include "lacerta/surface_distance.h"

namespace lacerta {

// Fails with kInvalidArgument where the value is not finite or out of a range that makes sense. diagonal: of the input, > 0.
StatusOr<ResolvedTarget> ResolveTarget(const EncodeTarget& target, uint64_t num_input_vertices, double diagonal);

// The PSNR that is asked for, or where a stream of the rate that is asked for usually ends up, dB.
double TypicalPsnr(const ResolvedTarget& target, double num_input_vertices);

// Vertices of the base that streams of a PSNR have on typical surfaces.
double TypicalBase(double psnr);

struct ChosenStream {
  MeasuredStream measured;
  double remesh_psnr = 0;   // dB, of the unquantized remesh
  double normal_share = 0;  // NormalShare
};

// What an attempt at a target came to.
struct Outcome {
  bool meets_target = false;
  size_t bytes = 0;
  double psnr = 0;  // dB
};
template <typename Stream>
Outcome OutcomeOf(const Stream& measured) {
  return {measured.meets_target, measured.stream.size(), measured.psnr};
}

// What is asked for: the target met, then quality at a rate and bytes at a quality; where neither meets it, nearer to it.
bool IsBetter(const Outcome& a, const Outcome& b, const ResolvedTarget& target);

// A stream of another kind that may make one with levels needless. Called by one thread at a time.
struct RivalStream {
  // Whether it meets the PSNR in fewer than so many bytes; asked at a PSNR alone, as more becomes known, infinity where no base reaches the target.
  std::function<bool(double bytes)> takes_fewer_than;
  // Whether that is likely, by what was seen of it so far: then nothing else is begun before it is known.
  std::function<bool(double bytes)> may_take_fewer_than;
  // To be found now, if it may be better than one of about so many bytes: others wait for nothing else.
  std::function<void(double bytes)> prepare_beside;
};

// Codes the surface at the target: fewest bytes at a PSNR, highest PSNR at a number of bytes. Where no base size reaches the
// target the nearest stream is returned, and says so.
// progress: as in EncodeOptions, may be empty. rival: may be null; once it takes fewer bytes than streams with levels will at least, kUnsupported is
// returned.
StatusOr<ChosenStream> CodeAtTarget(const RefinableSurface& surface, const SurfaceDistanceMeter& meter, const ResolvedTarget& target, EncodeMode mode,
                                    const std::function<void(double, const char*)>& progress, const SearchEffort& effort = SearchEffort(),
                                    const RivalStream* rival = nullptr);

}  // namespace lacerta

#endif  // LACERTA_DRACO_RATE_CONTROL_H_
