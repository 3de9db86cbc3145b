// Normals that a reader can derive need not be stored.
#ifndef LACERTA_DOCUMENT_NORMALS_H_
#define LACERTA_DOCUMENT_NORMALS_H_

#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// One unit normal per vertex, the mean of the normals around it weighted by their corner angles [Thuermer & Wuethrich
// 1998]. Vertices at exactly the same position share theirs. A vertex of no proper triangle gets (0, 0, 1).
std::vector<Vec3f> DeriveNormals(const TriangleMesh& mesh);

// Whether `normals` (#V) are those that DeriveNormals gives, but for one vertex in a hundred: within 20 degrees, which
// leaves room for other weights and for rounding, but not for creases.
bool NormalsAreDerivable(const TriangleMesh& mesh, const std::vector<Vec3f>& normals);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_NORMALS_H_
