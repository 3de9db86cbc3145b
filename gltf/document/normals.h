// Normals that a reader can derive need not be stored.
#ifndef LACERTA_DOCUMENT_NORMALS_H_
#define LACERTA_DOCUMENT_NORMALS_H_

#include <cstdint>
#include <functional>
#include <vector>

#include "lacerta/attributed_mesh.h"
#include "lacerta/mesh.h"

namespace lacerta {

// Whether `normals` (#V) are those that SmoothNormals (decoder/smooth_normals.h) gives, but for one vertex in a hundred: within 20 degrees, which
// leaves room for other weights and for rounding, but not for creases.
bool NormalsAreDerivable(const TriangleMesh& mesh, const std::vector<Vec3f>& normals);

// Whether every face has one normal at its three corners and, but for one face in a hundred (slivers), its own within 2 degrees: what glTF 2.0 shades a
// surface without normals by ("flat normals", 3.7.2.1).
//   triangles    of the surface, #F; position_at: of its vertices
//   corners      #F rows of normals; MeshAttribute::kNoValue x 3 for a face without; normal_at: of rows
bool NormalsAreFlat(const std::vector<Triangle>& triangles, const std::function<Vec3f(uint32_t)>& position_at, const std::vector<Triangle>& corners,
                    const std::function<Vec3f(uint32_t)>& normal_at);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_NORMALS_H_
