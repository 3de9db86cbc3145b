#include "remesh/attributed_proxy.h"

#include "remesh/attributed_simplify.h"
#include "remesh/simplify_to_errors.h"

namespace lacerta {
namespace {

ErrorTargets SharesOf(const ErrorTargets& targets, const AttributedProxyOptions& options) {
  ErrorTargets shares;
  shares.distance = options.share * targets.distance;
  shares.turned = options.attribute_share * targets.turned;
  for (const double target : targets.attributes) shares.attributes.push_back(options.attribute_share * target);
  return shares;
}

}  // namespace

std::optional<AttributedMesh> AttributedProxy(const AttributedMesh& original, const SurfaceErrorMeter& meter, const ErrorTargets& targets,
                                              const AttributedProxyOptions& options) {
  constexpr uint64_t kSamples = 50'000;
  const size_t most_triangles = original.surface.triangles.size() / 2;
  if (options.fewest_triangles > most_triangles) return std::nullopt;
  const ErrorTargets shares = SharesOf(targets, options);
  const AttributedSimplification sequence(original, WeightsOfTargets(original, meter, targets));
  for (uint64_t n = options.fewest_triangles; n <= most_triangles; n *= 2) {
    AttributedMesh proxy = sequence.MeshWith(static_cast<uint32_t>(n));
    if (proxy.surface.triangles.size() > most_triangles) break;  // its seams leave no fewer
    const StatusOr<SurfaceErrors> errors = meter.Measure(proxy, kSamples);
    if (errors.ok() && WorstRatio(errors.value(), shares) <= 1) return proxy;
  }
  return std::nullopt;
}

}  // namespace lacerta
