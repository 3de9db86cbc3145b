// A family of primitives as one progressive stream that carries their attributes, a group of faces for each.
#ifndef LACERTA_PACK_FAMILY_STREAM_H_
#define LACERTA_PACK_FAMILY_STREAM_H_

#include <cstdint>
#include <vector>

#include "document/draco_primitive.h"
#include "document/primitive.h"
#include "extension/progressive.h"
#include "lacerta/gltf.h"
#include "lacerta/status.h"
#include "pack/family_meter.h"

namespace lacerta {

struct FamilyStream {
  Bytes bytes;                      // the base section, a stock Draco stream per group, then the refinement
  std::vector<uint64_t> part_sizes; // base section, then one part per level; they add up to the bytes
  ProgressiveStream description;
  struct Group {
    std::vector<DracoAttributeId> ids;
    Primitive base;  // what a stock decoder makes of its part of the base section
  };
  std::vector<Group> groups;  // in the order of the meter's primitives
  std::vector<std::vector<AttributeReport>> reports;  // parallel
};

struct FamilyStreamOptions {
  // Bytes that a simplified surface takes, and its triangles: where the coarsest base alone comes near that, no stream is
  // tried. 0: whatever it takes.
  uint64_t bytes_to_beat = 0;
  uint64_t triangles_to_beat = 0;
};

// The smallest stream found whose finest level meets the meter's targets, by some sizes of the base. Fails with
// kUnsupported, and the reason, where there is none: attributes that cannot be interpolated, too many seams, a shape of
// which a coarse base tells too little.
StatusOr<FamilyStream> StreamFamily(const FamilyMeter& meter, const FamilyStreamOptions& options);

}  // namespace lacerta

#endif  // LACERTA_PACK_FAMILY_STREAM_H_
