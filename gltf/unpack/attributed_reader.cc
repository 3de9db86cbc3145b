#include "unpack/attributed_reader.h"

#include <algorithm>

#include "draco/attributed_base_codec.h"
#include "lacerta/attributed_base.h"
#include "lacerta/decoder.h"

namespace lacerta {
namespace {

// Vertices and triangles of all groups have to be those that the asset announces for the level.
Status CheckCounts(const ProgressiveStream& announced, const AttributedLevel& decoded) {
  uint64_t vertices = 0;
  uint64_t triangles = 0;
  for (const VertexSoup& group : decoded.groups) {
    vertices += group.positions.size();
    triangles += group.triangles.size();
  }
  const auto level = static_cast<size_t>(decoded.level);
  if (level >= announced.vertex_counts.size() || announced.vertex_counts[level] != vertices ||
      announced.triangle_counts[level] != triangles) {
    return InvalidData("level " + std::to_string(decoded.level) + " of the stream does not have the size that the asset announces");
  }
  return Status();
}

// Names and kinds as the refinement tells them; the asset has to say the same.
Status CheckAttributes(const ProgressiveStream& announced, const RefinementInfo& info) {
  const auto same = [](const std::string& name, const AttributeLattice& attribute) { return name == attribute.name; };
  if (!info.is_attributed || announced.attributes.size() != info.attributes.size() ||
      !std::equal(announced.attributes.begin(), announced.attributes.end(), info.attributes.begin(), same)) {
    return InvalidData("the stream does not carry the attributes that the asset announces");
  }
  return Status();
}

// Values as streams carry them become what glTF says.
Status ToGltf(const ProgressiveStream& announced, AttributedLevel* level) {
  for (VertexSoup& group : level->groups) {
    GatherWeights(announced.joints, &group);
    LACERTA_ASSIGN_OR_RETURN(SoupTargets targets, TakeTargetChannels(&group));
    level->targets.push_back(std::move(targets));
  }
  return Status();
}

// The bases alone, where nothing is there to tell their lattices: what is not in a group is left out.
StatusOr<std::vector<VertexSoup>> DecodeBases(const std::vector<Span<const uint8_t>>& parts,
                                              const ProgressiveStream& announced, const DecodeLimits& limits) {
  std::vector<VertexSoup> bases;
  for (const Span<const uint8_t> part : parts) {
    LACERTA_ASSIGN_OR_RETURN(VertexSoup base,
                             DecodeAttributedGroup(part, announced.attributes, limits, announced.joints));
    bases.push_back(std::move(base));
  }
  return bases;
}

}  // namespace

std::vector<Span<const uint8_t>> BaseParts(const GatheredStream& stream, const ProgressiveStream& announced) {
  std::vector<Span<const uint8_t>> parts;
  uint64_t offset = 0;
  for (const uint64_t length : announced.base_lengths) {
    const uint64_t begin = std::min<uint64_t>(offset, stream.bytes.size());
    const uint64_t end = std::min<uint64_t>(begin + length, stream.bytes.size());
    parts.emplace_back(stream.bytes.data() + begin, static_cast<size_t>(end - begin));
    offset += length;
  }
  return parts;
}

StatusOr<AttributedLevel> DecodeAttributedLevel(const GatheredStream& stream, const ProgressiveStream& announced,
                                                const UnpackOptions& options) {
  const Span<const uint8_t> refinement =
      Span<const uint8_t>(stream.bytes).Subspan(static_cast<size_t>(std::min<uint64_t>(stream.base_length, stream.bytes.size())));
  if (refinement.empty()) {
    AttributedLevel bases;
    LACERTA_ASSIGN_OR_RETURN(bases.groups, DecodeBases(BaseParts(stream, announced), announced, options.limits));
    bases.is_complete = announced.vertex_counts.size() == 1;
    LACERTA_RETURN_IF_ERROR(CheckCounts(announced, bases));
    LACERTA_RETURN_IF_ERROR(ToGltf(announced, &bases));
    return bases;
  }
  LACERTA_ASSIGN_OR_RETURN(const RefinementInfo info, ReadRefinementInfo(refinement));
  LACERTA_RETURN_IF_ERROR(CheckAttributes(announced, info));
  std::vector<VertexSoup> bases;
  for (const Span<const uint8_t> part : BaseParts(stream, announced)) {
    LACERTA_ASSIGN_OR_RETURN(VertexSoup base,
                             DecodeAttributedGroup(part, info.attributes, options.limits, announced.joints));
    bases.push_back(std::move(base));
  }
  LACERTA_ASSIGN_OR_RETURN(const AttributedBase base, AttributedBaseFromSoups(bases, info.base_step, info.attributes));
  AttributedLevel result;
  RefinementOptions decode;
  decode.max_level = options.level;
  decode.limits = options.limits;
  LACERTA_ASSIGN_OR_RETURN(ProgressiveDecoder decoder, ProgressiveDecoder::Create(base, decode));
  result.refinement = decoder.Append(refinement);
  result.is_complete = decoder.is_complete();
  result.level = decoder.level();
  if (result.level == 0) {
    result.groups = std::move(bases);
  } else {
    const AttributedSemiRegularMesh mesh = std::move(decoder).TakeAttributed();
    LACERTA_ASSIGN_OR_RETURN(const AttributedMesh level, AttributedMeshAtLevel(mesh, result.level));
    result.groups = SplitIntoSoups(level, static_cast<uint32_t>(bases.size()));
  }
  LACERTA_RETURN_IF_ERROR(CheckCounts(announced, result));
  LACERTA_RETURN_IF_ERROR(ToGltf(announced, &result));
  return result;
}

const StatusOr<AttributedLevel>& AttributedCache::Get(uint64_t index, const GatheredStream& stream,
                                                      const ProgressiveStream& announced, const UnpackOptions& options) {
  const auto known = levels_.find(index);
  if (known != levels_.end()) return known->second;
  return levels_.emplace(index, DecodeAttributedLevel(stream, announced, options)).first->second;
}

}  // namespace lacerta
