// Streams without refinement at a target: the mesh itself, or a simplified one, in stock Draco form.
#ifndef LACERTA_DRACO_ZERO_LEVEL_SEARCH_H_
#define LACERTA_DRACO_ZERO_LEVEL_SEARCH_H_

#include <optional>

#include "draco/rate_control.h"
#include "lacerta/mesh.h"
#include "lacerta/surface_distance.h"
#include "remesh/collapse_history.h"

namespace lacerta {

struct ZeroLevelStream {
  Bytes stream;
  TriangleMesh mesh;   // as decoded
  double distance = 0;  // d_S to the input, model units
  double psnr = 0;      // dB
  bool meets_target = false;
};

// The whole mesh with the fewest bits per coordinate that meet the target; where none does, the nearest. Any mesh that passed
// cleaning. Fails as EncodeZeroLevel does.
StatusOr<ZeroLevelStream> CodeZeroLevel(const TriangleMesh& mesh, const SurfaceDistanceMeter& meter, const ResolvedTarget& target);

// A zero-level stream of the mesh or of one of the simplified meshes of `history` that beats `coded`: it meets the target in
// fewer bytes, or comes nearer to it; none where there is no such stream.
StatusOr<std::optional<ZeroLevelStream>> SimplerIfBetter(const TriangleMesh& mesh, const CollapseHistory& history,
                                                         const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                                         const MeasuredStream& coded);

}  // namespace lacerta

#endif  // LACERTA_DRACO_ZERO_LEVEL_SEARCH_H_
