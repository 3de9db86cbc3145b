// Writing the refinement of a base mesh: header and one segment per level. Twin: decoder/stream_reader.h.
#ifndef LACERTA_ENCODER_STREAM_WRITER_H_
#define LACERTA_ENCODER_STREAM_WRITER_H_

#include <cstddef>
#include <vector>

#include "common/coefficient_sets.h"
#include "common/subdivision.h"
#include "encoder/attribute_quantizer.h"
#include "lacerta/decoder.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

struct RefinementBytes {
  Bytes bytes;
  // Header and segment of level 1, then the segments of levels 2, 3, ...: of no byte where no set is coded. They add up to bytes.size().
  std::vector<size_t> part_sizes;
};

// The base step in the header: left out where the base section tells it (compact bases).
enum class BaseStepField { kWritten, kLeftOut };

// What a refinement carries for an AttributedBase.
struct WrittenAttributes {
  uint16_t base_checksum = 0;  // of the AttributedBase
  std::vector<CodedAttribute> coded;
  std::vector<AttributeWedges> wedges;  // of level 0, one for each of `coded`
};

// Connectivity of the levels whose edges carry coefficients: levels 0 .. num_levels - 1. Fails with kInvalidData where
// the base cannot be refined (BuildTopology; more than 1,024 edges at a vertex) and with kInvalidArgument where
// num_levels is not 0..12 or the finest level would have 2^31 edges or more.
StatusOr<std::vector<Topology>> BuildTopologies(const BaseMesh& base, int num_levels, const BaseTags& tags = {});

// Writes a refinement.
//   base        its step as RoundStep returns it
//   topologies  of BuildTopologies(base, L, tags)
//   steps       L: quantization of levels 1..L, steps as RoundStep returns them
//   levels      L: coefficients; levels[i] has one entry per edge of topologies[i], magnitudes up to kMaxMagnitude, and
//   is
//               zero where its step is zero and at copies (Topology::is_copy)
//   tags        decoders take joined vertices from the lattice (FirstAtSamePoint in common/base_tags.h): that must join the
//               same borders as tags.joined
//   attributes  of an AttributedBase whose glued mesh `base` is, or null
// No level, no bytes. Fails with kInvalidArgument where an argument breaks these rules, and with kInvalidData where no triangle
// is to be split.
StatusOr<RefinementBytes> WriteRefinement(const BaseMesh& base, Span<const Topology> topologies,
                                          const std::vector<LevelSteps>& steps,
                                          const std::vector<QuantizedLevel>& levels, const BaseTags& tags = {},
                                          BaseStepField base_step = BaseStepField::kWritten, const WrittenAttributes* attributes = nullptr);

// The same, making the topologies itself.
StatusOr<RefinementBytes> WriteRefinement(const BaseMesh& base, const std::vector<LevelSteps>& steps,
                                          const std::vector<QuantizedLevel>& levels, const BaseTags& tags = {},
                                          BaseStepField base_step = BaseStepField::kWritten);

// Fails with kInvalidArgument where the coefficients of a level do not have the shapes and magnitudes that WriteRefinement tells.
Status CheckCoefficients(int level, const Topology& topology, const LevelSteps& steps, const QuantizedLevel& coefficients);

// The header of a refinement with quality layers, for the same arguments: steps and levels are those of the last layer.
StatusOr<Bytes> WriteLayeredHeader(const BaseMesh& base, Span<const Topology> topologies, const std::vector<LevelSteps>& steps,
                                   const std::vector<QuantizedLevel>& levels, const BaseTags& tags, BaseStepField base_step);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_STREAM_WRITER_H_
