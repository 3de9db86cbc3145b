#include "remesh/attributed_remesh.h"

#include <algorithm>
#include <string>
#include <utility>

#include "geometry/bounding_box.h"
#include "remesh/attribute_fit.h"
#include "remesh/base_attributes.h"
#include "remesh/base_parts.h"
#include "remesh/base_optimization.h"
#include "remesh/decimate.h"
#include "remesh/level_attributes.h"
#include "remesh/level_wedges.h"
#include "remesh/piercing.h"
#include "remesh/surface_fit.h"

namespace lacerta {
namespace {

constexpr size_t kFewestFacesPerBaseFace = 8;

BaseOrder Unchanged(const TriangleMesh& base) {
  BaseOrder order;
  for (uint32_t v = 0; v < base.positions.size(); ++v) order.vertex_map.push_back(v);
  order.triangles = base.triangles;
  return order;
}

}  // namespace

StatusOr<CollapseHistory> DecimateAttributed(const AttributedParts& parts) {
  const TriangleMesh& mesh = parts.refined.surface;
  DecimateOptions options;
  options.drawn_curves = parts.topology.on_curve;
  for (uint32_t e = 0; e < parts.topology.num_edges(); ++e) {
    if (parts.shape_creases[e] != 0) options.drawn_curves[e] = 0;
  }
  CollapseHistory history = Decimate(mesh, parts.topology, options);
  const size_t base_faces = history.FacesAt(history.num_collapses()).size();
  if (base_faces * kFewestFacesPerBaseFace > mesh.triangles.size()) {
    return Unsupported("the base mesh would have " + std::to_string(base_faces) + " of " + std::to_string(mesh.triangles.size()) +
                       " triangles, for its seams and borders");
  }
  return history;
}

StatusOr<AttributedNormalMesh> RemeshAttributed(const AttributedParts& parts, const InputSurface& surface, const CollapseHistory& history,
                                                const AttributedRemeshOptions& options) {
  const TriangleMesh& mesh = parts.refined.surface;
  BaseDomain domain(history, history.CollapsesTo(options.num_base_vertices));
  const uint32_t num_refined = domain.num_vertices();
  std::vector<Vec3f> slid = domain.PositionsOn(mesh);
  OptimizeBase(surface, &domain, &slid);
  const TriangleMesh base = Together({slid, domain.triangles()}, parts.still.surface);
  BaseOrder order = Unchanged(base);
  if (options.order) {
    LACERTA_ASSIGN_OR_RETURN(order, options.order(base));
  }
  std::vector<Triangle> split;
  std::vector<uint8_t> still;
  for (const Triangle& t : order.triangles) {
    still.push_back(order.vertex_map[t[0]] >= num_refined);
    if (!still.back()) split.push_back(t);
  }
  std::vector<Vec3f> positions;
  std::vector<uint32_t> still_vertex;
  for (const uint32_t v : order.vertex_map) {
    positions.push_back(base.positions[v]);
    still_vertex.push_back(v >= num_refined ? v - num_refined : kNone);
  }
  domain.Reorder(order.vertex_map, split);
  domain.Join(JoinedVertices(positions));

  AttributedNormalMesh result;
  PiercingOptions piercing;
  piercing.num_levels = options.num_levels;
  std::vector<DomainPoint> parameters;
  result.surface = Pierce(surface, domain, positions, piercing, &parameters);
  result.surface.mesh.base_triangles = order.triangles;
  if (!parts.still.surface.triangles.empty()) result.surface.mesh.tags.still = std::move(still);
  FitToInput(surface, SurfaceFitOptions(), &result.surface);
  BaseAttributes base_attributes = SampleBase(parts, domain, order.triangles, still_vertex);
  result.base_groups = std::move(base_attributes.groups);
  result.attributes = std::move(base_attributes.attributes);
  SampleLevels(parts, domain, result.surface.mesh, parameters, &result.attributes);
  return result;
}

void FitLevelAttributes(const GroupSurface& original, AttributedSemiRegularMesh* mesh) {
  AttributedMesh finest = FinestLevel(*mesh);
  std::vector<std::vector<Triangle>> corners;
  for (const MeshAttribute& attribute : finest.attributes) corners.push_back(attribute.corners);
  AttributeFitOptions options;
  const BoundingBox box = BoundsOf(original.mesh().surface.positions);
  options.diagonal = Norm(Vec3Cast<double>(box.high) - Vec3Cast<double>(box.low));
  FitAttributes(original, options, &finest);
  for (size_t a = 0; a < corners.size(); ++a) {
    LevelAttribute& level = mesh->attributes[a];
    const MeshAttribute& fitted = finest.attributes[a];
    for (size_t f = 0; f < corners[a].size(); ++f) {
      if (corners[a][f][0] == MeshAttribute::kNoValue) continue;
      for (size_t k = 0; k < 3; ++k) {
        std::copy_n(fitted.values.begin() + static_cast<std::ptrdiff_t>(size_t{fitted.corners[f][k]} * level.components), level.components,
                    level.values.begin() + static_cast<std::ptrdiff_t>(size_t{corners[a][f][k]} * level.components));
      }
    }
  }
}

}  // namespace lacerta
