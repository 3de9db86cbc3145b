#include "remesh/surface_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "remesh/corners.h"
#include "remesh/features.h"

namespace lacerta {
namespace {

// The triangles that `belongs` chooses with the vertices that they use, in order; source_vertex: of the vertices that are taken.
template <typename Belongs>
TriangleMesh Part(const SurfaceToSplit& whole, const Belongs& belongs, std::vector<uint32_t>* source_vertex,
                  std::vector<uint32_t>* source_face) {
  std::vector<uint8_t> used(whole.mesh.positions.size(), 0);
  TriangleMesh part;
  for (uint32_t f = 0; f < whole.mesh.triangles.size(); ++f) {
    if (!belongs(f)) continue;
    part.triangles.push_back(whole.mesh.triangles[f]);
    source_face->push_back(f);
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

// Takes back the creases of components that have few of them. A part made of smooth pieces is crossed by creases; on a scan they are
// the rim of an ear or noise, and cost more, as curves that the base must follow, than they save (docs/decisions/0008-curves.md).
// component: #F, below num_components.
void DropFewCreases(const TriangleMesh& mesh, const Topology& topology, const std::vector<uint32_t>& component, size_t num_components,
                    std::vector<uint8_t>* crease) {
  constexpr double kLeastLength = 2;  // of all creases of a component, in square roots of its area
  const auto at = [&](uint32_t v) { return Vec3Cast<double>(mesh.positions[v]); };
  std::vector<double> area(num_components, 0.0), length(num_components, 0.0);
  for (uint32_t f = 0; f < topology.num_faces(); ++f) {
    const Triangle& t = mesh.triangles[f];
    area[component[f]] += Norm(Cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]))) / 2;
  }
  const auto component_of = [&](uint32_t edge) { return component[topology.edge_faces[edge][0]]; };
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    if ((*crease)[e]) length[component_of(e)] += Norm(at(topology.edges[e][1]) - at(topology.edges[e][0]));
  }
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    if (length[component_of(e)] < kLeastLength * std::sqrt(area[component_of(e)])) (*crease)[e] = 0;
  }
}

// Finds the curves of parts->refined: what its shape shows, and what is marked.
void FindCurves(const SurfaceToSplit& whole, SurfaceParts* parts) {
  const TriangleMesh& mesh = parts->refined;
  Topology topology = BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles).value();
  Features features = DetectFeatures(mesh, topology);
  std::vector<uint32_t> component;
  for (const uint32_t f : parts->refined_faces) component.push_back(whole.component[f]);
  DropFewCreases(mesh, topology, component, whole.refine.size(), &features.crease);
  parts->shape_creases = features.crease;
  BaseTags tags;
  tags.crease = std::move(features.crease);
  tags.corner = std::move(features.corner);
  if (!whole.curves.empty()) {
    for (uint32_t f = 0; f < topology.num_faces(); ++f) {
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t edge = topology.face_edges[f][k];
        if ((whole.curves[parts->refined_faces[f]] >> k & 1) != 0 && !topology.is_border(edge)) tags.crease[edge] = 1;
      }
    }
    constexpr double kCornerTurn = 45 * 3.14159265358979323846 / 180;
    tags.corner = FindCorners(mesh, topology, tags.crease, kCornerTurn);
  }
  parts->topology = BuildTopology(topology.num_vertices, mesh.triangles, tags).value();
}

// Makes copies of a vertex corners, but for those inside of double sheets, where all around have copies: they are as free as any
// vertex of a sheet alone.
void PinCopies(SurfaceParts* parts) {
  std::vector<uint32_t> num_copies(1 + *std::max_element(parts->source_vertex.begin(), parts->source_vertex.end()), 0);
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

// A part of a border from one corner to the next.
struct BorderArc {
  uint32_t first = kNone, last = kNone;  // corners
  uint32_t middle = kNone;               // a vertex halfway, or kNone where it is a single edge
};

// edges_at: #V x 2, the border edges of each vertex. Marks the edges of the arc as seen.
BorderArc FollowBorder(const Topology& topology, const std::vector<std::array<uint32_t, 2>>& edges_at, uint32_t corner, uint32_t edge,
                       std::vector<uint8_t>* seen) {
  std::vector<uint32_t> inside;
  uint32_t v = corner;
  for (;;) {
    (*seen)[edge] = 1;
    v = topology.edges[edge][0] == v ? topology.edges[edge][1] : topology.edges[edge][0];
    if (topology.role[v] == CurveRole::kCorner) break;
    inside.push_back(v);
    edge = edges_at[v][0] == edge ? edges_at[v][1] : edges_at[v][0];
  }
  return {corner, v, inside.empty() ? kNone : inside[inside.size() / 2]};
}

}  // namespace

// Borders that share only their ends (two holes that touch at two points) are different curves. A base that had a single edge for each
// would join them, as edges are joined by the places of their ends: a corner in the middle of all but one keeps them apart.
void PinBordersWithCommonEnds(const std::vector<uint32_t>& source_vertex, Topology* with_corners) {
  Topology& topology = *with_corners;
  std::vector<std::array<uint32_t, 2>> edges_at(topology.num_vertices, {kNone, kNone});
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    if (!topology.is_border(e)) continue;
    for (const uint32_t v : topology.edges[e]) edges_at[v][edges_at[v][0] != kNone] = e;
  }
  std::map<std::pair<uint32_t, uint32_t>, std::vector<BorderArc>> arcs;  // by the sources of their ends, the smaller first
  std::vector<uint8_t> seen(topology.num_edges(), 0);
  for (uint32_t v = 0; v < topology.num_vertices; ++v) {
    if (topology.role[v] != CurveRole::kCorner) continue;
    for (const uint32_t e : edges_at[v]) {
      if (e == kNone || seen[e]) continue;
      const BorderArc arc = FollowBorder(topology, edges_at, v, e, &seen);
      arcs[std::minmax(source_vertex[v], source_vertex[arc.last])].push_back(arc);
    }
  }
  for (const auto& [ends, between] : arcs) {
    // One may be a single edge: one that is, or else the first. Nor can others between its very same vertices be one too.
    auto single = std::find_if(between.begin(), between.end(), [](const BorderArc& arc) { return arc.middle == kNone; });
    if (single == between.end()) single = between.begin();
    for (const BorderArc& arc : between) {
      const bool has_same_ends = std::minmax(arc.first, arc.last) == std::minmax(single->first, single->last);
      if (arc.middle != kNone && !has_same_ends) topology.role[arc.middle] = CurveRole::kCorner;
    }
  }
}

SurfaceParts SplitSurface(const SurfaceToSplit& whole) {
  const auto is_refined = [&](uint32_t f) { return whole.refine[whole.component[f]] != 0; };
  SurfaceParts parts;
  for (const uint8_t refine : whole.refine) ++(refine != 0 ? parts.refined_components : parts.still_components);
  parts.refined = Part(whole, is_refined, &parts.source_vertex, &parts.refined_faces);
  std::vector<uint32_t> still_source;
  parts.still = Part(whole, [&](uint32_t f) { return !is_refined(f); }, &still_source, &parts.still_faces);
  if (parts.refined.triangles.empty()) return parts;
  FindCurves(whole, &parts);
  PinCopies(&parts);
  PinBordersWithCommonEnds(parts.source_vertex, &parts.topology);
  return parts;
}

SurfaceParts SplitSurface(const TriangleMesh& cleaned, const SurfacePartsOptions& options) {
  const ManifoldMesh whole = MakeManifold(cleaned);
  SurfaceToSplit to_split{whole.mesh, whole.source_vertex, whole.component, {}, {}};
  for (const ComponentTopology& c : whole.components) to_split.refine.push_back(c.faces >= options.fewest_faces);
  SurfaceParts parts = SplitSurface(to_split);
  parts.report = whole.report;
  return parts;
}

}  // namespace lacerta
