// A mesh of fewer triangles that stands for a large input where it is remeshed, fitted and simplified: those take time and memory with every
// triangle, and what a dense scan has beyond the error that is asked for is noise to them. Errors are measured to the input itself.
#ifndef LACERTA_DRACO_INPUT_PROXY_H_
#define LACERTA_DRACO_INPUT_PROXY_H_

#include <cstdint>
#include <optional>

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
};

// The input, simplified to as few triangles as the options allow, by powers of two; none where that does not halve them, nor where there are more
// components than half the triangles.
//   cleaned  what Clean returned of the input
//   meter    of the input
//   target   of the stream
//   whole    where not null: the collapses of `cleaned`, where no proxy was found among them
std::optional<TriangleMesh> InputProxy(const TriangleMesh& cleaned, const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                       const InputProxyOptions& options = {}, std::optional<SimplificationSequence>* whole = nullptr);

// What is remeshed and simplified: the input, or its proxy where there is one. What it refers to must outlive it.
class ProxiedInput {
 public:
  // As for InputProxy.
  ProxiedInput(const TriangleMesh& cleaned, const SurfaceDistanceMeter& meter, const ResolvedTarget& target)
      : cleaned_(cleaned), meter_(meter), target_(target) {}

  // Makes the proxy when first called. Not for several threads at a time.
  const TriangleMesh& Mesh() {
    if (!is_made_) proxy_ = InputProxy(cleaned_, meter_, target_, {}, &sequence_);
    is_made_ = true;
    return proxy_ ? *proxy_ : cleaned_;
  }
  // The collapses of that mesh, made once, too.
  const SimplificationSequence& Sequence() {
    const TriangleMesh& mesh = Mesh();
    if (!sequence_) sequence_.emplace(mesh);
    return *sequence_;
  }

 private:
  const TriangleMesh& cleaned_;
  const SurfaceDistanceMeter& meter_;
  const ResolvedTarget& target_;
  bool is_made_ = false;
  std::optional<TriangleMesh> proxy_;
  std::optional<SimplificationSequence> sequence_;
};

}  // namespace lacerta

#endif  // LACERTA_DRACO_INPUT_PROXY_H_
