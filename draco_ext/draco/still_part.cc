#include "draco/still_part.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "draco/simplified_size.h"
#include "geometry/triangle_tree.h"
#include "lacerta/clean.h"
#include "lacerta/surface_distance.h"
#include "remesh/manifold.h"
#include "remesh/simplify.h"

namespace lacerta {
namespace {

constexpr double kHiddenShare = 0.5, kSimplifiedShare = 0.7;  // of the distance

// Whether every vertex of each component lies within `distance` of the surface: #C. Components are small, and so are their faces.
std::vector<uint8_t> LiesOn(const ManifoldMesh& part, const TriangleMesh& surface, double distance) {
  const TriangleTree tree(surface);
  const auto squared = static_cast<float>(distance * distance);
  std::vector<uint8_t> lies_on(part.components.size(), 1);
  for (size_t f = 0; f < part.mesh.triangles.size(); ++f) {
    uint8_t& result = lies_on[part.component[f]];
    for (const uint32_t v : part.mesh.triangles[f]) {
      if (result) result = tree.IsNear(part.mesh.positions[v], squared);
    }
  }
  return lies_on;
}

TriangleMesh Simplified(const TriangleMesh& mesh, double distance) {
  const StatusOr<SurfaceDistanceMeter> meter = SurfaceDistanceMeter::Create(mesh);
  if (!meter.ok()) return mesh;  // no area: nothing to measure, and hardly anything to save
  const SimplificationSequence sequence(mesh);
  constexpr uint64_t kSamples = 20'000;
  constexpr double kTolerance = 0.05;
  return sequence.MeshWith(static_cast<uint32_t>(std::ceil(SimplifiedSize(sequence, meter.value(), distance, kSamples, kTolerance))));
}

}  // namespace

StillPart PrepareStillPart(const TriangleMesh& still, const TriangleMesh& refined, double distance) {
  StillPart result;
  if (still.triangles.empty()) return result;
  const ManifoldMesh parts = MakeManifold(still);
  const std::vector<uint8_t> hidden = LiesOn(parts, refined, kHiddenShare * distance);
  TriangleMesh seen{still.positions, {}};
  for (size_t f = 0; f < still.triangles.size(); ++f) {
    if (!hidden[parts.component[f]]) seen.triangles.push_back(still.triangles[f]);
  }
  result.hidden_components = static_cast<uint64_t>(std::count(hidden.begin(), hidden.end(), 1));
  StatusOr<CleanedMesh> cleaned = Clean(seen);
  if (!cleaned.ok()) return result;  // nothing is left
  cleaned = Clean(Simplified(cleaned.value().mesh, kSimplifiedShare * distance));
  if (cleaned.ok()) result.mesh = MakeManifold(cleaned.value().mesh).mesh;
  return result;
}

}  // namespace lacerta
