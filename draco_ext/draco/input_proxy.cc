#include "draco/input_proxy.h"

#include <algorithm>

#include "draco/decoded_distance.h"
#include "draco/rate_control.h"
#include "remesh/components.h"
#include "remesh/error_floor.h"
#include "remesh/simplify_in_parts.h"

namespace lacerta {
namespace {

// Looks for the proxy from the fewest triangles on.
class ProxySearch {
 public:
  // allowed: the distance that the stream may have. What is referred to must outlive the search.
  ProxySearch(const SurfaceDistanceMeter& meter, double allowed, const InputProxyOptions& options)
      : meter_(meter), allowed_(allowed), share_(options.share), next_(options.fewest_triangles) {}

  // The first near enough of those of at most `most` triangles, from where the last call ended.
  std::optional<TriangleMesh> FirstNearEnough(const SimplificationSequence& sequence, size_t most) {
    constexpr uint64_t kSamples = 50'000;
    while (std::max<uint64_t>(next_, sequence.fewest_triangles()) <= most) {
      TriangleMesh proxy = sequence.MeshWith(static_cast<uint32_t>(next_));
      do next_ *= 2;
      while (next_ <= sequence.fewest_triangles());  // that would be the same mesh again
      const ErrorAtSize size{DecodedDistance(meter_, proxy, SurfaceDistanceOptions::RmsOnly(kSamples)), static_cast<double>(proxy.triangles.size())};
      const bool is_near = IsNearItsFloor(coarser_ ? *coarser_ : size, size, allowed_, share_);
      coarser_ = size;
      if (is_near) return proxy;
    }
    return std::nullopt;
  }

 private:
  const SurfaceDistanceMeter& meter_;
  const double allowed_, share_;
  uint64_t next_;  // size
  std::optional<ErrorAtSize> coarser_;
};

}  // namespace

std::optional<TriangleMesh> InputProxy(const TriangleMesh& cleaned, const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                       const InputProxyOptions& options, bool* is_coarse) {
  const size_t num_triangles = cleaned.triangles.size(), half = num_triangles / 2;
  const bool is_too_large = num_triangles > options.most_triangles;
  if (options.fewest_triangles > half && !is_too_large) return std::nullopt;
  const size_t most = is_too_large ? options.most_triangles : half;
  const size_t num_components = CountComponents(cleaned);
  if (num_components > most) return std::nullopt;  // each keeps a triangle
  const double psnr = TypicalPsnr(target, static_cast<double>(options.fewest_triangles) / 2);  // what bytes bring hardly depends on how dense the input is
  ProxySearch search(meter, DistanceOfPsnr(psnr, meter.diagonal()), options);
  const uint32_t most_at_once = std::min(options.most_at_once, options.most_as_a_whole);
  if (most_at_once <= half && most_at_once < options.most_as_a_whole && num_components < most_at_once) {
    const TriangleMesh reduced = SimplifyInParts(cleaned, most_at_once, options.part_triangles);
    std::optional<TriangleMesh> proxy = search.FirstNearEnough(SimplificationSequence(reduced), std::min(reduced.triangles.size(), most));
    if (proxy) return proxy;
  }
  // All of it, or as much as memory allows.
  TriangleMesh reduced;
  const bool is_reduced = num_triangles > options.most_as_a_whole;
  if (is_reduced) reduced = SimplifyInParts(cleaned, options.most_as_a_whole, options.part_triangles);
  const SimplificationSequence sequence(is_reduced ? reduced : cleaned);
  reduced = {};
  std::optional<TriangleMesh> proxy = search.FirstNearEnough(sequence, std::min<size_t>(sequence.num_input_triangles(), most));
  if (proxy) return proxy;
  if (!is_too_large) return std::nullopt;
  if (is_coarse != nullptr) *is_coarse = true;
  return sequence.MeshWith(options.most_triangles);
}

}  // namespace lacerta
