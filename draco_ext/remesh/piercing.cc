#include "remesh/piercing.h"

#include <algorithm>

#include "remesh/level_piercer.h"

namespace lacerta {

NormalMesh Pierce(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& base_positions,
                  const PiercingOptions& options, std::vector<DomainPoint>* parameters) {
  NormalMesh result;
  result.mesh.base_triangles = domain.triangles();
  result.mesh.num_base_vertices = domain.num_vertices();
  result.mesh.num_levels = options.num_levels;
  result.mesh.tags = domain.tags();
  std::vector<Vec3f>& positions = result.mesh.positions;
  positions = base_positions;

  std::vector<Site> sites(domain.num_vertices());
  for (uint32_t f = 0; f < domain.triangles().size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const uint32_t v = domain.triangles()[f][k];
      DomainPoint corner{f, {}};
      corner.barycentric[k] = 1;
      sites[v] = {base_positions[v], surface.vertex_normal(domain.input_vertex(v)), corner, PiercingKind::kNormal, 0};
    }
  }
  Topology topology = domain.topology();
  const StencilTable stencils(topology);
  for (int level = 0; level < options.num_levels; ++level) {
    const std::vector<Site> midpoints =
        LevelPiercer(surface, domain, options, level, topology, sites).Run(stencils, positions);
    sites.insert(sites.end(), midpoints.begin(), midpoints.end());
    for (const Site& site : midpoints) {
      positions.push_back(site.position);
      result.piercing.push_back(site.kind);
    }
    if (level + 1 < options.num_levels) topology = Refine(topology);
  }
  for (const Site& site : sites) result.surface_normals.push_back(site.normal);
  if (parameters != nullptr) {
    parameters->clear();
    for (const Site& site : sites) parameters->push_back(site.parameter);
  }
  return result;
}

double NormalShare(const NormalMesh& mesh) {
  const auto count = [&](PiercingKind kind) {
    return static_cast<double>(std::count(mesh.piercing.begin(), mesh.piercing.end(), kind));
  };
  const double off_curves = static_cast<double>(mesh.piercing.size()) - count(PiercingKind::kCurve);
  return off_curves > 0 ? count(PiercingKind::kNormal) / off_curves : 1.0;
}

}  // namespace lacerta
