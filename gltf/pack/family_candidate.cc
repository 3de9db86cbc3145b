#include "pack/family_candidate.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "geometry/value_difference.h"
#include "pack/morphs.h"
#include "pack/round_targets.h"
#include "pack/rounded.h"
#include "pack/simplified.h"
#include "pack/simplified_morphs.h"

namespace lacerta {
namespace {

uint64_t StoredBytes(const FamilyContext& context, const FamilyCandidate& candidate) {
  uint64_t sum = context.DracoJsonBytes();
  for (const DracoCandidate& member : candidate.members) {
    sum += member.encoded.bytes.size() + BytesOfTargets(member.targets);
  }
  return sum;
}

// targets: of each member in the order of its decoded vertices; empty: none has any.
FamilyCandidate ToCandidate(const FamilyContext& context, RoundedFamily rounded, std::vector<std::vector<MorphTarget>> targets) {
  FamilyCandidate candidate;
  for (size_t m = 0; m < rounded.members.size(); ++m) {
    DracoCandidate member;
    member.encoded = std::move(rounded.members[m]);
    if (!targets.empty()) member.targets = std::move(targets[m]);
    member.report.error = rounded.error;
    member.report.position_bits = rounded.precisions[m].positions.bits;
    member.report.attributes = std::move(rounded.reports[m]);
    candidate.members.push_back(std::move(member));
  }
  candidate.bytes = StoredBytes(context, candidate);
  return candidate;
}

// What the rounded surface leaves of its errors to its targets.
TargetTolerance ToleranceOf(const FamilyContext& context, const RoundedFamily& rounded) {
  double degrees = 0.0;
  for (const std::vector<AttributeReport>& reports : rounded.reports) {
    for (const AttributeReport& report : reports) degrees = std::max(degrees, report.unit == "degrees" ? report.error : 0.0);
  }
  return {std::min(RoomBeside(rounded.error, context.Error()), kShareOfOffsets * context.Error()),
          RoomBeside(degrees, context.options->attributes.normal_degrees) / kDegreesPerRadian};
}

// Fails with kUnsupported where morph targets cannot follow.
StatusOr<FamilyCandidate> ToCandidate(const FamilyContext& context, RoundedFamily rounded) {
  std::vector<std::vector<MorphTarget>> targets;
  const TargetTolerance tolerance = context.MayRoundTargets() ? ToleranceOf(context, rounded) : TargetTolerance();
  const std::vector<size_t>& members = context.members();
  for (size_t m = 0; m < members.size(); ++m) {
    const Source& source = context.scene->sources[members[m]];
    targets.emplace_back();
    if (source.targets.empty()) continue;
    auto reordered = ReorderTargets({&*source.primitive, &source.targets}, rounded.precisions[m], rounded.members[m].decoded);
    if (!reordered.has_value()) return Unsupported("has morph targets that tell apart what its other attributes do not");
    targets.back() = RoundTargets(std::move(*reordered), tolerance);
  }
  return ToCandidate(context, std::move(rounded), std::move(targets));
}

}  // namespace

StatusOr<FamilyCandidate> WithAllVertices(const FamilyContext& context, const FamilyMeter& meter, uint64_t most_bytes,
                                          std::vector<double>* everywhere) {
  // Vertices with other morph targets must not become one.
  Status following;  // of the last precision
  const auto targets_follow = [&](const RoundedFamily& rounded) {
    following = ToCandidate(context, rounded).status();
    return following.ok();
  };
  StatusOr<RoundedFamily> rounded = RoundFamily(meter.primitives(), meter, nullptr, {}, targets_follow, most_bytes);
  if (!rounded.ok()) return following.ok() ? rounded.status() : following;
  *everywhere = std::move(rounded.value().everywhere);
  return ToCandidate(context, std::move(rounded).value());
}

StatusOr<FamilyCandidate> Simplified(const FamilyContext& context, const FamilyMeter& meter, const std::vector<double>& everywhere) {
  const bool held = context.options->attributes.normals_everywhere;
  const std::vector<double> bounds = held ? everywhere : std::vector<double>();
  FamilyCandidate candidate;
  if (context.HasTargets()) {
    LACERTA_ASSIGN_OR_RETURN(MorphedFamily simplified,
                             SimplifyMorphedFamily(meter, context.Targets(), context.Mixes(), context.MayRoundTargets(), context.scene->texel_side, bounds));
    candidate = ToCandidate(context, std::move(simplified.rounded), std::move(simplified.targets));
  } else {
    LACERTA_ASSIGN_OR_RETURN(RoundedFamily simplified, SimplifyFamily(meter, bounds, context.options->encode.effort));
    candidate = ToCandidate(context, std::move(simplified), {});
  }
  for (size_t m = 0; m < candidate.members.size(); ++m) {
    candidate.members[m].report.reason =
        "simplified from " + std::to_string(meter.primitives()[m]->triangles.size()) + " to " +
        std::to_string(candidate.members[m].encoded.decoded.triangles.size()) + " triangles";
  }
  return candidate;
}

}  // namespace lacerta
