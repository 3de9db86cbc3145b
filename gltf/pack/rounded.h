// A family of primitives with all vertices, rounded as far as the errors allow.
#ifndef LACERTA_PACK_ROUNDED_H_
#define LACERTA_PACK_ROUNDED_H_

#include <cstdint>
#include <vector>

#include "document/draco_encode.h"
#include "document/primitive.h"
#include "lacerta/gltf.h"
#include "lacerta/status.h"
#include "pack/attributed_family.h"
#include "pack/precision.h"

namespace lacerta {

struct RoundedFamily {
  std::vector<DracoEncoded> members;                  // in the order of the primitives
  std::vector<DracoPrecision> precisions;             // parallel
  std::vector<std::vector<AttributeReport>> reports;  // the larger of the errors at the vertices and on the surface
  SharedLattice lattice;
  // Parallel to the attributes of ToAttributedMesh(kLeaveOut): total RMS of normals and tangents, or the target where
  // that is larger; infinity for others. Empty where the surface could not be measured.
  std::vector<double> everywhere;
};

// All `primitives` (one mesh or meshes that touch) on one lattice of positions. Bits are first found for each attribute
// at the vertices; but rounded positions slide along the surface and take texture and normals with them, so what is
// decoded is measured and bits are added, where they help most for their bytes, until it meets `error` (d_S, mesh
// units) and `targets` on 99 % of the surface. What cannot be measured (no area) is held to the errors at the vertices.
// Parameters as in SimplifyFamily. Fails with kUnsupported where no precision meets them, and like
// EncodeDracoPrimitive.
StatusOr<RoundedFamily> RoundFamily(const std::vector<const Primitive*>& primitives, double error,
                                    const AttributeTargets& targets, uint64_t texel_side,
                                    const TexelScale& texels_per_unit);

}  // namespace lacerta

#endif  // LACERTA_PACK_ROUNDED_H_
