#include "pack/simplified_morphs.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "pack/round_targets.h"
#include "pack/simplified.h"

namespace lacerta {
namespace {

// Numbers of the plain meter's attributes for those of the one with targets.
std::vector<double> BoundsFor(const FamilyMeter& plain, const FamilyMeter& morphed, const std::vector<double>& bounds) {
  if (bounds.empty()) return {};
  std::vector<double> result;
  for (const MeshAttribute& attribute : morphed.original().attributes) {
    const std::optional<size_t> index = plain.IndexOf(attribute.name);
    result.push_back(index.has_value() ? bounds[*index] : std::numeric_limits<double>::infinity());
  }
  return result;
}

SurfaceErrors ErrorsOf(const FamilyMeter& plain, const FamilyMeter& morphed, SurfaceErrors errors) {
  std::vector<AttributeError> kept(plain.original().attributes.size());
  for (size_t a = 0; a < errors.attributes.size(); ++a) {
    const std::optional<size_t> index = plain.IndexOf(morphed.original().attributes[a].name);
    if (index.has_value()) kept[*index] = errors.attributes[a];
  }
  errors.attributes = std::move(kept);
  return errors;
}

// What the errors of the simplified surface leave to directions; positions are measured again once they are rounded.
TargetTolerance ToleranceOf(const FamilyMeter& morphed, const SurfaceErrors& errors) {
  TargetTolerance tolerance{kShareOfOffsets * morphed.error(), std::numeric_limits<double>::infinity()};
  for (size_t a = 0; a < errors.attributes.size(); ++a) {
    const std::string& name = morphed.original().attributes[a].name;
    if (!IsTargetAttribute(name) || IsTargetPosition(name)) continue;
    tolerance.directions = std::min(tolerance.directions, RoomBeside(errors.attributes[a].rms_99, morphed.targets().attributes[a]));
  }
  return tolerance;
}

}  // namespace

StatusOr<MorphedFamily> SimplifyMorphedFamily(const FamilyMeter& meter,
                                              const std::vector<const std::vector<MorphTarget>*>& targets,
                                              const std::vector<TargetMix>& mixes, bool round_targets, uint64_t texel_side,
                                              const std::vector<double>& everywhere) {
  constexpr double kNothing = 0.01;  // of the error: offsets below are none
  LACERTA_RETURN_IF_ERROR(meter.status());
  std::vector<Primitive> with_targets;
  std::vector<MorphedPrimitive> originals;
  for (size_t m = 0; m < targets.size(); ++m) {
    LACERTA_ASSIGN_OR_RETURN(Primitive primitive, WithTargets(*meter.primitives()[m], *targets[m]));
    with_targets.push_back(std::move(primitive));
    originals.push_back({meter.primitives()[m], targets[m]});
  }
  const FamilyMeter morphed(PointersTo(with_targets), meter.error(), meter.attribute_targets(), texel_side,
                            meter.texels_per_unit(), meter.skin());
  LACERTA_ASSIGN_OR_RETURN(const MorphMeter morph_meter, MorphMeter::Create(originals, mixes));
  MorphedFamily result;
  const auto round = [&](SimplifiedFamily simplified) -> StatusOr<RoundedFamily> {
    const TargetTolerance tolerance = round_targets ? ToleranceOf(morphed, simplified.errors) : TargetTolerance();
    std::vector<std::vector<MorphTarget>> simplified_targets;
    for (size_t m = 0; m < targets.size(); ++m) {
      simplified_targets.push_back(RoundTargets(TakeTargets(*targets[m], kNothing * meter.error(), &simplified.primitives[m]), tolerance));
    }
    const auto order_targets = [&](const RoundedFamily& rounded) {
      result.targets.clear();
      for (size_t m = 0; m < targets.size(); ++m) {
        auto reordered = ReorderTargets({&simplified.primitives[m], &simplified_targets[m]}, rounded.precisions[m],
                                        rounded.members[m].decoded);
        if (!reordered.has_value()) return false;
        result.targets.push_back(std::move(*reordered));
      }
      return true;
    };
    const auto takes_targets = [&](const RoundedFamily& rounded) {
      if (!order_targets(rounded)) return false;
      std::vector<MorphedPrimitive> stored;
      for (size_t m = 0; m < targets.size(); ++m) stored.push_back({&rounded.members[m].decoded, &result.targets[m]});
      const StatusOr<bool> are_within = morph_meter.AreWithin(meter.error(), stored);
      return are_within.ok() && are_within.value();
    };
    const SurfaceErrors errors = ErrorsOf(meter, morphed, std::move(simplified.errors));
    StatusOr<RoundedFamily> rounded = RoundFamily(PointersTo(simplified.primitives), meter, &errors, everywhere, takes_targets);
    if (rounded.ok() && !order_targets(rounded.value())) return InternalError("the morph targets do not follow what was measured");
    return rounded;
  };
  LACERTA_ASSIGN_OR_RETURN(result.rounded, SimplifyAndRound(morphed, BoundsFor(meter, morphed, everywhere), round));
  return result;
}

}  // namespace lacerta
