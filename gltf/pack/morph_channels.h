// A family with morph targets as streams carry them: attributes with three components for every target, held to what
// each of them shows at weight 1, and to the mixes of them that the asset shows.
#ifndef LACERTA_PACK_MORPH_CHANNELS_H_
#define LACERTA_PACK_MORPH_CHANNELS_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "document/primitive.h"
#include "lacerta/attributed_base.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/status.h"
#include "pack/family_meter.h"
#include "pack/morphs.h"
#include "pack/round_targets.h"
#include "pack/source.h"

namespace lacerta {

class MorphChannels {
 public:
  // targets: of each of the meter's primitives; those without are left alone. mixes: to be looked at besides. Refers to nothing of
  // the meter but its skin. Fails with kUnsupported where parts have unlike numbers of targets, or other attributes than POSITION, NORMAL
  // and TANGENT or too many, and like FamilyMeter.
  static StatusOr<MorphChannels> Create(const FamilyMeter& plain,
                                        const std::vector<const std::vector<MorphTarget>*>& targets,
                                        const std::vector<TargetMix>& mixes, bool round_targets, uint64_t texel_side);

  // Of the primitives with their targets as further attributes (extension/target_channels.h).
  const FamilyMeter& meter() const { return *meter_; }

  // Sets the errors of targets in a surface with the meter's attributes: of positions d_S from the original with one target at weight 1,
  // or in a mix that they have part in, where that is largest, mesh units; of directions that of the target which is farthest off.
  Status Measure(const AttributedMesh& mesh, uint64_t num_samples, SurfaceErrors* errors) const;

  // What the primitives of the base have as targets in plain glTF, for each group: offsets of positions up to the
  // meter's error are 0, which takes less and which no base shows, and all are rounded (RoundTargets) if asked.
  std::vector<std::vector<MorphTarget>> PlainTargets(const AttributedBase& base) const;
  uint64_t BytesOfPlainTargets(const AttributedBase& base) const;

 private:
  MorphChannels() = default;

  TargetTolerance tolerance_;          // of plain targets
  std::vector<Primitive> primitives_;  // what meter_ refers to
  std::unique_ptr<const FamilyMeter> meter_;
  std::optional<MorphMeter> positions_;
  std::optional<SurfaceErrorMeter> directions_;  // an attribute for each target
};

}  // namespace lacerta

#endif  // LACERTA_PACK_MORPH_CHANNELS_H_
