#include "remesh/attributed_proxy.h"

#include <string>
#include <utility>

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

StatusOr<std::optional<AttributedMesh>> AttributedProxy(const AttributedMesh& original, const SurfaceErrorMeter& meter,
                                                        const ErrorTargets& targets, const AttributedProxyOptions& options) {
  constexpr uint64_t kSamples = 50'000;
  const size_t all = original.surface.triangles.size(), most_triangles = all / 2;
  if (options.fewest_triangles > most_triangles) return std::optional<AttributedMesh>();
  const ErrorTargets shares = SharesOf(targets, options);
  const AttributedSimplification sequence(original, WeightsOfTargets(original, meter, targets));
  double wanted = 0;  // triangles; errors go about as one over their number
  for (uint64_t n = options.fewest_triangles; n <= most_triangles; n *= 2) {
    AttributedMesh proxy = sequence.MeshWith(static_cast<uint32_t>(n));
    const size_t size = proxy.surface.triangles.size();
    if (size > most_triangles) return Unsupported("its seams leave " + std::to_string(size) + " of " + std::to_string(all) + " triangles");
    const StatusOr<SurfaceErrors> errors = meter.Measure(proxy, kSamples);
    if (!errors.ok()) continue;
    if (WorstRatio(errors.value(), shares) <= 1) return std::optional<AttributedMesh>(std::move(proxy));
    wanted = WorstRatio(errors.value(), targets) * static_cast<double>(size);
  }
  if (wanted >= static_cast<double>(all)) return Unsupported("it needs nearly all its triangles for the errors asked for");
  return std::optional<AttributedMesh>();
}

}  // namespace lacerta
