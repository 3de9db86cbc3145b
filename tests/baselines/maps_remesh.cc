#include "baselines/maps_remesh.h"

#include <array>
#include <vector>

namespace lacerta::baselines {

SemiRegularMesh MapsRemesh(const InputSurface& surface, const BaseDomain& domain, int num_levels) {
  SemiRegularMesh mesh = {domain.triangles(), domain.num_vertices(), num_levels, domain.PositionsOn(surface.mesh()), domain.tags()};
  // By face, the corners in coordinates of the base face it lies in. Faces are refined in the order of common/subdivision.h.
  using Corners = std::array<Vec3d, 3>;
  std::vector<Corners> corners(domain.triangles().size(), Corners{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}});
  Topology topology = domain.topology();
  for (int level = 0; level < num_levels; ++level) {
    for (uint32_t e = 0; e < topology.num_edges(); ++e) {
      const uint32_t face = topology.edge_faces[e][0];
      const int k = EdgeCorner(topology, face, e);
      const Vec3d middle = (corners[face][(k + 1) % 3] + corners[face][(k + 2) % 3]) * 0.5;
      const DomainPoint on_input = domain.ToInput({face >> (2 * level), middle});
      mesh.positions.push_back(surface.PositionAt(on_input.face, on_input.barycentric));
    }
    if (level + 1 == num_levels) break;
    std::vector<Corners> finer;
    for (const Corners& c : corners) {
      const Corners middle = {(c[1] + c[2]) * 0.5, (c[2] + c[0]) * 0.5, (c[0] + c[1]) * 0.5};
      for (int k = 0; k < 3; ++k) finer.push_back({c[k], middle[(k + 2) % 3], middle[(k + 1) % 3]});
      finer.push_back(middle);
    }
    corners = std::move(finer);
    topology = Refine(topology);
  }
  return mesh;
}

}  // namespace lacerta::baselines
