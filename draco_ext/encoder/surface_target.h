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
#include "encoder/midpoint_stencils.h"
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

// A quadratic form of offsets.
struct SymmetricMatrix {
  float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  // Adds isotropic * |d|^2 + along * (d . n)^2.
  void Add(const Vec3f& n, float isotropic, float along) {
    xx += isotropic + along * n.x * n.x;
    yy += isotropic + along * n.y * n.y;
    zz += isotropic + along * n.z * n.z;
    xy += along * n.x * n.y;
    xz += along * n.x * n.z;
    yz += along * n.y * n.z;
  }
  float Along(const Vec3f& d) const {
    return xx * d.x * d.x + yy * d.y * d.y + zz * d.z * d.z + 2 * (xy * d.x * d.y + xz * d.x * d.z + yz * d.y * d.z);
  }
};

// Everything about a normal mesh that does not change while its coefficients are chosen.
struct SurfaceTarget {
  std::vector<Topology> topologies;           // of levels 0 .. L, the finest one without its edges
  StencilTable stencils;
  std::vector<MidpointStencils> midpoints;    // of levels 0 .. L-1
  std::vector<StencilSpread> spreads;         // of levels 0 .. L-1
  std::vector<Vec3f> points;                  // #V of the finest level: points of the input
  std::vector<Vec3f> normals;                 // #V, unit
  std::vector<float> areas;                   // of the triangles of the finest level, as shares of the whole; 0 where there is none
  // Per level 0 .. L: share of the area at each vertex; each sums to 1. Still triangles have no part in it.
  std::vector<std::vector<float>> masses;
  std::vector<std::vector<SymmetricMatrix>> curvatures;  // per level 0 .. L: #V, of Curvatures (encoder/local_model.h)
  std::vector<PiercingKind> piercing;         // #V - #V0
  // #V of the finest level, or empty where no borders are joined: the next vertex that always lies where this one does, or kNone.
  // Chains begin with the vertex whose lattice point or coefficients count.
  std::vector<uint32_t> next_twin;
  bool keeps_vertices = false;                // sliding is an error too

  int num_levels() const { return static_cast<int>(spreads.size()); }
};

// What an offset of a vertex counts: sliding along the surface costs a share of what leaving it costs: little where the vertex was found
// by piercing, so that vertices just do not drift; much where it was not, since the surface is not flat there in the sense that planes
// presume. Where vertices are kept, what suits tangential steps of twice the normal one. On curves all directions matter, and more than
// the area at them says (docs/decisions/0008-curves.md).
struct VertexMetric {
  float slide = 0, leave = 1;
};
inline VertexMetric MetricAt(const SurfaceTarget& target, size_t v) {
  constexpr float kPiercedSlideCost = 0.05f, kOtherSlideCost = 0.15f, kKeptSlideCost = 0.25f, kCurveSlideCost = 0.5f;
  constexpr float kCurveWeight = 4.0f;  // a border is seen, though hardly any area lies at it
  if (target.topologies.back().role[v] != CurveRole::kSmooth) return {kCurveSlideCost * kCurveWeight, kCurveWeight};
  if (target.keeps_vertices) return {kKeptSlideCost, 1};
  const size_t num_base = target.points.size() - target.piercing.size();
  const bool pierced = v < num_base || target.piercing[v - num_base] == PiercingKind::kNormal;
  return {pierced ? kPiercedSlideCost : kOtherSlideCost, 1};
}
// That metric applied to an offset.
inline Vec3f Weigh(const SurfaceTarget& target, size_t v, const Vec3f& offset) {
  const VertexMetric metric = MetricAt(target, v);
  const Vec3f& n = target.normals[v];
  return offset * metric.slide + n * ((metric.leave - metric.slide) * Dot(offset, n));
}

SurfaceTarget MakeSurfaceTarget(const NormalMesh& mesh);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_SURFACE_TARGET_H_
