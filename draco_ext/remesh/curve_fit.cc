#include "remesh/curve_fit.h"

#include <algorithm>
#include <vector>

#include "geometry/facing.h"
#include "geometry/vertex_area_vectors.h"
#include "remesh/mesh_fit.h"
#include "remesh/wedge_mesh.h"

namespace lacerta {
namespace {

std::vector<VertexFreedom> FreedomOf(const AttributedMesh& mesh) {
  const WedgeMesh wedges = MakeWedgeMesh(mesh);
  std::vector<VertexFreedom> freedom(mesh.surface.positions.size(), VertexFreedom::kSurface);
  for (uint32_t v = 0; v < wedges.num_vertices(); ++v) {
    VertexFreedom& own = freedom[wedges.source_vertex[v]];
    own = std::max(own, wedges.freedom[v]);
  }
  return freedom;
}

// facing: the sum of the normals at its corners, as an attribute; zero where there is none.
bool IsTurnedOver(const Triangle& t, const Vec3d& facing, const std::vector<Vec3f>& before, const std::vector<Vec3f>& after) {
  const Vec3d old_normal = AreaVector(before, t), new_normal = AreaVector(after, t);
  if (Dot(new_normal, facing) < 0 && Dot(old_normal, facing) >= 0) return true;
  return Dot(old_normal, new_normal) < 0.2 * Norm(old_normal) * Norm(new_normal);
}

}  // namespace

void FitBesideCurves(const FitTarget& target, int rounds, AttributedMesh* mesh) {
  TriangleMesh& surface = mesh->surface;
  const std::vector<Vec3f> before = surface.positions;
  const std::vector<VertexFreedom> freedom = FreedomOf(*mesh);
  std::vector<Vec3d> normals = VertexAreaVectors(surface);
  for (Vec3d& n : normals) n = Normalized(n);
  const MeshAttribute* normals_attribute = FindNormals(*mesh);
  FitToSurface(target, MeshNeighbors(surface), RateModel{}, rounds, &surface);
  for (size_t v = 0; v < before.size(); ++v) {
    if (freedom[v] == VertexFreedom::kSurface) continue;
    const Vec3d old = Vec3Cast<double>(before[v]);
    const double along = freedom[v] == VertexFreedom::kCurve ? Dot(Vec3Cast<double>(surface.positions[v]) - old, normals[v]) : 0;
    surface.positions[v] = Vec3Cast<float>(old + normals[v] * along);
  }
  constexpr int kRounds = 8;  // of taking back what the others make necessary; then everything
  for (int round = 0;; ++round) {
    bool any = false;
    for (uint32_t f = 0; f < surface.triangles.size(); ++f) {
      const Triangle& t = surface.triangles[f];
      if (!IsTurnedOver(t, normals_attribute == nullptr ? Vec3d{} : FacingOf(*normals_attribute, f), before, surface.positions)) continue;
      any = true;
      for (const uint32_t v : t) surface.positions[v] = before[v];
    }
    if (!any) return;
    if (round == kRounds) break;
  }
  surface.positions = before;
}

}  // namespace lacerta
