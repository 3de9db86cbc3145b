#include "decoder/attribute_decoder.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "decoder/level_limits.h"

namespace lacerta {

StatusOr<AttributeDecoder> AttributeDecoder::Create(AttributeHeader header, const LevelAttribute& base, const std::vector<uint8_t>& still) {
  LACERTA_ASSIGN_OR_RETURN(AttributeWedges wedges, MakeAttributeWedges(WithoutStill(base.base_corners, still), base.num_base_values));
  return AttributeDecoder(std::move(header), std::move(wedges));
}

void AttributeDecoder::ReachFinestLevel() {
  if (wedges_.level < num_levels_) RefineWedges(&wedges_);
}

Status AttributeDecoder::CheckNextFits(const DecodeLimits& limits, uint64_t* num_floats) {
  constexpr uint64_t kMostFloatsPerVertex = 64;
  ReachFinestLevel();
  const std::string where = "attribute " + header_.precision.name;
  LACERTA_RETURN_IF_ERROR(CheckLevelFits(wedges_.topology, 0, num_levels_ + 1, limits).WithContext(where));
  *num_floats += (uint64_t{wedges_.topology.num_vertices} + wedges_.topology.num_edges()) * header_.precision.components;
  if (*num_floats / kMostFloatsPerVertex <= limits.max_vertices) return Status();
  return LimitExceeded(where + ": values of level " + std::to_string(num_levels_ + 1) + " are over the decode limits");
}

Status AttributeDecoder::AddLevel(const SurfaceLevel& surface, RangeDecoder* coder, LevelAttribute* attribute) {
  ReachFinestLevel();
  const auto level = static_cast<size_t>(num_levels_);
  const float step = header_.steps[level];
  const bool continues = level + 1 < header_.steps.size() && header_.steps[level + 1] > 0;
  std::vector<int32_t> residuals;
  if (step > 0) residuals.resize(size_t{CodedComponents(header_.precision)} * wedges_.topology.num_edges());
  CodeAttributeLevel(wedges_.topology, step, continues, &state_, &residuals, coder);
  const size_t before = attribute->values.size();
  PredictAttribute(header_, wedges_, surface, &attribute->values);
  if (step > 0) AddResiduals(header_, wedges_, surface, step, residuals, &attribute->values);
  const auto first_new = attribute->values.begin() + static_cast<ptrdiff_t>(before);
  if (!std::all_of(first_new, attribute->values.end(), [](float x) { return std::isfinite(x); })) {
    attribute->values.resize(before);
    return InvalidData("attribute " + header_.precision.name + " has values that are not finite on level " + std::to_string(level + 1));
  }
  ++num_levels_;
  return Status();
}

std::vector<Triangle> AttributeDecoder::Corners(int level, size_t num_split) const {
  const std::vector<Triangle> triangles = wedges_.level < level ? RefineTriangles(wedges_.topology) : wedges_.topology.triangles;
  std::vector<Triangle> corners(num_split, {kNone, kNone, kNone});
  for (uint32_t f = 0; f < triangles.size(); ++f) corners[wedges_.SurfaceFaceAt(level, f)] = triangles[f];
  return corners;
}

}  // namespace lacerta
