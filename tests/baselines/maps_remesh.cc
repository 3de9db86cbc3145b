#include "baselines/maps_remesh.h"

#include <array>
#include <vector>

namespace lacerta::baselines {

namespace {

// Normals of the input at the old and the new point of a vertex must be closer than this, or it would change sheets.
constexpr float kLeastCosine = 0.5f;

struct SitePoint {
  Vec3f position, normal;
};

SitePoint PointAt(const InputSurface& surface, uint32_t face, const Vec3d& barycentric) {
  return {surface.PositionAt(face, barycentric), surface.NormalAt(face, barycentric)};
}

void Relax(const InputSurface& surface, const Topology& topology, std::vector<SitePoint>* sites) {
  std::vector<Vec3f> sums(sites->size());
  for (const auto& [a, b] : topology.edges) {
    sums[a] += (*sites)[b].position;
    sums[b] += (*sites)[a].position;
  }
  for (uint32_t v = 0; v < sites->size(); ++v) {
    if (topology.role[v] != CurveRole::kSmooth) continue;
    SitePoint& site = (*sites)[v];
    const Vec3f mean = sums[v] * (1.0f / static_cast<float>(topology.valence[v]));
    const SurfacePoint found = surface.tree().ClosestPoint(mean, SquaredNorm(mean - site.position)).point;
    if (found.face == SurfacePoint::kNone) continue;
    const auto& b = found.barycentric;
    const SitePoint moved = PointAt(surface, found.face, {b[0], b[1], b[2]});
    if (Dot(moved.normal, site.normal) > kLeastCosine) site = moved;
  }
}

}  // namespace

SemiRegularMesh MapsRemesh(const InputSurface& surface, const BaseDomain& domain, const MapsOptions& options) {
  std::vector<SitePoint> sites(domain.num_vertices());
  const std::vector<Vec3f> base = domain.PositionsOn(surface.mesh());
  for (uint32_t v = 0; v < base.size(); ++v) sites[v] = {base[v], surface.vertex_normal(domain.input_vertex(v))};
  // By face, the corners in coordinates of the base face it lies in. Faces are refined in the order of
  // common/subdivision.h.
  using Corners = std::array<Vec3d, 3>;
  std::vector<Corners> corners(domain.triangles().size(), Corners{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}});
  Topology topology = domain.topology();
  for (int level = 0; level < options.num_levels; ++level) {
    for (uint32_t e = 0; e < topology.num_edges(); ++e) {
      const uint32_t face = topology.edge_faces[e][0];
      const int k = EdgeCorner(topology, face, e);
      const Vec3d middle = (corners[face][(k + 1) % 3] + corners[face][(k + 2) % 3]) * 0.5;
      const DomainPoint on_input = domain.ToInput({face >> (2 * level), middle});
      sites.push_back(PointAt(surface, on_input.face, on_input.barycentric));
    }
    std::vector<Corners> finer;
    finer.reserve(4 * corners.size());
    for (const Corners& c : corners) {
      const Corners middle = {(c[1] + c[2]) * 0.5, (c[2] + c[0]) * 0.5, (c[0] + c[1]) * 0.5};
      for (int k = 0; k < 3; ++k) finer.push_back({c[k], middle[(k + 2) % 3], middle[(k + 1) % 3]});
      finer.push_back(middle);
    }
    corners = std::move(finer);
    topology = Refine(topology);
  }
  for (int round = 0; round < options.relaxation_rounds; ++round) Relax(surface, topology, &sites);
  SemiRegularMesh mesh = {domain.triangles(), domain.num_vertices(), options.num_levels, {}, domain.tags()};
  for (const SitePoint& site : sites) mesh.positions.push_back(site.position);
  return mesh;
}

}  // namespace lacerta::baselines
