// How far attributes move when their values are rounded, measured on the surface that carries them.
#ifndef LACERTA_PACK_ATTRIBUTE_ERROR_H_
#define LACERTA_PACK_ATTRIBUTE_ERROR_H_

#include "document/accessor.h"
#include "document/primitive.h"
#include "lacerta/mesh.h"

namespace lacerta {

// Root mean square over the surface of the difference between two versions of an attribute (#V elements of equal type,
// in its unit; over several components the Euclidean norm). The difference is linear on every triangle, so the integral
// is exact: no samples. Where the surface has no area, the mean over its corners.
double SurfaceRms(const TriangleMesh& surface, const AccessorData& before, const AccessorData& after);

// The same for directions, in degrees: of the first three components, at unit length. Zero vectors do not count.
double DirectionRms(const TriangleMesh& surface, const AccessorData& before, const AccessorData& after);

// Share of the area of `surface` in triangles that look to the other side once the vertices are at `moved` (#V).
double FlippedShare(const TriangleMesh& surface, const std::vector<Vec3f>& moved);

}  // namespace lacerta

#endif  // LACERTA_PACK_ATTRIBUTE_ERROR_H_
