#include "remesh/attributed_parts.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "remesh/surface_parts.h"
#include "remesh/wedge_mesh.h"

namespace lacerta {
namespace {

// Whether the attribute goes on over an edge: its values are the same on both sides, at both ends.
bool IsContinuous(const AttributedMesh& mesh, const Topology& topology, const MeshAttribute& attribute, uint32_t edge) {
  const auto& faces = topology.edge_faces[edge];
  if (faces[1] == kNone) return false;
  std::array<std::array<uint32_t, 2>, 2> rows;  // of either face, at the ends of the edge
  for (size_t side = 0; side < 2; ++side) {
    for (size_t k = 0; k < 3; ++k) {
      for (size_t end = 0; end < 2; ++end) {
        if (mesh.surface.triangles[faces[side]][k] == topology.edges[edge][end]) rows[side][end] = attribute.corners[faces[side]][k];
      }
    }
  }
  return rows[0][0] != MeshAttribute::kNoValue && rows[0] == rows[1];
}

// The two curve edges of vertices where just two meet; kNone elsewhere.
std::vector<std::array<uint32_t, 2>> CurveEdgesAt(const Topology& topology) {
  std::vector<std::array<uint32_t, 2>> at(topology.num_vertices, {kNone, kNone});
  std::vector<uint32_t> count(topology.num_vertices, 0);
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    if (!topology.on_curve[e]) continue;
    for (const uint32_t v : topology.edges[e]) {
      if (count[v] < 2) at[v][count[v]] = e;
      ++count[v];
    }
  }
  for (uint32_t v = 0; v < topology.num_vertices; ++v) {
    if (count[v] != 2) at[v] = {kNone, kNone};
  }
  return at;
}

// Base edges are seams or no seams from end to end.
void PinChanges(const AttributedMesh& mesh, const std::vector<std::vector<uint8_t>>& seams, Topology* topology) {
  const auto borders_groups = [&](uint32_t e) {
    const auto& [f, g] = topology->edge_faces[e];
    return g != kNone && mesh.GroupOf(f) != mesh.GroupOf(g);
  };
  const std::vector<std::array<uint32_t, 2>> at = CurveEdgesAt(*topology);
  for (uint32_t v = 0; v < topology->num_vertices; ++v) {
    const auto& [a, b] = at[v];
    if (a == kNone || topology->role[v] != CurveRole::kCurve) continue;
    const auto differs = [a = a, b = b](const std::vector<uint8_t>& seam) { return seam[a] != seam[b]; };
    if (borders_groups(a) != borders_groups(b) || std::any_of(seams.begin(), seams.end(), differs)) topology->role[v] = CurveRole::kCorner;
  }
}

// A slit is a seam that ends inside of the surface at both ends: as a single base edge it would have the same two base values on either side,
// and so be none. A corner in its middle keeps it open.
void PinSlits(const std::vector<uint8_t>& seam, Topology* topology) {
  const std::vector<uint32_t> wedge = FindWedges(*topology, seam);
  const auto is_closed_at = [&](uint32_t edge, uint32_t v) {
    uint32_t sides[2];
    for (size_t side = 0; side < 2; ++side) {
      const uint32_t f = topology->edge_faces[edge][side];
      const Triangle& t = topology->triangles[f];
      sides[side] = wedge[3 * f + (t[0] == v ? 0 : t[1] == v ? 1 : 2)];
    }
    return sides[0] == sides[1];
  };
  const std::vector<std::array<uint32_t, 2>> at = CurveEdgesAt(*topology);
  for (uint32_t start = 0; start < topology->num_edges(); ++start) {
    if (!seam[start] || !topology->on_curve[start] || topology->is_border(start)) continue;
    for (int direction = 0; direction < 2; ++direction) {  // from an end that is closed to the next corner
      const uint32_t first = topology->edges[start][direction];
      if (topology->role[first] != CurveRole::kCorner || !is_closed_at(start, first)) continue;
      std::vector<uint32_t> inside;
      uint32_t edge = start, v = first;
      for (;;) {
        v = topology->edges[edge][0] == v ? topology->edges[edge][1] : topology->edges[edge][0];
        if (topology->role[v] == CurveRole::kCorner || at[v][0] == kNone) break;
        inside.push_back(v);
        edge = at[v][0] == edge ? at[v][1] : at[v][0];
      }
      if (!inside.empty() && v != first && is_closed_at(edge, v)) topology->role[inside[inside.size() / 2]] = CurveRole::kCorner;
    }
  }
}

// Why components stand still, for a surface that has no others.
std::string WhyStill(const WedgeMesh& wedges, const std::vector<uint32_t>& corners, const AttributedPartsOptions& options) {
  const auto largest = std::max_element(wedges.components.begin(), wedges.components.end(),
                                        [](const ComponentTopology& a, const ComponentTopology& b) { return a.faces < b.faces; });
  if (largest == wedges.components.end()) return "no triangle";
  if (largest->faces < options.fewest_faces) return "no component has triangles enough to be worth remeshing";
  const auto c = static_cast<size_t>(largest - wedges.components.begin());
  return "seams and borders of groups meet at " + std::to_string(corners[c]) + " vertices of a component of " + std::to_string(largest->faces) +
         " triangles: too many for a base mesh";
}

}  // namespace

std::vector<uint32_t> FindWedges(const Topology& topology, const std::vector<uint8_t>& is_seam) {
  std::vector<uint32_t> wedge(size_t{3} * topology.num_faces(), kNone);
  for (uint32_t first = 0; first < wedge.size(); ++first) {
    if (wedge[first] != kNone) continue;
    const uint32_t v = topology.triangles[first / 3][first % 3];
    for (const uint32_t direction : {1u, 2u}) {
      for (uint32_t f = first / 3; f != kNone;) {
        const Triangle& t = topology.triangles[f];
        const uint32_t k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
        if (wedge[3 * f + k] != kNone && f != first / 3) break;  // once around
        wedge[3 * f + k] = first;
        const uint32_t edge = topology.face_edges[f][(k + direction) % 3];
        f = is_seam[edge] != 0 ? kNone : FaceAcross(topology, f, edge);
      }
    }
  }
  return wedge;
}

StatusOr<AttributedParts> SplitAttributedSurface(const AttributedMesh& mesh, const AttributedPartsOptions& options) {
  const WedgeMesh wedges = MakeWedgeMesh(mesh);
  const auto num_flipped = std::count(wedges.flipped.begin(), wedges.flipped.end(), uint8_t{1});
  if (num_flipped > 0) return Unsupported(std::to_string(num_flipped) + " triangles look the other way than their neighbors");

  SurfaceToSplit whole{wedges.mesh, wedges.source_vertex, wedges.component, {}, wedges.curve_edges};
  std::vector<uint32_t> component_of(wedges.num_vertices(), kNone), corners(wedges.components.size(), 0);
  for (size_t f = 0; f < wedges.component.size(); ++f) {
    for (const uint32_t v : wedges.mesh.triangles[f]) component_of[v] = wedges.component[f];
  }
  for (uint32_t v = 0; v < wedges.num_vertices(); ++v) {
    const bool stays = wedges.freedom[v] == VertexFreedom::kJunction || wedges.freedom[v] == VertexFreedom::kFixed;
    if (stays && component_of[v] != kNone) ++corners[component_of[v]];
  }
  for (size_t c = 0; c < wedges.components.size(); ++c) {
    const uint32_t faces = wedges.components[c].faces;
    whole.refine.push_back(faces >= options.fewest_faces && corners[c] <= options.most_corners * faces);
  }
  SurfaceParts split = SplitSurface(whole);
  if (split.refined.triangles.empty()) return Unsupported(WhyStill(wedges, corners, options));

  AttributedParts parts;
  parts.refined = TakeFaces(mesh, wedges, std::move(split.refined), split.refined_faces);
  parts.still = TakeFaces(mesh, wedges, std::move(split.still), split.still_faces);
  parts.topology = std::move(split.topology);
  parts.source_vertex = std::move(split.source_vertex);
  parts.shape_creases = std::move(split.shape_creases);
  for (const MeshAttribute& attribute : parts.refined.attributes) {
    std::vector<uint8_t>& seam = parts.seams.emplace_back();
    for (uint32_t e = 0; e < parts.topology.num_edges(); ++e) {
      seam.push_back(!IsContinuous(parts.refined, parts.topology, attribute, e));
    }
  }
  PinChanges(parts.refined, parts.seams, &parts.topology);
  for (const std::vector<uint8_t>& seam : parts.seams) PinSlits(seam, &parts.topology);
  PinBordersWithCommonEnds(parts.source_vertex, &parts.topology);
  return parts;
}

}  // namespace lacerta
