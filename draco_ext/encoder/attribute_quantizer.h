// Residuals of one attribute in a closed loop: each level is predicted from what decoders have of the coarser ones.
#ifndef LACERTA_ENCODER_ATTRIBUTE_QUANTIZER_H_
#define LACERTA_ENCODER_ATTRIBUTE_QUANTIZER_H_

#include <cstdint>
#include <vector>

#include "common/attribute_layout.h"
#include "common/attribute_wedges.h"
#include "common/subdivision.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// What does not change while steps are tried.
struct AttributeTarget {
  AttributeLattice precision;
  std::vector<AttributeWedges> wedges;  // of levels 0 .. L-1
  std::vector<float> base_values;       // rows of level 0 as decoded
  std::vector<float> values;            // rows of all levels as wanted
  std::vector<float> weights;           // #rows, share of the area at each; they sum to 1 or, without area, to 0
  std::vector<float> factors = {};      // #rows x components, on what values are off, of no direction; empty: all 1
};

// base: level 0 as decoded; values: rows of all levels in the order of its wedge mesh; positions: of the surface's finest level;
// topologies: of its levels 0 .. L-1. Fails where the wedge mesh is no manifold.
StatusOr<AttributeTarget> MakeAttributeTarget(const AttributeLattice& precision, const std::vector<Triangle>& split_corners,
                                              std::vector<float> base_values, std::vector<float> values,
                                              Span<const Topology> topologies, Span<const Vec3f> positions);

// An attribute as it goes into a stream.
struct CodedAttribute {
  AttributeHeader header;
  std::vector<std::vector<int32_t>> residuals;  // L x as in AddResiduals; empty on silent levels
  std::vector<float> decoded;                   // rows of all levels
};

// The steps are those of `header`. positions: of the finest level, as decoded.
CodedAttribute QuantizeAttribute(const AttributeTarget& target, const AttributeHeader& header, Span<const Topology> topologies,
                                 Span<const Vec3f> positions);

// Root mean square of the differences over the 99 % of the surface where they are least, as targets are: of normals and tangents in degrees, else Euclidean in the attribute's own units.
double AttributeRmsError(const AttributeTarget& target, const std::vector<float>& decoded);

// Bits that the residuals take in a stream.
double AttributeBits(const AttributeTarget& target, const CodedAttribute& coded);

// The fewest bits found that keep the error within `largest_error`: coarsest steps for each prediction and number of levels with residuals.
// Where none does, the finest steps tried.
CodedAttribute EncodeAttribute(const AttributeTarget& target, double largest_error, Span<const Topology> topologies, Span<const Vec3f> positions);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_ATTRIBUTE_QUANTIZER_H_
