#include "remesh/manifold.h"

#include <algorithm>
#include <utility>

#include "common/subdivision.h"
#include "remesh/edge_corners.h"
#include "remesh/face_neighbors.h"
#include "remesh/vertex_fans.h"

namespace lacerta {
namespace {

// Turns faces over; corners 1 and 2 of each change places, in `edges` and `mate` too.
TriangleMesh Flipped(const TriangleMesh& mesh, const std::vector<uint8_t>& flipped, EdgeCorners* edges,
                     std::vector<uint32_t>* mate) {
  TriangleMesh result = mesh;
  for (size_t f = 0; f < flipped.size(); ++f) {
    if (flipped[f] == 0) continue;
    std::swap(result.triangles[f][1], result.triangles[f][2]);
    std::swap((*mate)[3 * f + 1], (*mate)[3 * f + 2]);
  }
  const auto moved = [&](uint32_t c) {
    return c == kNone || flipped[c / 3] == 0 || c % 3 == 0 ? c : c % 3 == 1 ? c + 1 : c - 1;
  };
  for (uint32_t& c : *mate) c = moved(c);
  for (uint32_t& c : edges->corners) c = moved(c);
  return result;
}

// Faces of which one was to be turned over to agree with the other are neighbors no more.
void TurnNone(FaceNeighbors* neighbors) {
  std::vector<uint8_t>& flipped = neighbors->flipped;
  for (uint32_t c = 0; c < neighbors->mate.size(); ++c) {
    uint32_t& mate = neighbors->mate[c];
    if (mate != kNone && flipped[c / 3] != flipped[mate / 3]) neighbors->mate[std::exchange(mate, kNone)] = kNone;
  }
  std::fill(flipped.begin(), flipped.end(), uint8_t{0});
}

// The component of every face, over mates.
std::vector<uint32_t> Components(const std::vector<uint32_t>& mate) {
  std::vector<uint32_t> component(mate.size() / 3, kNone), stack;
  uint32_t count = 0;
  for (uint32_t seed = 0; seed < component.size(); ++seed) {
    if (component[seed] != kNone) continue;
    component[seed] = count;
    stack.push_back(seed);
    while (!stack.empty()) {
      const uint32_t f = stack.back();
      stack.pop_back();
      for (uint32_t c = 3 * f; c < 3 * f + 3; ++c) {
        if (mate[c] == kNone || component[mate[c] / 3] != kNone) continue;
        component[mate[c] / 3] = count;
        stack.push_back(mate[c] / 3);
      }
    }
    ++count;
  }
  return component;
}

// mesh: as it comes out, oriented and with one fan per vertex.
std::vector<ComponentTopology> Describe(const TriangleMesh& mesh, const std::vector<uint32_t>& mate,
                                        const std::vector<uint32_t>& component) {
  std::vector<ComponentTopology> result;
  std::vector<uint64_t> border_edges;
  std::vector<uint32_t> part(mesh.positions.size(), kNone);  // component of a vertex
  std::vector<uint32_t> border_after(mesh.positions.size(),
                                     kNone);  // vertex at the end of the border edge that starts here
  for (uint32_t f = 0; f < component.size(); ++f) {
    if (component[f] == result.size()) {
      result.emplace_back();
      border_edges.push_back(0);
    }
    ++result[component[f]].faces;
    for (uint32_t c = 3 * f; c < 3 * f + 3; ++c) {
      part[VertexOf(mesh.triangles, c)] = component[f];
      if (mate[c] != kNone) continue;
      border_after[StartOfEdge(mesh.triangles, c)] = EndOfEdge(mesh.triangles, c);
      ++border_edges[component[f]];
    }
  }
  for (uint32_t v = 0; v < part.size(); ++v) {
    if (part[v] == kNone) continue;
    ++result[part[v]].vertices;
    result[part[v]].borders += border_after[v] != kNone;
    for (uint32_t at = v; border_after[at] != kNone;) at = std::exchange(border_after[at], kNone);
  }
  for (size_t i = 0; i < result.size(); ++i) {
    const auto faces = static_cast<int64_t>(result[i].faces), border = static_cast<int64_t>(border_edges[i]);
    result[i].euler = result[i].vertices - (3 * faces + border) / 2 + faces;
  }
  return result;
}

// Edges of the input, no longer all of whose faces are neighbors.
uint64_t CountCutEdges(const EdgeCorners& edges, const std::vector<uint32_t>& mate) {
  uint64_t count = 0;
  for (uint32_t e = 0; e < edges.num_edges(); ++e) {
    const Span<const uint32_t> corners = edges.of(e);
    count += corners.size() > 2 || (corners.size() == 2 && mate[corners[0]] == kNone);
  }
  return count;
}

uint64_t CountSplitVertices(size_t num_sources, const std::vector<uint32_t>& source) {
  std::vector<bool> split(num_sources, false);
  for (size_t v = num_sources; v < source.size(); ++v) split[source[v]] = true;
  return static_cast<uint64_t>(std::count(split.begin(), split.end(), true));
}

}  // namespace

ManifoldMesh MakeManifold(const TriangleMesh& cleaned, Orientation orientation) {
  EdgeCorners edges = GroupByEdge(cleaned.positions.size(), cleaned.triangles);
  FaceNeighbors neighbors = FindNeighbors(cleaned, edges);
  if (orientation == Orientation::kKept) TurnNone(&neighbors);
  ManifoldMesh result;
  result.mesh = Flipped(cleaned, neighbors.flipped, &edges, &neighbors.mate);
  VertexFans fans = SplitVertices(result.mesh, edges, &neighbors.mate);
  result.source_vertex = std::move(fans.source);
  for (size_t v = cleaned.positions.size(); v < result.source_vertex.size(); ++v) {
    result.mesh.positions.push_back(cleaned.positions[result.source_vertex[v]]);
  }
  for (size_t f = 0; f < result.mesh.triangles.size(); ++f) {
    result.mesh.triangles[f] = {fans.vertex[3 * f], fans.vertex[3 * f + 1], fans.vertex[3 * f + 2]};
  }
  result.component = Components(neighbors.mate);
  result.components = Describe(result.mesh, neighbors.mate, result.component);

  ManifoldReport& report = result.report;
  report.flipped_triangles =
      static_cast<uint64_t>(std::count(neighbors.flipped.begin(), neighbors.flipped.end(), uint8_t{1}));
  report.cut_edges = CountCutEdges(edges, neighbors.mate);
  report.split_vertices = CountSplitVertices(cleaned.positions.size(), result.source_vertex);
  report.components = result.components.size();
  for (const ComponentTopology& c : result.components) report.borders += c.borders;
  return result;
}

}  // namespace lacerta
