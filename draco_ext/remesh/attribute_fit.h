// Values of attributes that are closest to those of the original over the surface, not only at its vertices.
#ifndef LACERTA_REMESH_ATTRIBUTE_FIT_H_
#define LACERTA_REMESH_ATTRIBUTE_FIT_H_

#include <cstddef>

#include "geometry/group_surface.h"
#include "lacerta/attributed_mesh.h"

namespace lacerta {

struct AttributeFitOptions {
  size_t num_samples = 20'000;  // points of the mesh that are compared, and at least three on every triangle
  double seam_distance = 1e-3;  // within which seams are looked across, relative to `diagonal`
  double diagonal = 1;          // model units
};

// Sets the attribute values of *mesh, which has the attributes and groups of `original`, to the least squares of the difference to the
// original at its closest points, on whichever side of a seam is nearer to the value that is there now; points far off count little.
// Which corners share a value at a vertex stays; where a texture triangle would be mirrored its values stay, too, and so do
// weights and generic values that are 0, since only others are stored.
void FitAttributes(const GroupSurface& original, const AttributeFitOptions& options, AttributedMesh* mesh);

}  // namespace lacerta

#endif  // LACERTA_REMESH_ATTRIBUTE_FIT_H_
