// Remeshing of a surface with attributes: a normal mesh whose base edges carry all seams, with values at all levels.
#ifndef LACERTA_REMESH_ATTRIBUTED_REMESH_H_
#define LACERTA_REMESH_ATTRIBUTED_REMESH_H_

#include <cstdint>
#include <functional>
#include <vector>

#include "geometry/group_surface.h"
#include "lacerta/attributed_levels.h"
#include "lacerta/remesh.h"
#include "lacerta/status.h"
#include "remesh/attributed_parts.h"
#include "remesh/base_domain.h"
#include "remesh/collapse_history.h"
#include "remesh/input_surface.h"

namespace lacerta {

// parts.refined simplified with its seams kept in place. kUnsupported where seams leave a base of more than an eighth of the triangles:
// two levels above it would have twice as many as the input.
StatusOr<CollapseHistory> DecimateAttributed(const AttributedParts& parts);

// The order in which a coder of base meshes wants vertices and triangles.
struct BaseOrder {
  std::vector<uint32_t> vertex_map;  // #V0, the vertex of the given base
  std::vector<Triangle> triangles;   // #F0, in new numbers
};

struct AttributedNormalMesh {
  NormalMesh surface;
  std::vector<uint32_t> base_groups;
  std::vector<LevelAttribute> attributes;

  AttributedSemiRegularMesh Semiregular() const { return {surface.mesh, base_groups, attributes}; }
};

struct AttributedRemeshOptions {
  uint32_t num_base_vertices = 0;  // of the refined part, or as many as its seams make necessary
  int num_levels = 3;
  // What the base is coded as; empty: as it stands, vertices of the still part last.
  std::function<StatusOr<BaseOrder>(const TriangleMesh& base)> order;
};

// surface, history: of parts.refined.surface and parts.topology.
StatusOr<AttributedNormalMesh> RemeshAttributed(const AttributedParts& parts, const InputSurface& surface, const CollapseHistory& history,
                                                const AttributedRemeshOptions& options);

// Least squares of the values at all levels over the surface of the finest one (remesh/attribute_fit.h). parts: what `mesh` comes from.
void FitLevelAttributes(const GroupSurface& original, AttributedSemiRegularMesh* mesh);

}  // namespace lacerta

#endif  // LACERTA_REMESH_ATTRIBUTED_REMESH_H_
