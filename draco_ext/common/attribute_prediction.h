// What is expected of an attribute at the new vertices of a level, and how residuals move it, for decoder and encoder alike. Specified in
// docs/format.md, "Values of attributes".
#ifndef LACERTA_COMMON_ATTRIBUTE_PREDICTION_H_
#define LACERTA_COMMON_ATTRIBUTE_PREDICTION_H_

#include <array>
#include <cstdint>
#include <vector>

#include "common/attribute_layout.h"
#include "common/attribute_wedges.h"
#include "lacerta/mesh.h"

namespace lacerta {

// The decoded surface under a wedge mesh.
struct SurfaceLevel {
  const Topology& coarse;       // the level whose edges get midpoints
  Span<const Vec3f> positions;  // #V + #E or more: of the finer level
};

// Appends a row for each edge of the wedge mesh to `values`, #V x components on entry. Normals and tangents are of unit length.
void PredictAttribute(const AttributeHeader& header, const AttributeWedges& wedges, const SurfaceLevel& surface, std::vector<float>* values);

// Two unit vectors across the predicted normal of the midpoint of a wedge edge: the first one along the edge.
std::array<Vec3f, 2> NormalAxes(const AttributeWedges& wedges, const SurfaceLevel& surface, uint32_t edge, const Vec3f& normal);

// Moves the last #E rows, as PredictAttribute made them, by residuals: CodedComponents lists of #E each, one after the other, in steps.
void AddResiduals(const AttributeHeader& header, const AttributeWedges& wedges, const SurfaceLevel& surface, float step,
                  const std::vector<int32_t>& residuals, std::vector<float>* values);

}  // namespace lacerta

#endif  // LACERTA_COMMON_ATTRIBUTE_PREDICTION_H_
