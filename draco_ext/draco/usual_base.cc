#include "draco/usual_base.h"

#include <algorithm>

#include "draco/decoded_distance.h"
#include "remesh/base_domain.h"
#include "remesh/base_parts.h"

namespace lacerta {

double UsualBasePsnr(double psnr) { return 42.5 + 0.4 * (psnr - 70); }

double BasePsnr(const RefinableSurface& surface, uint32_t num_vertices, const SurfaceDistanceMeter& meter) {
  constexpr uint64_t kFewSamples = 5'000;
  const TriangleMesh& input = surface.surface.mesh();
  const auto num_input = static_cast<uint32_t>(input.positions.size());
  const BaseDomain domain(surface.history, std::min(surface.history.num_collapses(), num_input - std::min(num_input, num_vertices)));
  const TriangleMesh base = Together({domain.PositionsOn(input), domain.triangles()}, surface.still);
  return Psnr(DecodedDistance(meter, base, SurfaceDistanceOptions::RmsOnly(kFewSamples)), meter.diagonal());
}

}  // namespace lacerta
