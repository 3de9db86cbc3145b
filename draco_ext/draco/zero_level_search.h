// Streams without refinement at a target: the mesh itself or a simplified one, fitted to it.
#ifndef LACERTA_DRACO_ZERO_LEVEL_SEARCH_H_
#define LACERTA_DRACO_ZERO_LEVEL_SEARCH_H_

#include <optional>

#include "draco/rate_control.h"
#include "draco/zero_level.h"
#include "lacerta/mesh.h"
#include "lacerta/surface_distance.h"
#include "remesh/simplify.h"

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

// The best zero-level stream found: fewest bytes at a PSNR, highest PSNR at a number of bytes, over numbers of triangles and steps
// of the lattice; where nothing meets the target, the nearest. mesh: any that passed cleaning. Fails as EncodeZeroLevel does.
StatusOr<ZeroLevelStream> CodeZeroLevel(const TriangleMesh& mesh, const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                        const SearchEffort& effort = SearchEffort());

// The same where it clearly beats `coded`, which has levels to show for its bytes: it meets the target in 5 % fewer of them, or with a
// PSNR 0.3 dB higher in as many, or comes nearer to it. None where it does not, which is often seen early. sequence: of
// `mesh`.
StatusOr<std::optional<ZeroLevelStream>> SimplerIfBetter(const TriangleMesh& mesh, const SimplificationSequence& sequence,
                                                         const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                                         const MeasuredStream& coded, const SearchEffort& effort = SearchEffort());

}  // namespace lacerta

#endif  // LACERTA_DRACO_ZERO_LEVEL_SEARCH_H_
