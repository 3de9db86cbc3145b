// Triangles of a remesh that look away from the input.
#ifndef LACERTA_REMESH_REVERSAL_H_
#define LACERTA_REMESH_REVERSAL_H_

#include <array>

#include "lacerta/vec3.h"
#include "remesh/input_surface.h"

namespace lacerta {

// Twice the area of a triangle, along its normal.
inline Vec3f AreaNormal(const std::array<Vec3f, 3>& corners) { return Cross(corners[1] - corners[0], corners[2] - corners[0]); }

// Whether a triangle is more than 90 degrees off the input's interpolated normal at the point closest to its centroid, and off that
// of every sheet which the line along its normal through the centroid meets no farther away than the triangle is long: at thin parts the
// closest point is often on the far side. False where there is no input.
bool IsReversed(const InputSurface& surface, const std::array<Vec3f, 3>& corners);

}  // namespace lacerta

#endif  // LACERTA_REMESH_REVERSAL_H_
