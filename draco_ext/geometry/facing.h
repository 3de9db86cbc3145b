// Triangles beside the normals that are stored for them: where the two disagree, a viewer that draws front faces alone shows a hole, and
// any other one shades it from the wrong side.
#ifndef LACERTA_GEOMETRY_FACING_H_
#define LACERTA_GEOMETRY_FACING_H_

#include <cstdint>

#include "lacerta/attributed_mesh.h"
#include "lacerta/vec3.h"

namespace lacerta {

// The attribute of kind kNormal with three components; null where there is none.
const MeshAttribute* FindNormals(const AttributedMesh& mesh);

// The sum of the normals at the corners of a face; zero where it has none.
Vec3d FacingOf(const MeshAttribute& normals, uint32_t face);

// Share of the area of a mesh in triangles that look away from FacingOf, 0 to 1. 0 without normals or area.
double ShareAgainstNormals(const AttributedMesh& mesh);

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_FACING_H_
