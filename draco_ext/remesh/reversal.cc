#include "remesh/reversal.h"

#include <algorithm>
#include <vector>

namespace lacerta {

bool IsReversed(const InputSurface& surface, const std::array<Vec3f, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vec3f normal = AreaNormal(corners), centroid = (a + b + c) * (1.0f / 3);
  const auto agrees = [&](const SurfacePoint& p) {
    const Vec3d weights{p.barycentric[0], p.barycentric[1], p.barycentric[2]};
    return p.face == SurfacePoint::kNone || Dot(normal, surface.NormalAt(p.face, weights)) >= 0;
  };
  if (agrees(surface.tree().ClosestPoint(centroid).point)) return false;
  const float reach = std::max({Norm(b - a), Norm(c - b), Norm(a - c)});
  std::vector<LineHit> hits;
  surface.tree().IntersectLine(centroid, Normalized(normal), -reach, reach, &hits);
  return std::none_of(hits.begin(), hits.end(), [&](const LineHit& hit) { return agrees(hit.point); });
}

}  // namespace lacerta
