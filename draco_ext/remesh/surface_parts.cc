#include "remesh/surface_parts.h"

#include <utility>

#include "remesh/features.h"

namespace lacerta {
namespace {

// The triangles that `belongs` chooses with the vertices that they use, in order; source_vertex: of the vertices that are taken.
template <typename Belongs>
TriangleMesh Part(const ManifoldMesh& whole, const Belongs& belongs, std::vector<uint32_t>* source_vertex) {
  std::vector<uint8_t> used(whole.mesh.positions.size(), 0);
  TriangleMesh part;
  for (uint32_t f = 0; f < whole.mesh.triangles.size(); ++f) {
    if (!belongs(f)) continue;
    part.triangles.push_back(whole.mesh.triangles[f]);
    for (const uint32_t v : part.triangles.back()) used[v] = 1;
  }
  std::vector<uint32_t> number(used.size(), kNone);
  for (uint32_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    number[v] = static_cast<uint32_t>(part.positions.size());
    part.positions.push_back(whole.mesh.positions[v]);
    source_vertex->push_back(whole.source_vertex[v]);
  }
  for (Triangle& t : part.triangles) t = {number[t[0]], number[t[1]], number[t[2]]};
  return part;
}

Topology TopologyWithFeatures(const TriangleMesh& mesh) {
  Topology topology = BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles).value();
  Features features = DetectFeatures(mesh, topology);
  BaseTags tags;
  tags.crease = std::move(features.crease);
  tags.corner = std::move(features.corner);
  return BuildTopology(topology.num_vertices, mesh.triangles, tags).value();
}

// Makes copies of a vertex corners, but for those inside of double sheets, where all around have copies: they are as free as any
// vertex of a sheet alone.
void PinCopies(size_t num_sources, SurfaceParts* parts) {
  std::vector<uint32_t> num_copies(num_sources, 0);
  for (const uint32_t v : parts->source_vertex) ++num_copies[v];
  const auto is_copy = [&](uint32_t v) { return num_copies[parts->source_vertex[v]] > 1; };
  Topology& topology = parts->topology;
  std::vector<uint8_t> inside(topology.num_vertices, 1);
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    const auto& [a, b] = topology.edges[e];
    if (topology.on_curve[e] || !is_copy(a)) inside[b] = 0;
    if (topology.on_curve[e] || !is_copy(b)) inside[a] = 0;
  }
  for (uint32_t v = 0; v < topology.num_vertices; ++v) {
    if (is_copy(v) && !inside[v]) topology.role[v] = CurveRole::kCorner;
  }
}

}  // namespace

SurfaceParts SplitSurface(const TriangleMesh& cleaned, const SurfacePartsOptions& options) {
  const ManifoldMesh whole = MakeManifold(cleaned);
  const auto is_refined = [&](uint32_t f) { return whole.components[whole.component[f]].faces >= options.fewest_faces; };
  SurfaceParts parts;
  parts.report = whole.report;
  for (const ComponentTopology& c : whole.components) {
    ++(c.faces >= options.fewest_faces ? parts.refined_components : parts.still_components);
  }
  parts.refined = Part(whole, is_refined, &parts.source_vertex);
  std::vector<uint32_t> still_source;
  parts.still = Part(whole, [&](uint32_t f) { return !is_refined(f); }, &still_source);
  if (parts.refined.triangles.empty()) return parts;

  parts.topology = TopologyWithFeatures(parts.refined);
  PinCopies(cleaned.positions.size(), &parts);
  return parts;
}

}  // namespace lacerta
