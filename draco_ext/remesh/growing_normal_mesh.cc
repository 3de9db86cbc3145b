#include "remesh/growing_normal_mesh.h"

namespace lacerta {

GrowingNormalMesh::GrowingNormalMesh(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& base_positions,
                                     const PiercingOptions& options)
    : surface_(surface), domain_(domain), options_(options), sites_(domain.num_vertices()), topology_(domain.topology()), stencils_(topology_) {
  mesh_.mesh = {domain.triangles(), domain.num_vertices(), 0, base_positions, domain.tags()};
  for (uint32_t f = 0; f < domain.triangles().size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const uint32_t v = domain.triangles()[f][k];
      DomainPoint corner{f, {}};
      corner.barycentric[k] = 1;
      sites_[v] = {base_positions[v], NormalAtBase(surface, domain, v), corner, PiercingKind::kNormal, 0};
    }
  }
  for (const Site& site : sites_) mesh_.surface_normals.push_back(site.normal);
}

void GrowingNormalMesh::AddLevel() {
  const int level = mesh_.mesh.num_levels++;
  if (level > 0) topology_ = Refine(topology_);
  std::vector<Vec3f>& positions = mesh_.mesh.positions;
  const std::vector<Site> midpoints = LevelPiercer(surface_, domain_, options_, level, topology_, sites_).Run(stencils_, positions);
  sites_.insert(sites_.end(), midpoints.begin(), midpoints.end());
  for (const Site& site : midpoints) {
    positions.push_back(site.position);
    mesh_.piercing.push_back(site.kind);
    mesh_.surface_normals.push_back(site.normal);
  }
}

std::vector<DomainPoint> GrowingNormalMesh::Parameters() const {
  std::vector<DomainPoint> parameters;
  for (const Site& site : sites_) parameters.push_back(site.parameter);
  return parameters;
}

}  // namespace lacerta
