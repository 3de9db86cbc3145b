#include "remesh/piercing.h"

#include <algorithm>

#include "remesh/growing_normal_mesh.h"

namespace lacerta {

NormalMesh Pierce(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& base_positions,
                  const PiercingOptions& options, std::vector<DomainPoint>* parameters) {
  GrowingNormalMesh growing(surface, domain, base_positions, options);
  while (growing.num_levels() < options.num_levels) growing.AddLevel();
  if (parameters != nullptr) *parameters = growing.Parameters();
  return growing.mesh();
}

double NormalShare(const NormalMesh& mesh) {
  const auto count = [&](PiercingKind kind) {
    return static_cast<double>(std::count(mesh.piercing.begin(), mesh.piercing.end(), kind));
  };
  const double off_curves = static_cast<double>(mesh.piercing.size()) - count(PiercingKind::kCurve);
  return off_curves > 0 ? count(PiercingKind::kNormal) / off_curves : 1.0;
}

}  // namespace lacerta
