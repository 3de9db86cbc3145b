// A mesh of fewer triangles that stands for a large input where it is remeshed, fitted and simplified: those take time and memory with every
// triangle, and what a dense scan has beyond the error that is asked for is noise to them. Errors are measured to the input itself.
#ifndef LACERTA_DRACO_INPUT_PROXY_H_
#define LACERTA_DRACO_INPUT_PROXY_H_

#include <cstdint>
#include <limits>
#include <optional>

#include "draco/bounded_simplification.h"
#include "draco/candidate_search.h"
#include "lacerta/mesh.h"
#include "lacerta/surface_distance.h"
#include "remesh/simplify.h"

namespace lacerta {

struct InputProxyOptions {
  uint32_t fewest_triangles = 200'000;
  // Inputs of at least twice that are simplified to so many part by part first (simplify_in_parts.h), which keeps memory per triangle low, and
  // anew as a whole only where that is not near enough.
  uint32_t most_at_once = 1'000'000;
  uint32_t part_triangles = 125'000;
  // What more triangles would take away from its distance, over what noise that simplification smooths away (error_floor.h) leaves of the
  // distance that the stream may have, at most.
  double share = 0.15;
  // Where memory is short: no more than these are simplified as a whole, and no more than these are handed on: so many stand for the input where it
  // has more and no fewer are near enough. The first are at least as many as the second.
  uint32_t most_as_a_whole = std::numeric_limits<uint32_t>::max(), most_triangles = std::numeric_limits<uint32_t>::max();
};

// The input, simplified to as few triangles as the options allow, by powers of two; none where that does not halve them, unless
// there are more than most_triangles, nor where there are more components than it may have triangles.
//   cleaned    what Clean returned of the input
//   meter      of the input
//   target     of the stream
//   is_coarse  may be null; whether it is farther from the input than the options allow, for want of triangles
std::optional<TriangleMesh> InputProxy(const TriangleMesh& cleaned, const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                       const InputProxyOptions& options = {}, bool* is_coarse = nullptr);

// What is remeshed and simplified: the input, or its proxy where there is one. What it refers to must outlive it.
class ProxiedInput {
 public:
  // As for InputProxy.
  ProxiedInput(const TriangleMesh& cleaned, const SurfaceDistanceMeter& meter, const ResolvedTarget& target, const InputProxyOptions& options = {})
      : cleaned_(cleaned), meter_(meter), target_(target), options_(options) {}

  // Makes the proxy when first called. Not for several threads at a time.
  const TriangleMesh& Mesh() {
    if (!is_made_) proxy_ = InputProxy(cleaned_, meter_, target_, options_, &is_coarse_);
    is_made_ = true;
    return proxy_ ? *proxy_ : cleaned_;
  }
  // The BoundedSimplification of that mesh, made once, too.
  const SimplificationSequence& Sequence() {
    if (!sequence_) sequence_ = BoundedSimplification(Mesh(), meter_, target_);
    return *sequence_;
  }

  // Of the proxy, once it was made: as for InputProxy.
  bool is_coarse() const { return is_coarse_; }

 private:
  const TriangleMesh& cleaned_;
  const SurfaceDistanceMeter& meter_;
  const ResolvedTarget& target_;
  const InputProxyOptions options_;
  bool is_made_ = false, is_coarse_ = false;
  std::optional<TriangleMesh> proxy_;
  std::optional<SimplificationSequence> sequence_;
};

}  // namespace lacerta

#endif  // LACERTA_DRACO_INPUT_PROXY_H_
