// Triangles that look the other way than their neighbors: scans that were merged have a few.
#ifndef LACERTA_REMESH_AGREEING_FACES_H_
#define LACERTA_REMESH_AGREEING_FACES_H_

#include <optional>

#include "lacerta/attributed_mesh.h"

namespace lacerta {

struct AgreeingSurface {
  AttributedMesh mesh;
  double turned_share = 0;  // of the area, 0 .. 1
};

// The surface with those triangles turned over, the minority of each component; none where all agree. Vertices, values and the order of triangles
// stay. mesh: one that CheckAttributedMesh accepts. O(n log n).
std::optional<AgreeingSurface> TurnToAgree(const AttributedMesh& mesh);

}  // namespace lacerta

#endif  // LACERTA_REMESH_AGREEING_FACES_H_
