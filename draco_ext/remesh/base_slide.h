// Base vertices slide along the input to where the levels over them have the least left to code.
#ifndef LACERTA_REMESH_BASE_SLIDE_H_
#define LACERTA_REMESH_BASE_SLIDE_H_

#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"
#include "remesh/base_domain.h"
#include "remesh/input_surface.h"

namespace lacerta {

// Moves vertices of a base mesh to other points of the input, and the domain and `positions` (#V, on the input) with them, but for those on curves and without triangles.
// domain: of `surface`, before Reorder. None goes farther than half the mean length of its edges, nor around a tip. enough_points: of the levels that are looked at, as of
// MidpointsOver; time is linear in them.
//
// What becomes smaller is the sum of CodingBits over the distances of midpoints from the input: level by level, predicted by the butterfly from the points
// of the input closest to the midpoints before, about as piercing would find them. Those of a level count twice as much as those of the one before, for what finer levels
// take goes with them. To it comes what the base itself takes, as much for what each corner is off the parallelogram of the triangle across.
// By Gauss-Newton steps, each by conjugate gradients. On all cores; the same on any number of them.
void SlideBase(const InputSurface& surface, BaseDomain* domain, std::vector<Vec3f>* positions, uint32_t enough_points);

}  // namespace lacerta

#endif  // LACERTA_REMESH_BASE_SLIDE_H_
