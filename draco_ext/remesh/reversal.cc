#include "remesh/reversal.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "common/subdivision.h"

namespace lacerta {
namespace {

// Triangles that agree more with the input's normals at their corners are not looked up, unless one is on a crease.
constexpr float kSafeCosine = 0.9f;

// Of a level and the next finer one, #V + #E: 1 on creases, where the input has several normals.
std::vector<uint8_t> CreaseVertices(const Topology& coarse) {
  std::vector<uint8_t> on_crease(size_t{coarse.num_vertices} + coarse.num_edges(), 0);
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
    if (!coarse.on_curve[e] || coarse.is_border(e)) continue;
    for (const uint32_t v : {coarse.edges[e][0], coarse.edges[e][1], coarse.num_vertices + e}) on_crease[v] = 1;
  }
  return on_crease;
}

}  // namespace

bool IsReversed(const InputSurface& surface, const std::array<Vec3f, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vec3f normal = AreaNormal(corners), centroid = (a + b + c) * (1.0f / 3);
  const auto agrees = [&](const SurfacePoint& p) {
    const Vec3d weights{p.barycentric[0], p.barycentric[1], p.barycentric[2]};
    return p.face == SurfacePoint::kNone || Dot(normal, surface.NormalAt(p.face, weights)) >= 0;
  };
  if (agrees(surface.tree().ClosestPoint(centroid).point)) return false;
  const float reach = std::max({Norm(b - a), Norm(c - b), Norm(a - c)});
  std::vector<LineHit> hits;
  surface.tree().IntersectLine(centroid, Normalized(normal), -reach, reach, &hits);
  return std::none_of(hits.begin(), hits.end(), [&](const LineHit& hit) { return agrees(hit.point); });
}

ReversedPart FindReversed(const InputSurface& surface, const NormalMesh& remesh) {
  const SemiRegularMesh& mesh = remesh.mesh;
  Topology topology = BuildTopology(mesh.num_base_vertices, mesh.base_triangles, mesh.tags).value();
  for (int level = 1; level < mesh.num_levels; ++level) topology = Refine(topology);
  const std::vector<uint8_t> on_crease = CreaseVertices(topology);
  const std::vector<Triangle> triangles = mesh.num_levels > 0 ? RefineTriangles(topology) : std::move(topology.triangles);
  std::vector<uint8_t> is_reversed(triangles.size());
  std::vector<double> area(triangles.size());
  tbb::parallel_for(size_t{0}, triangles.size(), [&](size_t f) {
    std::array<Vec3f, 3> corners;
    Vec3f facing;
    bool is_creased = false;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = triangles[f][k];
      corners[k] = mesh.positions[v];
      if (on_crease[v] == 0) facing += remesh.surface_normals[v];
      is_creased = is_creased || on_crease[v] != 0;
    }
    const Vec3f normal = AreaNormal(corners);
    area[f] = Norm(Vec3Cast<double>(normal));
    const float agreement = Dot(normal, facing);
    const bool is_safe = !is_creased && agreement >= kSafeCosine * Norm(normal) * Norm(facing);
    is_reversed[f] = agreement < 0 || (!is_safe && IsReversed(surface, corners));
  });
  const double total = std::accumulate(area.begin(), area.end(), 0.0);
  ReversedPart part;
  for (uint32_t f = 0; f < triangles.size(); ++f) {
    if (is_reversed[f] == 0 || !(area[f] > 0)) continue;
    const uint32_t base_face = f >> (2 * mesh.num_levels);
    if (part.faces.empty() || part.faces.back().number != base_face) part.faces.push_back({base_face, 0});
    part.faces.back().share += area[f] / total;
    part.share += area[f] / total;
  }
  std::stable_sort(part.faces.begin(), part.faces.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
  return part;
}

bool HoldReversed(const ReversedPart& part, const BaseDomain& domain, std::vector<uint32_t>* held) {
  if (part.share <= kMostReversed) return false;
  const size_t most_faces = std::max<size_t>(4, domain.triangles().size() / 32);
  std::vector<uint32_t> more = *held;
  size_t num_faces = 0;
  double left = part.share;
  for (const ReversedPart::Face& face : part.faces) {
    if (left <= kMostReversed / 3) break;
    if (++num_faces > most_faces) return false;
    left -= face.share;
    if (const uint32_t collapse = domain.created_by(face.number); collapse != kNone) more.push_back(collapse);
  }
  std::sort(more.begin(), more.end());
  more.erase(std::unique(more.begin(), more.end()), more.end());
  if (more.size() == held->size()) return false;
  *held = std::move(more);
  return true;
}

}  // namespace lacerta
