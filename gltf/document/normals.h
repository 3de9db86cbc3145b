// Normals that a reader can derive need not be stored.
#ifndef LACERTA_DOCUMENT_NORMALS_H_
#define LACERTA_DOCUMENT_NORMALS_H_

#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// Whether `normals` (#V) are those that SmoothNormals (decoder/smooth_normals.h) gives, but for one vertex in a hundred: within 20 degrees, which
// leaves room for other weights and for rounding, but not for creases.
bool NormalsAreDerivable(const TriangleMesh& mesh, const std::vector<Vec3f>& normals);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_NORMALS_H_
