#include "pack/family_context.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pack/find_skin.h"

namespace lacerta {
namespace {

constexpr double kDefaultPsnr = 70.0;

bool HasJoints(const Source& source) {
  const std::vector<Attribute>& attributes = source.primitive->attributes;
  return std::any_of(attributes.begin(), attributes.end(), [](const Attribute& a) { return IsSkinAttribute(a.name); });
}

}  // namespace

double TargetPsnr(const EncodeTarget& target) {
  switch (target.kind) {
    case EncodeTarget::Kind::kPsnr:
      return target.value;
    case EncodeTarget::Kind::kError:
      return -20.0 * std::log10(target.value);
    case EncodeTarget::Kind::kBytes:
    case EncodeTarget::Kind::kBitsPerVertex:
    case EncodeTarget::Kind::kDistance:  // a share of the scene by now
      break;
  }
  return kDefaultPsnr;
}

std::vector<const Primitive*> FamilyContext::Primitives() const {
  std::vector<const Primitive*> primitives;
  for (const size_t member : members()) primitives.push_back(&*scene->sources[member].primitive);
  return primitives;
}

bool FamilyContext::HasTargets() const {
  return std::any_of(members().begin(), members().end(), [&](size_t member) { return !scene->sources[member].targets.empty(); });
}

std::vector<const std::vector<MorphTarget>*> FamilyContext::Targets() const {
  std::vector<const std::vector<MorphTarget>*> targets;
  for (const size_t member : members()) targets.push_back(&scene->sources[member].targets);
  return targets;
}

std::vector<const Source*> FamilyContext::Sources() const {
  std::vector<const Source*> sources;
  for (const size_t member : members()) sources.push_back(&scene->sources[member]);
  return sources;
}

std::vector<TargetMix> FamilyContext::Mixes() const {
  size_t num_targets = 0;
  for (const std::vector<MorphTarget>* targets : Targets()) num_targets = std::max(num_targets, targets->size());
  return FindTargetMixes(*scene->document, scene->weight_tracks, Sources(), num_targets);
}

StatusOr<std::optional<Skin>> FamilyContext::FindSkin() const {
  const std::vector<const Source*> sources = Sources();
  if (std::none_of(sources.begin(), sources.end(), [](const Source* source) { return HasJoints(*source); })) return std::optional<Skin>();
  LACERTA_ASSIGN_OR_RETURN(Skin skin, lacerta::FindSkin(*scene->document, sources, scene->poses));
  return std::optional<Skin>(std::move(skin));
}

TexelScale FamilyContext::Scale() const {
  std::vector<PlacedPrimitive> placed;
  for (const Source* source : Sources()) placed.push_back({&source->places, &*source->primitive});
  return TexelScaleOf(*scene->document, placed, scene->texel_side);
}

uint64_t FamilyContext::BytesBefore() const {
  uint64_t sum = 0;
  for (const size_t member : members()) {
    const Source& source = scene->sources[member];
    const uint64_t stored = source.geometries.size() * source.stored_bytes;
    sum += stored - std::min(stored, source.held_bytes);
  }
  return sum;
}

uint64_t FamilyContext::DracoJsonBytes() const {
  constexpr uint64_t kFirstPlace = 150, kFurtherPlace = 100;
  uint64_t sum = 0;
  for (const size_t member : members()) sum += kFirstPlace + kFurtherPlace * (scene->sources[member].places.size() - 1);
  return sum;
}

uint64_t FamilyContext::ProgressiveJsonBytes() const {
  constexpr uint64_t kStream = 350, kFurtherPlace = 50;
  uint64_t sum = kStream;
  for (const size_t member : members()) sum += kFurtherPlace * (scene->sources[member].places.size() - 1);
  return sum;
}

}  // namespace lacerta
