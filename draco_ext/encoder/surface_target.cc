#include "encoder/surface_target.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "encoder/local_model.h"
#include "geometry/for_each_branch.h"
#include "geometry/vertex_area_vectors.h"

namespace lacerta {
namespace {

// Areas of the triangles as shares of the whole.
std::vector<float> AreaShares(const std::vector<Triangle>& triangles, const std::vector<Vec3f>& positions) {
  std::vector<double> areas;
  areas.reserve(triangles.size());
  double total = 0;
  for (const Triangle& t : triangles) {
    areas.push_back(Norm(AreaVector(positions, t)));
    total += areas.back();
  }
  std::vector<float> shares(areas.size());
  for (size_t i = 0; i < areas.size(); ++i) shares[i] = static_cast<float>(total > 0 ? areas[i] / total : 0.0);
  return shares;
}

// A third of the area of the triangles around each vertex.
std::vector<float> VertexAreas(size_t num_vertices, const std::vector<Triangle>& triangles, const std::vector<float>& areas) {
  std::vector<double> sums(num_vertices, 0.0);
  for (size_t i = 0; i < triangles.size(); ++i) {
    for (const uint32_t v : triangles[i]) sums[v] += areas[i] / 3.0;
  }
  return std::vector<float>(sums.begin(), sums.end());
}

// Each midpoint hands half of its mass to either end of its edge.
std::vector<float> LumpMasses(const Topology& coarse, const std::vector<float>& fine) {
  std::vector<float> masses(fine.begin(), fine.begin() + coarse.num_vertices);
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
    for (const uint32_t v : coarse.edges[e]) masses[v] += 0.5f * fine[coarse.num_vertices + e];
  }
  return masses;
}

// SurfaceTarget::next_twin. joined: BaseTags::joined; topologies: of levels 0 .. L.
std::vector<uint32_t> ChainTwins(const std::vector<uint32_t>& joined, const std::vector<Topology>& topologies) {
  if (joined.empty()) return {};
  std::vector<uint32_t> next(topologies.back().num_vertices, kNone), last(next.size());
  std::iota(last.begin(), last.end(), 0u);
  const auto append = [&](uint32_t first, uint32_t v) {
    next[last[first]] = v;
    last[first] = v;
  };
  for (uint32_t v = 0; v < joined.size(); ++v) {
    if (joined[v] != v) append(joined[v], v);
  }
  for (size_t level = 0; level + 1 < topologies.size(); ++level) {
    const Topology& t = topologies[level];
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      if (t.is_copy(e)) append(t.num_vertices + t.master[e], t.num_vertices + e);
    }
  }
  return next;
}

}  // namespace

StencilSpread SpreadStencils(const Topology& topology, const StencilTable& table) {
  StencilSpread spread;
  spread.first.assign(topology.num_vertices + 1, 0);
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    VisitStencil(topology, table, e, [&](uint32_t v, float) { ++spread.first[v + 1]; });
  }
  for (uint32_t v = 0; v < topology.num_vertices; ++v) spread.first[v + 1] += spread.first[v];
  spread.edges.resize(spread.first.back());
  spread.weights.resize(spread.first.back());
  std::vector<uint32_t> next(spread.first.begin(), spread.first.end() - 1);
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    VisitStencil(topology, table, e, [&](uint32_t v, float weight) {
      spread.edges[next[v]] = e;
      spread.weights[next[v]++] = weight;
    });
  }
  return spread;
}

SurfaceTarget MakeSurfaceTarget(const NormalMesh& mesh) {
  std::vector<Topology> topologies = {BuildTopology(mesh.mesh.num_base_vertices, mesh.mesh.base_triangles, mesh.mesh.tags).value()};
  StencilTable stencils(topologies[0]);
  for (int level = 1; level < mesh.mesh.num_levels; ++level) topologies.push_back(Refine(topologies.back()));
  if (mesh.mesh.num_levels > 0) topologies.push_back(RefineWithoutEdges(topologies.back()));
  std::vector<MidpointStencils> midpoints(mesh.mesh.num_levels);
  std::vector<StencilSpread> spreads(mesh.mesh.num_levels);
  ForEachBranch(2 * static_cast<size_t>(mesh.mesh.num_levels), [&](size_t i) {
    const auto level = static_cast<int>(i / 2);
    if (i % 2 == 0) {
      midpoints[level] = MidpointStencils(topologies[level], stencils);
    } else {
      spreads[level] = SpreadStencils(topologies[level], stencils);
    }
  });
  std::vector<std::vector<float>> masses(topologies.size());
  std::vector<float> areas = AreaShares(topologies.back().triangles, mesh.mesh.positions);
  masses.back() = VertexAreas(mesh.mesh.positions.size(), topologies.back().triangles, areas);
  for (size_t level = topologies.size() - 1; level > 0; --level) {
    masses[level - 1] = LumpMasses(topologies[level - 1], masses[level]);
  }
  std::vector<uint32_t> next_twin = ChainTwins(mesh.mesh.tags.joined, topologies);
  SurfaceTarget target{std::move(topologies), std::move(stencils), std::move(midpoints), std::move(spreads), mesh.mesh.positions, mesh.surface_normals,
                       std::move(areas),      std::move(masses),    {},                   mesh.piercing,      std::move(next_twin), mesh.keeps_vertices};
  target.curvatures.resize(target.topologies.size());
  ForEachBranch(target.curvatures.size(), [&](size_t level) { target.curvatures[level] = Curvatures(target, static_cast<int>(level)); });
  return target;
}

}  // namespace lacerta
