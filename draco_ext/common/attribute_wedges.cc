#include "common/attribute_wedges.h"

#include <utility>

namespace lacerta {

StatusOr<AttributeWedges> MakeAttributeWedges(const std::vector<Triangle>& corners, uint32_t num_values) {
  std::vector<Triangle> triangles;
  std::vector<uint32_t> base_faces;
  for (uint32_t f = 0; f < corners.size(); ++f) {
    if (corners[f][0] == kNone) continue;
    triangles.push_back(corners[f]);
    base_faces.push_back(f);
  }
  LACERTA_ASSIGN_OR_RETURN(Topology topology, BuildTopology(num_values, triangles));
  StencilTable stencils(topology);
  return AttributeWedges{std::move(topology), std::move(stencils), std::move(base_faces), 0};
}

void RefineWedges(AttributeWedges* wedges) {
  wedges->topology = Refine(wedges->topology);
  ++wedges->level;
}

std::vector<Triangle> WithoutStill(const std::vector<Triangle>& corners, const std::vector<uint8_t>& still) {
  if (still.empty()) return corners;
  std::vector<Triangle> split;
  for (size_t f = 0; f < corners.size(); ++f) {
    if (still[f] == 0) split.push_back(corners[f]);
  }
  return split;
}

}  // namespace lacerta
