// A surface simplified in several ways.
//
// Long triangles follow creases and necks, round ones suit the butterfly: over which of them details take fewer bits differs from surface to
// surface by up to a tenth, and no geometric measure of the base was found that tells. Streams do (docs/decisions/0013-base-shape.md).
#ifndef LACERTA_DRACO_SIMPLIFICATIONS_H_
#define LACERTA_DRACO_SIMPLIFICATIONS_H_

#include <cstddef>
#include <vector>

#include "common/subdivision.h"
#include "remesh/collapse_history.h"
#include "remesh/input_surface.h"

namespace lacerta {

// The first `count` ways, at least one and at most kMostSimplifications, that which is best on the whole first.
// topology: of surface.mesh(), with its curves.
inline constexpr size_t kMostSimplifications = 2;
std::vector<CollapseHistory> Simplifications(const InputSurface& surface, const Topology& topology, size_t count);

}  // namespace lacerta

#endif  // LACERTA_DRACO_SIMPLIFICATIONS_H_
