// Edges of a simplified mesh turned to the other diagonal of their two triangles where that is worth it.
#ifndef LACERTA_REMESH_EDGE_FLIPS_H_
#define LACERTA_REMESH_EDGE_FLIPS_H_

#include <cstddef>

#include "lacerta/mesh.h"
#include "remesh/distance_model.h"
#include "remesh/mesh_fit.h"

namespace lacerta {

// Turns edges ("edge swap" [Hoppe et al. 1993, section 4.2]) where that lowers the distance to the input, or the bits of `rate` and of the connectivity for little
// of it; vertices stay where they are. In a few passes, each of those that gain most and share no triangle. Edges of more or fewer than two triangles, or of two that
// are oriented against each other, stay, and so do those whose new triangles would look away from the old ones or whose new ends have an edge in common.
// mesh: no triangle with a repeated vertex. Returns how many were turned. Runs on all cores; the same on any number of them.
size_t FlipEdges(const FitTarget& target, const RateModel& rate, TriangleMesh* mesh);

}  // namespace lacerta

#endif  // LACERTA_REMESH_EDGE_FLIPS_H_
