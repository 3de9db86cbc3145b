#include "geometry/facing.h"

#include <algorithm>

#include "geometry/vertex_area_vectors.h"

namespace lacerta {

const MeshAttribute* FindNormals(const AttributedMesh& mesh) {
  const auto found = std::find_if(mesh.attributes.begin(), mesh.attributes.end(),
                                  [](const MeshAttribute& a) { return a.kind == AttributeKind::kNormal && a.components == 3; });
  return found == mesh.attributes.end() ? nullptr : &*found;
}

Vec3d FacingOf(const MeshAttribute& normals, uint32_t face) {
  Vec3d sum;
  for (const uint32_t row : normals.corners[face]) {
    if (row == MeshAttribute::kNoValue) return {};
    const float* value = &normals.values[3 * size_t{row}];
    sum += Vec3Cast<double>(Vec3f{value[0], value[1], value[2]});
  }
  return sum;
}

double ShareAgainstNormals(const AttributedMesh& mesh) {
  const MeshAttribute* normals = FindNormals(mesh);
  if (normals == nullptr) return 0;
  double all = 0, against = 0;
  for (uint32_t f = 0; f < mesh.surface.triangles.size(); ++f) {
    const Vec3d normal = AreaVector(mesh.surface.positions, mesh.surface.triangles[f]);
    const double area = Norm(normal);
    all += area;
    if (Dot(normal, FacingOf(*normals, f)) < 0) against += area;
  }
  return all > 0 ? against / all : 0;
}

}  // namespace lacerta
