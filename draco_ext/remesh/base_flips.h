// Edges of a base mesh turn where the levels over it have less left to code then.
#ifndef LACERTA_REMESH_BASE_FLIPS_H_
#define LACERTA_REMESH_BASE_FLIPS_H_

#include <cstddef>
#include <vector>

#include "lacerta/mesh.h"
#include "remesh/base_domain.h"
#include "remesh/input_surface.h"

namespace lacerta {

// Turns edges of a base mesh, and the domain with them, where that makes the sum of SlideBase smaller, of the first level alone and with all vertices where they are, and vertices nearer to a valence of six. Of
// edges that change what is predicted over the same faces that one turns which gains most. Edges on curves stay, and those where midpoints lie on another sheet of the input or a new triangle would lie across a
// fold. domain: of `surface`, before Reorder; positions: #V, where the vertices are on the input. Returns how many turned. On all cores; the same on any number of them.
size_t FlipBaseEdges(const InputSurface& surface, BaseDomain* domain, const std::vector<Vec3f>& positions);

}  // namespace lacerta

#endif  // LACERTA_REMESH_BASE_FLIPS_H_
