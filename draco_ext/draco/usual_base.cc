#include "draco/usual_base.h"

#include "draco/decoded_distance.h"
#include "remesh/base_domain.h"
#include "remesh/base_parts.h"

namespace lacerta {

double UsualBasePsnr(double psnr) { return 43.5 + 0.5 * (psnr - 70); }

double BasePsnr(const RefinableSurface& surface, uint32_t num_vertices, const SurfaceDistanceMeter& meter) {
  constexpr uint64_t kFewSamples = 5'000;
  const BaseDomain domain(surface.history, surface.history.CollapsesTo(num_vertices));
  const TriangleMesh base = Together({domain.PositionsOn(surface.surface.mesh()), domain.triangles()}, surface.still);
  return DecodedPsnr(meter, base, kFewSamples);
}

}  // namespace lacerta
