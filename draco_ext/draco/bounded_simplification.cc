#include "draco/bounded_simplification.h"

#include <memory>

#include "remesh/deviation_samples.h"

namespace lacerta {

SimplificationSequence BoundedSimplification(const TriangleMesh& mesh, const SurfaceDistanceMeter& meter, const ResolvedTarget& target) {
  SimplificationOptions options;
  if (!target.is_rate) {
    const double farthest = kFarthestOverMean * DistanceOfPsnr(target.psnr, meter.diagonal());
    options.original = std::make_shared<const DeviationSamples>(mesh, farthest);
  }
  return SimplificationSequence(mesh, options);
}

}  // namespace lacerta
