#include "remesh/attributed_still.h"

#include <algorithm>
#include <utility>

#include "geometry/equal_rows.h"
#include "remesh/wedge_mesh.h"

namespace lacerta {
namespace {

// Whether a vertex of one stands where one of the other does.
bool Touch(const TriangleMesh& a, const TriangleMesh& b) {
  std::vector<float> table;
  for (const TriangleMesh* mesh : {&a, &b}) {
    for (const Vec3f& p : mesh->positions) table.insert(table.end(), {p.x, p.y, p.z});
  }
  const std::vector<uint32_t> first = FirstEqualRow(Span<const float>(table), 3);
  return std::any_of(first.begin() + static_cast<std::ptrdiff_t>(a.positions.size()), first.end(),
                     [&](uint32_t row) { return row < a.positions.size(); });
}

bool HasArea(const TriangleMesh& mesh) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    const auto& p = mesh.positions;
    return SquaredNorm(Cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]])) > 0;
  });
}

}  // namespace

Status SimplifyStill(const ErrorTargets& targets, double texture_size, AttributedParts* parts) {
  AttributedMesh& still = parts->still;
  if (!HasArea(still.surface) || Touch(parts->refined.surface, still.surface)) return Status();
  LACERTA_ASSIGN_OR_RETURN(const SurfaceErrorMeter meter, SurfaceErrorMeter::Create(still, texture_size));
  LACERTA_ASSIGN_OR_RETURN(SimplifiedSurface simplified, SimplifyToErrors(still, meter, targets));
  if (simplified.mesh.surface.triangles.size() >= still.surface.triangles.size()) return Status();
  // The simplified surface is welded; what comes apart at single points or edges is cut again.
  const WedgeMesh wedges = MakeWedgeMesh(simplified.mesh);
  if (std::find(wedges.flipped.begin(), wedges.flipped.end(), 1) != wedges.flipped.end()) return Status();
  still = TakeFaces(simplified.mesh, wedges);
  return Status();
}

}  // namespace lacerta
