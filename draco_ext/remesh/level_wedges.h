// Wedge meshes of attributes at any level, and the finest level as one mesh with attributes.
#ifndef LACERTA_REMESH_LEVEL_WEDGES_H_
#define LACERTA_REMESH_LEVEL_WEDGES_H_

#include <cstdint>
#include <vector>

#include "common/base_tags.h"
#include "lacerta/attributed_levels.h"
#include "lacerta/attributed_mesh.h"

namespace lacerta {

// The base triangles of the wedge mesh that are split, and where those are among the base's split triangles.
struct SplitWedges {
  std::vector<Triangle> triangles;
  std::vector<uint32_t> number;  // #F0 that are split: in `triangles`, or kNone without a value
};

SplitWedges SplitOf(const BaseTags& tags, const LevelAttribute& attribute);

// Wedge triangles at a level of what SplitOf gave.
std::vector<Triangle> RefinedWedges(const SplitWedges& split, uint32_t num_base_values, int level);

// The wedge mesh of a level: 4^level triangles for each base triangle that is split, then the still ones, as MeshAtLevel orders them;
// kNoValue x 3 where the attribute is not. 0 <= level <= num_levels.
std::vector<Triangle> WedgeTriangles(const SemiRegularMesh& surface, const LevelAttribute& attribute, int level);

// The surface of the finest level with its attributes. The corners of attribute a are WedgeTriangles(.., num_levels).
AttributedMesh FinestLevel(const AttributedSemiRegularMesh& mesh);

}  // namespace lacerta

#endif  // LACERTA_REMESH_LEVEL_WEDGES_H_
