// Attributes in the refinement header, for reader and writer. Specified in docs/format.md, "Attributes".
#ifndef LACERTA_COMMON_ATTRIBUTE_LAYOUT_H_
#define LACERTA_COMMON_ATTRIBUTE_LAYOUT_H_

#include <cstdint>
#include <vector>

#include "lacerta/decoder.h"

namespace lacerta {

inline constexpr uint32_t kMostComponents = 1024;  // of all attributes together, so that their models take little memory
inline constexpr uint32_t kMostNameBytes = 255;
inline constexpr int kFirstAttributeStepBits = 0x3a80;  // 2^-10: steps are told as differences, the first one from this one
inline constexpr uint8_t kLastAttributeKind = static_cast<uint8_t>(AttributeKind::kGeneric);

// How the value at a midpoint is expected.
enum class AttributePrediction : uint8_t {
  kButterfly = 0,  // of the coarser values
  kLinear = 1,     // mean of both ends
  kGeometry = 2,   // normals: that of the decoded triangles around it
};

struct AttributeHeader {
  AttributeLattice precision;
  AttributePrediction prediction = AttributePrediction::kButterfly;
  std::vector<float> steps;  // L, as RoundStep returns them; 0: the level has no residuals
  bool is_chained = false;   // of colors: residuals of green are stored less those of red, of blue less those of green
};

inline constexpr uint8_t kChainedFlag = 4;  // beside the prediction

// Whether residual `c` of a value is stored less the one before it.
inline bool IsChained(const AttributeHeader& header, uint32_t c) { return header.is_chained && (c == 1 || c == 2); }

// Residuals that are coded for each value: normals move in their tangent plane, the sign of a tangent stays.
inline uint32_t CodedComponents(const AttributeLattice& p) {
  if (p.kind == AttributeKind::kNormal) return 2;
  return p.kind == AttributeKind::kTangent ? 3 : p.components;
}

// Whether kind and number of components go together.
inline bool HasLegalComponents(const AttributeLattice& p) {
  if (p.kind == AttributeKind::kNormal) return p.components == 3;
  if (p.kind == AttributeKind::kTangent) return p.components == 3 || p.components == 4;
  return p.components >= 1;
}

// Whether residuals may be chained.
inline bool HasChain(const AttributeLattice& p) { return p.kind == AttributeKind::kColor && p.components >= 3; }

}  // namespace lacerta

#endif  // LACERTA_COMMON_ATTRIBUTE_LAYOUT_H_
