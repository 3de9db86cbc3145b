#include "draco/bounded_simplification.h"

#include <memory>
#include <vector>

#include "remesh/deviation_samples.h"

namespace lacerta {

SimplificationSequence BoundedSimplification(const TriangleMesh& mesh, const SurfaceDistanceMeter& meter, const ResolvedTarget& target) {
  SimplificationOptions options;
  if (!target.is_rate) {
    std::vector<Vec3d> positions;
    positions.reserve(mesh.positions.size());
    for (const Vec3f& p : mesh.positions) positions.push_back(Vec3Cast<double>(p));
    const double farthest = kFarthestOverMean * DistanceOfPsnr(target.psnr, meter.diagonal());
    options.original = std::make_shared<const DeviationSamples>(positions, mesh.triangles, std::vector<uint32_t>(), farthest);
  }
  return SimplificationSequence(mesh, options);
}

}  // namespace lacerta
