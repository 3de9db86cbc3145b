// A family of primitives coded with rounded values.
#ifndef LACERTA_PACK_ROUNDED_FAMILY_H_
#define LACERTA_PACK_ROUNDED_FAMILY_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "document/draco_encode.h"
#include "document/primitive.h"
#include "lacerta/gltf.h"
#include "lacerta/status.h"
#include "pack/descents_within.h"
#include "pack/rounded_attributes.h"
#include "pack/rounding_forecast.h"
#include "pack/rounding_levels.h"

namespace lacerta {

struct RoundedFamily {
  std::vector<DracoEncoded> members;                  // in the order of the primitives
  std::vector<DracoPrecision> precisions;             // parallel
  std::vector<std::vector<AttributeReport>> reports;  // of their attributes but POSITION; errors are the family's
  double error = 0.0;                                 // d_S, mesh units
  // Parallel to the attributes of FamilyMeter::original: total RMS of normals and tangents, or the target where that is
  // larger; infinity for others. Empty where the surface could not be measured.
  std::vector<double> everywhere;

  uint64_t size() const;  // bytes of the members
};

// Codes the primitives of a family. All functions that code fail like EncodeDracoPrimitive.
class FamilyCoder {
 public:
  // Refers to its arguments.
  FamilyCoder(const std::vector<const Primitive*>& primitives, const std::vector<RoundedAttribute>& attributes, RoundingForecast* forecast)
      : primitives_(primitives), attributes_(attributes), forecast_(*forecast) {}

  // Precisions, values and reports at these levels, as forecast; nothing is coded yet.
  RoundedFamily RoundedAt(const RoundingLevels& levels);
  // Puts other values of an attribute in their place. positions: those of the family.
  void SetValues(size_t a, const DescendedValues& descent, const RoundedPositions& positions, RoundedFamily* family);

  Status Code(RoundedFamily* family, DracoSearch search = DracoSearch::kConnectivity) const;
  // What has been coded, in an order of fewer bytes.
  Status CodeInOtherOrder(RoundedFamily* family) const;
  // What it would take in the codings that its members have.
  StatusOr<uint64_t> BytesAsCoded(const RoundedFamily& family) const;
  // No more than any precision takes that meets the targets: the bytes of what has a target, far too coarse. error: that of positions, mesh units. 0
  // where that is not known.
  uint64_t FewestBytes(double error) const;

 private:
  int SetPrecision(size_t a, const RoundedAttribute::Part& part, int level, DracoPrecision* precision) const;
  void SetAttribute(size_t a, int level, const RoundedPositions& positions, RoundedFamily* family);
  void SetPart(const RoundedAttribute::Part& part, AccessorData values, RoundedFamily* family) const;
  template <typename T, typename Make>
  StatusOr<std::vector<T>> OfEachMember(const Make& make) const;

  const std::vector<const Primitive*>& primitives_;
  const std::vector<RoundedAttribute>& attributes_;
  RoundingForecast& forecast_;
};

}  // namespace lacerta

#endif  // LACERTA_PACK_ROUNDED_FAMILY_H_
