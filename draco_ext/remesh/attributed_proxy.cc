#include "remesh/attributed_proxy.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "remesh/attributed_simplify.h"
#include "remesh/error_floor.h"
#include "remesh/simplify_in_parts.h"
#include "remesh/simplify_to_errors.h"

namespace lacerta {
namespace {

constexpr uint64_t kSamples = 50'000;

struct MeasuredSize {
  SurfaceErrors errors;
  double triangles = 0;
};

// Whether every error is near its floor, which two sizes tell; of one alone, which is `coarser` and `finer` then, whether it is small itself.
bool IsNearEnough(const MeasuredSize& coarser, const MeasuredSize& finer, const ErrorTargets& targets, const AttributedProxyOptions& options) {
  const auto is_near = [&](double coarse, double fine, double allowed, double share) {
    return IsNearItsFloor({coarse, coarser.triangles}, {fine, finer.triangles}, allowed, share);
  };
  if (!is_near(coarser.errors.distance, finer.errors.distance, targets.distance, options.share)) return false;
  if (!is_near(coarser.errors.MostTurned(), finer.errors.MostTurned(), targets.turned, options.attribute_share)) return false;
  for (size_t a = 0; a < targets.attributes.size(); ++a) {
    const double coarse = coarser.errors.attributes[a].rms_99, fine = finer.errors.attributes[a].rms_99;
    if (!is_near(coarse, fine, targets.attributes[a], options.attribute_share)) return false;
  }
  return true;
}

// Looks for the proxy from the fewest triangles on.
class ProxySearch {
 public:
  // What it refers to must outlive it.
  ProxySearch(const SurfaceErrorMeter& meter, const ErrorTargets& targets, const AttributedProxyOptions& options)
      : meter_(meter), targets_(targets), options_(options), next_(options.fewest_triangles) {}

  // The first near enough of those of at most `most` triangles, from where the last call ended; none of them: nothing. Fails where seams keep
  // more.
  StatusOr<std::optional<AttributedMesh>> FirstNearEnough(const AttributedSimplification& sequence, size_t most) {
    for (; next_ <= most; next_ *= 2) {
      AttributedMesh proxy = sequence.MeshWith(static_cast<uint32_t>(next_));
      const size_t size = proxy.surface.triangles.size();
      if (size > most) return Unsupported("its seams leave " + std::to_string(size) + " triangles");
      StatusOr<SurfaceErrors> errors = meter_.Measure(proxy, kSamples);
      if (!errors.ok()) continue;
      const MeasuredSize measured{std::move(errors).value(), static_cast<double>(size)};
      const bool is_near = IsNearEnough(finest_ ? *finest_ : measured, measured, targets_, options_);
      finest_ = measured;
      if (is_near) return std::optional<AttributedMesh>(std::move(proxy));
    }
    return std::optional<AttributedMesh>();
  }

  // Triangles that the finest one tells to be wanted: errors go about as one over their number.
  double Wanted() const { return finest_ ? WorstRatio(finest_->errors, targets_) * finest_->triangles : 0; }

 private:
  const SurfaceErrorMeter& meter_;
  const ErrorTargets& targets_;
  const AttributedProxyOptions& options_;
  uint64_t next_;                       // size
  std::optional<MeasuredSize> finest_;  // of those that were measured
};

// Whether what is made of the proxy has room left beside its errors.
bool WillDo(const SurfaceErrors& errors, const ErrorTargets& targets) {
  constexpr double kMostOfTargets = 0.9;
  return WorstRatio(errors, targets) <= kMostOfTargets;
}

}  // namespace

StatusOr<std::optional<AttributedMesh>> AttributedProxy(const AttributedMesh& original, const SurfaceErrorMeter& meter,
                                                        const ErrorTargets& targets, const AttributedProxyOptions& options) {
  const size_t all = original.surface.triangles.size(), most_triangles = all / 2;
  if (options.fewest_triangles > most_triangles) return std::optional<AttributedMesh>();
  const std::vector<double> weights = WeightsOfTargets(original, meter, targets);
  ProxySearch search(meter, targets, options);
  for (const uint32_t at_once : {options.first_at_once, options.most_at_once}) {
    if (at_once > options.most_at_once || at_once > most_triangles) continue;
    AttributedMesh reduced = SimplifyInParts(original, weights, at_once, options.part_triangles);
    const size_t size = reduced.surface.triangles.size();
    StatusOr<std::optional<AttributedMesh>> proxy = search.FirstNearEnough(AttributedSimplification(reduced, weights), std::min(size, most_triangles));
    if (!proxy.ok() || proxy.value().has_value()) return proxy;
    if (at_once < options.most_at_once) continue;
    const StatusOr<SurfaceErrors> errors = meter.Measure(reduced, kSamples);
    if (size <= most_triangles && errors.ok() && WillDo(errors.value(), targets)) return std::optional<AttributedMesh>(std::move(reduced));
    return Unsupported("it needs more than " + std::to_string(size) + " triangles for the errors asked for");
  }
  StatusOr<std::optional<AttributedMesh>> proxy = search.FirstNearEnough(AttributedSimplification(original, weights), most_triangles);
  if (!proxy.ok() || proxy.value().has_value()) return proxy;
  if (search.Wanted() >= static_cast<double>(all)) return Unsupported("it needs nearly all its triangles for the errors asked for");
  return std::optional<AttributedMesh>();
}

}  // namespace lacerta
