// A family of primitives as one progressive stream that carries their attributes, a group of faces for each.
#ifndef LACERTA_PACK_FAMILY_STREAM_H_
#define LACERTA_PACK_FAMILY_STREAM_H_

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "document/draco_primitive.h"
#include "document/primitive.h"
#include "extension/progressive.h"
#include "lacerta/codec.h"
#include "lacerta/gltf.h"
#include "lacerta/status.h"
#include "pack/family_meter.h"
#include "pack/morph_channels.h"
#include "pack/source.h"

namespace lacerta {

struct FamilyStream {
  Bytes bytes;                      // the base section, a stock Draco stream per group, then the refinement
  std::vector<uint64_t> part_sizes; // base section, then one part per level; they add up to the bytes
  ProgressiveStream description;
  EncodeReport encode;
  struct Group {
    std::vector<DracoAttributeId> ids;
    Primitive base;  // what a stock decoder makes of its part of the base section
    std::vector<MorphTarget> targets;  // of the base, in plain glTF
  };
  std::vector<Group> groups;  // in the order of the meter's primitives
  std::vector<std::vector<AttributeReport>> reports;  // parallel
};

// The smallest stream found whose finest level meets the meter's targets and that takes fewer than most_bytes. Fails
// with kUnsupported, and the reason, where there is none: attributes that cannot be interpolated, too many seams, a
// shape of which a coarse base tells too little. morphs: whose meter this is, of a family with morph targets.
StatusOr<FamilyStream> StreamFamily(const FamilyMeter& meter, Effort effort,
                                    size_t most_bytes = std::numeric_limits<size_t>::max(),
                                    const MorphChannels* morphs = nullptr);

}  // namespace lacerta

#endif  // LACERTA_PACK_FAMILY_STREAM_H_
