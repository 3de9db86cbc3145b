// What decoder and encoder see of a base with attributes: one surface, and one wedge mesh for each attribute.
#ifndef LACERTA_COMMON_GLUED_BASE_H_
#define LACERTA_COMMON_GLUED_BASE_H_

#include <cstdint>
#include <vector>

#include "lacerta/attributed_base.h"
#include "lacerta/attributed_levels.h"
#include "lacerta/status.h"

namespace lacerta {

struct GluedBase {
  BaseMesh mesh;                           // the surface; its triangles are those of the AttributedBase, in their order
  std::vector<uint32_t> groups;            // #F0
  std::vector<LevelAttribute> attributes;  // of level 0
};

// Fails with kInvalidData where arrays do not have the shapes that AttributedBase tells, or integers are out of range.
StatusOr<GluedBase> GlueBase(const AttributedBase& base);

}  // namespace lacerta

#endif  // LACERTA_COMMON_GLUED_BASE_H_
