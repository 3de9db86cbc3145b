// A semi-regular mesh with what glTF lays on it, level by level: what the remesher makes and the progressive stream carries.
#ifndef LACERTA_ATTRIBUTED_LEVELS_H_
#define LACERTA_ATTRIBUTED_LEVELS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "lacerta/attributed_mesh.h"
#include "lacerta/mesh.h"

namespace lacerta {

// One attribute over all levels of a semi-regular mesh. The *wedge mesh* of an attribute has the triangles of the base with
// `base_corners` as vertices: it is the base cut along the seams of this attribute, and is split 1-to-4 like the surface, so that
// corner k of triangle t of a level of the wedge mesh lies at corner k of triangle t of that level of the surface.
struct LevelAttribute {
  std::string name;  // as in glTF
  AttributeKind kind = AttributeKind::kGeneric;
  uint32_t components = 1;  // > 0
  // #F0, rows of the base's values; MeshAttribute::kNoValue x 3 where the group of the face has not got the attribute.
  std::vector<Triangle> base_corners;
  uint32_t num_base_values = 0;
  // #values x components, in the order of SemiRegularMesh::positions: base first, then level by level one per edge of the wedge mesh.
  std::vector<float> values;

  uint32_t num_values() const { return static_cast<uint32_t>(values.size() / components); }
};

struct AttributedSemiRegularMesh {
  SemiRegularMesh surface;
  std::vector<uint32_t> base_groups;  // #F0, one per base triangle, which those that it is split into inherit; empty: all 0
  std::vector<LevelAttribute> attributes;
};

}  // namespace lacerta

#endif  // LACERTA_ATTRIBUTED_LEVELS_H_
