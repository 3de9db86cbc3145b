// The wedge mesh of an attribute, level by level: the triangles of the surface that have it, cut along its seams, and where they lie on
// the surface.
#ifndef LACERTA_COMMON_ATTRIBUTE_WEDGES_H_
#define LACERTA_COMMON_ATTRIBUTE_WEDGES_H_

#include <cstdint>
#include <vector>

#include "common/butterfly.h"
#include "common/subdivision.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

struct AttributeWedges {
  Topology topology;                 // of `level`
  StencilTable stencils;             // of all levels
  std::vector<uint32_t> base_faces;  // the triangle of the surface's level 0 topology under each of level 0
  int level = 0;

  // The triangle of the surface at `level` under face f; its corners and edges have the same numbers within it.
  uint32_t SurfaceFace(uint32_t f) const { return SurfaceFaceAt(level, f); }
  uint32_t SurfaceFaceAt(int at, uint32_t f) const { return base_faces[f >> 2 * at] << 2 * at | (f & ((1u << 2 * at) - 1)); }
};

// corners: rows of the base's values at the triangles that are split (kNoValue x 3: not there), num_values of them. Fails as BuildTopology
// does.
StatusOr<AttributeWedges> MakeAttributeWedges(const std::vector<Triangle>& corners, uint32_t num_values);

// Goes on to the next level.
void RefineWedges(AttributeWedges* wedges);

// The corners of base triangles that are split.
std::vector<Triangle> WithoutStill(const std::vector<Triangle>& corners, const std::vector<uint8_t>& still);

}  // namespace lacerta

#endif  // LACERTA_COMMON_ATTRIBUTE_WEDGES_H_
