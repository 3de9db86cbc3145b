// Seams that nobody sees: the values on both sides differ by the noise of some tool's arithmetic.
#ifndef LACERTA_GEOMETRY_CLOSE_SEAMS_H_
#define LACERTA_GEOMETRY_CLOSE_SEAMS_H_

#include <vector>

#include "lacerta/attributed_mesh.h"

namespace lacerta {

// Gives the corners of each vertex one value of an attribute where theirs are within its tolerance of the first of them (in the
// order of the triangles), so no value moves farther than that. Positions and triangles stay. tolerances: of every attribute, in the
// units of AttributeError with textures of `texture_size`; 0 closes nothing. mesh: one that CheckAttributedMesh accepts. O(n log n).
void CloseSeams(const std::vector<double>& tolerances, double texture_size, AttributedMesh* mesh);

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_CLOSE_SEAMS_H_
