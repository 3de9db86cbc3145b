#include "remesh/base_midpoints.h"

#include <algorithm>

#include "common/butterfly.h"
#include "geometry/triangle_tree.h"

namespace lacerta {

MidpointsOver::MidpointsOver(const Topology& base, uint32_t enough) : level_ends{base.num_vertices} {
  constexpr double kLevelWeight = 2.0;  // of a level, over that of the one before
  double weight = 1.0;
  int shift = 0;
  const auto base_face = [&](uint32_t face) { return face == kNone ? kNone : face >> shift; };
  for (Topology level = base;; level = Refine(level)) {
    const StencilTable table(level);
    midpoints.reserve(midpoints.size() + level.num_edges() + 1);
    for (uint32_t e = 0; e < level.num_edges(); ++e) {
      const auto& [f, g] = level.edge_faces[e];
      midpoints.push_back({level.edges[e], {base_face(f), base_face(g)}, stencils.size(), level.on_curve[e] != 0 ? 0.0 : weight});
      VisitStencil(level, table, e, [&](uint32_t v, float w) { stencils.push_back({v, static_cast<double>(w)}); });
    }
    level_ends.push_back(level.num_vertices + level.num_edges());
    if (num_points() > enough) break;
    weight *= kLevelWeight;
    shift += 2;
  }
  midpoints.push_back({{}, {}, stencils.size(), 0.0});
}

std::vector<Flap> FlapsOf(const Topology& base) {
  std::vector<Flap> flaps;
  flaps.reserve(base.num_edges());
  for (uint32_t e = 0; e < base.num_edges(); ++e) {
    const auto& [f, g] = base.edge_faces[e];
    if (g != kNone) flaps.push_back({OppositeVertex(base, f, e), OppositeVertex(base, g, e), base.edges[e][0], base.edges[e][1]});
  }
  return flaps;
}

void PointsOnInput::Resize(uint32_t num_points) {
  at.resize(num_points);
  normals.resize(num_points);
  faces.resize(num_points, kNone);
  distances.resize(num_points);
}

PointsOnInput BaseOnInput(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& positions, uint32_t num_points) {
  PointsOnInput points;
  points.Resize(num_points);
  for (uint32_t v = 0; v < domain.num_vertices(); ++v) {
    points.at[v] = Vec3Cast<double>(positions[v]);
    points.normals[v] = Vec3Cast<double>(NormalAtBase(surface, domain, v));
    points.faces[v] = domain.slid_to(v).face;
  }
  return points;
}

bool FindMidpoint(const InputSurface& surface, const MidpointsOver& midpoints, uint32_t point, PointsOnInput* points) {
  constexpr double kLeastCosine = 0.2;     // between the normals of the midpoint and of the ends of its edge, or it is on another sheet
  constexpr double kOnAnotherSheet = 0.5;  // distance that it stands for, in lengths of the edge
  PointsOnInput& p = *points;
  const auto& [a, b] = midpoints.midpoint(point).ends;
  const Vec3d predicted = midpoints.Predicted(point, p.at);
  const uint32_t hint = p.faces[point] != kNone ? p.faces[point] : p.faces[a];
  const SurfacePoint closest = surface.tree().ClosestPointNear(Vec3Cast<float>(predicted), hint).point;
  const Vec3d expected = p.normals[a] + p.normals[b];
  p.faces[point] = closest.face;
  if (closest.face != kNone) p.normals[point] = Vec3Cast<double>(surface.NormalAt(closest.face, InputPoint(closest).barycentric));
  if (closest.face != kNone && Dot(p.normals[point], expected) > kLeastCosine * Norm(expected)) {
    p.at[point] = Vec3Cast<double>(closest.position);
    const Vec3d away = predicted - p.at[point];
    p.distances[point] = std::copysign(Norm(away), Dot(away, p.normals[point]));
    return true;
  }
  p.at[point] = predicted;
  p.normals[point] = Normalized(expected);
  p.distances[point] = kOnAnotherSheet * Norm(p.at[a] - p.at[b]);
  return false;
}

CodingBits::CodingBits(const MidpointsOver& midpoints, const PointsOnInput& points) {
  constexpr double kResolution = 0.5;  // over the mean distance on the first level
  constexpr double kFlat = 1e-5;       // of that distance, over edges: what rounding makes
  double distances = 0.0, lengths = 0.0, count = 0.0;
  for (uint32_t point = midpoints.level_ends[0]; point < midpoints.level_ends[1]; ++point) {
    const auto& [a, b] = midpoints.midpoint(point).ends;
    if (!(midpoints.midpoint(point).weight > 0.0)) continue;
    distances += std::fabs(points.distances[point]);
    lengths += Norm(points.at[a] - points.at[b]);
    count += 1.0;
  }
  if (!(distances > kFlat * lengths)) return;
  const double resolution = kResolution * distances / count;
  squared_resolution_ = resolution * resolution;
}

}  // namespace lacerta
