#include "remesh/agreeing_faces.h"

#include <algorithm>
#include <utility>

#include "geometry/vertex_area_vectors.h"
#include "remesh/wedge_mesh.h"

namespace lacerta {

std::optional<AgreeingSurface> TurnToAgree(const AttributedMesh& mesh) {
  const WedgeMesh wedges = MakeWedgeMesh(mesh);
  if (std::find(wedges.flipped.begin(), wedges.flipped.end(), 1) == wedges.flipped.end()) return std::nullopt;
  AgreeingSurface result{mesh, 0};
  double area = 0;
  for (size_t i = 0; i < wedges.flipped.size(); ++i) {
    const uint32_t f = wedges.source_face[i];
    Triangle& t = result.mesh.surface.triangles[f];
    const double own = Norm(AreaVector(mesh.surface.positions, t));
    area += own;
    if (wedges.flipped[i] == 0) continue;
    result.turned_share += own;
    std::swap(t[1], t[2]);
    for (MeshAttribute& attribute : result.mesh.attributes) std::swap(attribute.corners[f][1], attribute.corners[f][2]);
  }
  result.turned_share = area > 0 ? result.turned_share / area : 0;
  return result;
}

}  // namespace lacerta
