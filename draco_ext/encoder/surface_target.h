// What the decoded surface is fitted to: the input near each vertex of a normal mesh, as a plane with a weight.
//
// For a decoded vertex x near the point t of the input with unit normal n, ((x - t) . n)^2 is the squared distance to the
// input up to second order: sliding along the surface costs nothing, unless vertices are to be kept. Weighted with the area that the vertex stands for, the
// sum over the finest level approximates the squared one-sided surface distance.
#ifndef LACERTA_ENCODER_SURFACE_TARGET_H_
#define LACERTA_ENCODER_SURFACE_TARGET_H_

#include <cstdint>
#include <vector>

#include "common/butterfly.h"
#include "common/subdivision.h"
#include "lacerta/mesh.h"
#include "lacerta/remesh.h"
#include "lacerta/status.h"

namespace lacerta {

// The stencils of all edges of one level, seen from the vertices: vertex v contributes weights[k] to the midpoint of edge
// edges[k] for k in [first[v], first[v + 1]).
struct StencilSpread {
  std::vector<uint32_t> first;   // #V + 1
  std::vector<uint32_t> edges;
  std::vector<float> weights;
};
StencilSpread SpreadStencils(const Topology& topology, const StencilTable& table);

// Everything about a normal mesh that does not change while its coefficients are chosen.
struct SurfaceTarget {
  std::vector<Topology> topologies;           // of levels 0 .. L, the finest one without its edges
  StencilTable stencils;
  std::vector<StencilSpread> spreads;         // of levels 0 .. L-1
  std::vector<Vec3f> points;                  // #V of the finest level: points of the input
  std::vector<Vec3f> normals;                 // #V, unit
  // Per level 0 .. L: share of the area at each vertex; each sums to 1. Still triangles have no part in it.
  std::vector<std::vector<float>> masses;
  std::vector<PiercingKind> piercing;         // #V - #V0
  // #V of the finest level, or empty where no borders are joined: the next vertex that always lies where this one does, or kNone.
  // Chains begin with the vertex whose lattice point or coefficients count.
  std::vector<uint32_t> next_twin;
  bool keeps_vertices = false;                // sliding is an error too

  int num_levels() const { return static_cast<int>(spreads.size()); }
};

SurfaceTarget MakeSurfaceTarget(const NormalMesh& mesh);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_SURFACE_TARGET_H_
