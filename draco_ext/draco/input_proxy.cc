#include "draco/input_proxy.h"

#include "draco/decoded_distance.h"
#include "draco/rate_control.h"
#include "remesh/error_floor.h"
#include "remesh/simplify.h"

namespace lacerta {

std::optional<TriangleMesh> InputProxy(const TriangleMesh& cleaned, const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                       const InputProxyOptions& options) {
  constexpr uint64_t kSamples = 50'000;
  const size_t most_triangles = cleaned.triangles.size() / 2;
  if (options.fewest_triangles > most_triangles) return std::nullopt;
  const double psnr = TypicalPsnr(target, static_cast<double>(options.fewest_triangles) / 2);  // what bytes bring hardly depends on how dense the input is
  const double allowed = DistanceOfPsnr(psnr, meter.diagonal());
  const SimplificationSequence sequence(cleaned);
  std::optional<ErrorAtSize> coarser;
  for (uint64_t n = options.fewest_triangles; n <= most_triangles; n *= 2) {
    TriangleMesh proxy = sequence.MeshWith(static_cast<uint32_t>(n));
    const ErrorAtSize size{DecodedDistance(meter, proxy, SurfaceDistanceOptions::RmsOnly(kSamples)), static_cast<double>(proxy.triangles.size())};
    if (IsNearItsFloor(coarser ? *coarser : size, size, allowed, options.share)) return proxy;
    coarser = size;
  }
  return std::nullopt;
}

}  // namespace lacerta
