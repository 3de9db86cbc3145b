#include "remesh/wedge_mesh.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "geometry/equal_rows.h"
#include "remesh/edge_corners.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;

// The faces of the input that are no repetition and have three vertices.
std::vector<uint32_t> SoundFaces(const AttributedMesh& input) {
  std::vector<uint32_t> faces;
  std::vector<uint32_t> table;  // group, and the vertices from the smallest on
  for (uint32_t f = 0; f < input.surface.triangles.size(); ++f) {
    Triangle t = input.surface.triangles[f];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    table.insert(table.end(), {input.GroupOf(f), t[0], t[1], t[2]});
    faces.push_back(f);
  }
  const std::vector<uint32_t> first = FirstEqualRow(Span<const uint32_t>(table), 4);
  size_t kept = 0;
  for (size_t i = 0; i < faces.size(); ++i) {
    if (first[i] == i) faces[kept++] = faces[i];
  }
  faces.resize(kept);
  return faces;
}

AttributeNodes MakeNodes(const MeshAttribute& attribute, const WedgeMesh& result) {
  AttributeNodes out;
  out.nodes.resize(result.mesh.triangles.size(), {kNone, kNone, kNone});
  std::vector<uint32_t> table;    // vertex and value of each corner that has one
  std::vector<uint32_t*> corner;  // where the node of that row belongs
  for (size_t f = 0; f < out.nodes.size(); ++f) {
    Triangle values = attribute.corners[result.source_face[f]];
    if (values[0] == kNone) continue;
    if (result.flipped[f] != 0) std::swap(values[1], values[2]);
    for (size_t k = 0; k < 3; ++k) {
      table.insert(table.end(), {result.mesh.triangles[f][k], values[k]});
      corner.push_back(&out.nodes[f][k]);
    }
  }
  const std::vector<uint32_t> first = FirstEqualRow(Span<const uint32_t>(table), 2);
  for (size_t i = 0; i < first.size(); ++i) {
    if (first[i] == i) {
      *corner[i] = static_cast<uint32_t>(out.values.size());
      out.values.push_back(table[2 * i + 1]);
    } else {
      *corner[i] = *corner[first[i]];
    }
  }
  return out;
}

// Whether the surface is continuous over the edge that two faces share, opposite to the corners c and d.
bool IsSmoothEdge(const WedgeMesh& mesh, const AttributedMesh& input, uint32_t c, uint32_t d) {
  const uint32_t f = c / 3, g = d / 3;
  if (mesh.flipped[f] != mesh.flipped[g]) return false;
  if (input.GroupOf(mesh.source_face[f]) != input.GroupOf(mesh.source_face[g])) return false;
  return std::all_of(mesh.attributes.begin(), mesh.attributes.end(), [&](const AttributeNodes& a) {
    return VertexOf(a.nodes, NextCorner(c)) == VertexOf(a.nodes, PreviousCorner(d)) &&
           VertexOf(a.nodes, PreviousCorner(c)) == VertexOf(a.nodes, NextCorner(d));
  });
}

void FindCurves(const AttributedMesh& input, WedgeMesh* mesh) {
  const std::vector<Triangle>& triangles = mesh->mesh.triangles;
  mesh->curve_edges.assign(triangles.size(), 0);
  std::vector<uint32_t> num_curves(mesh->num_vertices(), 0), num_copies(input.surface.positions.size(), 0);
  std::vector<uint8_t> has_border(input.surface.positions.size(), 0);  // at one of its copies
  for (const uint32_t source : mesh->source_vertex) ++num_copies[source];
  const EdgeCorners edges = GroupByEdge(mesh->num_vertices(), triangles);
  for (uint32_t e = 0; e < edges.num_edges(); ++e) {
    const Span<const uint32_t> corners = edges.of(e);
    if (corners.size() == 2 && IsSmoothEdge(*mesh, input, corners[0], corners[1])) continue;
    for (const uint32_t c : corners) mesh->curve_edges[c / 3] |= static_cast<uint8_t>(1u << (c % 3));
    for (const uint32_t v : {StartOfEdge(triangles, corners[0]), EndOfEdge(triangles, corners[0])}) {
      ++num_curves[v];
      if (corners.size() == 1) has_border[mesh->source_vertex[v]] = 1;
    }
  }
  for (uint32_t v = 0; v < mesh->num_vertices(); ++v) {
    const uint32_t source = mesh->source_vertex[v];
    const bool is_cut = has_border[source] != 0 && num_copies[source] > 1;
    mesh->freedom.push_back(is_cut                ? VertexFreedom::kFixed
                            : num_curves[v] == 0  ? VertexFreedom::kSurface
                            : num_curves[v] == 2  ? VertexFreedom::kCurve
                                                  : VertexFreedom::kJunction);
  }
}

}  // namespace

WedgeMesh MakeWedgeMesh(const AttributedMesh& input) {
  WedgeMesh result;
  result.source_face = SoundFaces(input);
  TriangleMesh cleaned{input.surface.positions, {}};
  for (const uint32_t f : result.source_face) cleaned.triangles.push_back(input.surface.triangles[f]);
  ManifoldMesh manifold = MakeManifold(cleaned);
  result.mesh = std::move(manifold.mesh);
  result.source_vertex = std::move(manifold.source_vertex);
  result.component = std::move(manifold.component);
  result.components = std::move(manifold.components);
  for (size_t f = 0; f < cleaned.triangles.size(); ++f) {
    result.flipped.push_back(result.source_vertex[result.mesh.triangles[f][1]] != cleaned.triangles[f][1]);
  }
  for (const MeshAttribute& attribute : input.attributes) result.attributes.push_back(MakeNodes(attribute, result));
  FindCurves(input, &result);
  return result;
}

AttributedMesh TakeFaces(const AttributedMesh& input, const WedgeMesh& wedges, TriangleMesh surface, const std::vector<uint32_t>& faces) {
  AttributedMesh part;
  part.surface = std::move(surface);
  if (!input.groups.empty()) {
    for (const uint32_t f : faces) part.groups.push_back(input.groups[wedges.source_face[f]]);
  }
  for (const MeshAttribute& attribute : input.attributes) {
    MeshAttribute& out = part.attributes.emplace_back(attribute);
    out.corners.clear();
    for (const uint32_t f : faces) out.corners.push_back(attribute.corners[wedges.source_face[f]]);
  }
  return part;
}

AttributedMesh TakeFaces(const AttributedMesh& input, const WedgeMesh& wedges) {
  std::vector<uint32_t> faces(wedges.source_face.size());
  std::iota(faces.begin(), faces.end(), 0u);
  return TakeFaces(input, wedges, wedges.mesh, faces);
}

}  // namespace lacerta
