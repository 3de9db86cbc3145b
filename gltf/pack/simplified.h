// A family of primitives as one simplified surface in Draco form.
#ifndef LACERTA_PACK_SIMPLIFIED_H_
#define LACERTA_PACK_SIMPLIFIED_H_

#include <cstdint>
#include <vector>

#include "document/draco_encode.h"
#include "document/primitive.h"
#include "lacerta/gltf.h"
#include "lacerta/status.h"
#include "pack/attributed_family.h"

namespace lacerta {

struct SimplifiedFamily {
  std::vector<DracoEncoded> members;                   // in the order of the primitives
  std::vector<std::vector<AttributeReport>> reports;   // of their attributes, measured over the family
  int position_bits = 0;
  double error = 0.0;  // measured d_S between the primitives as they were and as decoded, mesh units
};

// Simplifies all `primitives` (one mesh or meshes that touch) as one surface, so that their borders stay joined, and
// encodes them on one lattice. The errors of what is decoded, measured on the surface, meet `error` (d_S, mesh units)
// and `targets` (RMS over the 99 % of the area where it is least). `texels_per_unit(member, set)` as in
// FindAttributeBits; `texel_side` is the side of the texture that texels are of; `everywhere` as in
// ErrorTargets, for the attributes of ToAttributedMesh. Fails with kUnsupported where
// attributes cannot be interpolated (joints, application attributes) or the errors are not met.
StatusOr<SimplifiedFamily> SimplifyFamily(const std::vector<const Primitive*>& primitives, double error,
                                          const AttributeTargets& targets, uint64_t texel_side,
                                          const TexelScale& texels_per_unit, const std::vector<double>& everywhere = {});

}  // namespace lacerta

#endif  // LACERTA_PACK_SIMPLIFIED_H_
