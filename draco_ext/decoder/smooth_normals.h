// Normals for a level that is shown: the stream has none where the surface itself tells them.
#ifndef LACERTA_DECODER_SMOOTH_NORMALS_H_
#define LACERTA_DECODER_SMOOTH_NORMALS_H_

#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// One unit normal per position: the normals of the triangles around it weighted by their angles there [Thuermer, Wuethrich 1998]. Vertices at
// the same position share theirs, so that no shading edge opens where a surface was cut. (0, 0, 1) where no triangle has an area. The same
// bits on every machine: no function of the mathematics library but square roots. Triangle indices must be below #V. O(#V + #F).
std::vector<Vec3f> SmoothNormals(Span<const Vec3f> positions, Span<const Triangle> triangles);

}  // namespace lacerta

#endif  // LACERTA_DECODER_SMOOTH_NORMALS_H_
