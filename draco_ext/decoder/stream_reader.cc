#include "decoder/stream_reader.h"

#include <algorithm>
#include <string>
#include <utility>

#include "common/crc16.h"
#include "common/octahedral.h"
#include "common/step_forecast.h"
#include "decoder/byte_cursor.h"

namespace lacerta {
namespace {

// Reads the steps of all levels. Returns what is wrong with them: the header may still end early or have a wrong checksum,
// which is told first.
Status ReadSteps(int num_levels, ByteCursor* cursor, std::vector<LevelSteps>* steps) {
  Bytes flags;
  for (int i = 0; i < num_levels; i += 2) {
    const uint8_t two = cursor->Byte();
    flags.push_back(two & 15);
    flags.push_back(two >> 4);
  }
  bool is_sound = true;
  int normal_bits = cursor->Word16();
  const auto check = [&](int64_t bits) {
    if (IsStepBits(bits)) return static_cast<int>(bits);
    is_sound = false;
    return kLeastStepBits;
  };
  normal_bits = check(normal_bits);
  for (int i = 0; i < num_levels; ++i) {
    const uint8_t f = flags[static_cast<size_t>(i)];
    const auto difference = [&] { return (f & kHasDifferences) != 0 ? int64_t{cursor->SignedVarint()} : 0; };
    LevelSteps s;
    if ((f & kCodesNormal) != 0) {
      normal_bits = check(normal_bits + difference());
      s.normal_step = StepFromBits(static_cast<uint16_t>(normal_bits));
    }
    if ((f & kCodesTangential) != 0)
      s.tangential_step = StepFromBits(static_cast<uint16_t>(check(TangentialStepBits(normal_bits) + difference())));
    if ((f & kHasBiases) != 0) {
      const uint8_t biases = cursor->Byte();
      s.normal_bias = biases & 15;
      s.tangential_bias = biases >> 4;
    }
    steps->push_back(s);
    normal_bits = NextStepBits(normal_bits);
  }
  if (!is_sound) return InvalidData("a quantization step in the refinement header is not a positive number");
  const auto is_without_use = [](uint8_t f) { return f != 0 && (f & (kCodesNormal | kCodesTangential)) == 0; };
  if ((num_levels % 2 == 0 || flags.back() == 0) && std::none_of(flags.begin(), flags.end(), is_without_use)) return Status();
  return InvalidData("a level in the refinement header has flags, but no coefficients");
}

// Reads the attributes. Returns what is wrong with them, as ReadSteps does.
Status ReadAttributes(size_t num_levels, ByteCursor* cursor, std::vector<AttributeHeader>* attributes) {
  const uint32_t count = cursor->Varint();
  uint64_t num_components = 0;
  for (uint32_t i = 0; i < count && !cursor->at_end(); ++i) {
    AttributeHeader a;
    const uint8_t kind = cursor->Byte(), flags = cursor->Byte(), prediction = flags & ~kChainedFlag;
    a.precision.components = cursor->Varint();
    num_components += a.precision.components;
    const Span<const uint8_t> name = cursor->Take(cursor->Byte());
    a.precision.name.assign(name.begin(), name.end());
    if (kind > kLastAttributeKind) return InvalidData("an attribute in the refinement header is of unknown kind");
    a.precision.kind = static_cast<AttributeKind>(kind);
    const bool is_normal = a.precision.kind == AttributeKind::kNormal;
    if (!HasLegalComponents(a.precision) || num_components > kMostComponents)
      return InvalidData("an attribute in the refinement header has a number of components that is not legal");
    a.is_chained = (flags & kChainedFlag) != 0;
    if ((a.is_chained && !HasChain(a.precision)) || prediction > static_cast<uint8_t>(AttributePrediction::kGeometry) ||
        (!is_normal && prediction == static_cast<uint8_t>(AttributePrediction::kGeometry)))
      return InvalidData("an attribute in the refinement header has an unknown prediction");
    a.prediction = static_cast<AttributePrediction>(prediction);
    if (is_normal) {
      a.precision.octahedral_bits = cursor->Byte();
      if (a.precision.octahedral_bits < kLeastOctahedralBits || a.precision.octahedral_bits > kMostOctahedralBits)
        return InvalidData("the normals in the refinement header have a number of bits that is not legal");
    } else {
      const uint16_t step = cursor->Word16();
      if (!IsStepBits(step)) return InvalidData("the base step of an attribute in the refinement header is not a positive number");
      a.precision.step = StepFromBits(step);
    }
    const uint32_t coded_levels = cursor->Varint();
    if (coded_levels >> num_levels != 0) return InvalidData("an attribute in the refinement header has more levels than the mesh");
    a.steps.assign(num_levels, 0.0f);
    int64_t bits = kFirstAttributeStepBits;
    for (size_t level = 0; level < num_levels; ++level) {
      if ((coded_levels >> level & 1) == 0) continue;
      bits += cursor->SignedVarint();
      if (!IsStepBits(bits)) return InvalidData("a step of an attribute in the refinement header is not a positive number");
      a.steps[level] = StepFromBits(static_cast<uint16_t>(bits));
    }
    attributes->push_back(std::move(a));
  }
  return Status();
}

// A length, a checksum and so many bytes. what: as in SegmentChecksum; level: for messages.
StatusOr<std::optional<ReadSegment>> ReadChecked(Span<const uint8_t> bytes, int what, int level) {
  using Result = std::optional<ReadSegment>;
  ByteCursor cursor(bytes);
  const uint32_t length = cursor.Varint();
  const uint16_t checksum = cursor.Word16();
  if (cursor.malformed())
    return InvalidData("the length of the segment of level " + std::to_string(level) + " exceeds 32 bits");
  if (cursor.at_end() || bytes.size() - cursor.position() < length) return Result();
  const Span<const uint8_t> payload = bytes.Subspan(cursor.position()).First(length);
  if (SegmentChecksum(what, payload) != checksum) {
    return InvalidData("the segment of level " + std::to_string(level) + " is damaged (checksum mismatch)");
  }
  return Result(ReadSegment{payload, cursor.position() + length});
}

}  // namespace

StatusOr<std::optional<ReadHeader>> ReadRefinementHeader(Span<const uint8_t> bytes, uint64_t max_tag_bytes) {
  using Result = std::optional<ReadHeader>;
  ByteCursor cursor(bytes);
  for (const uint8_t expected : kRefinementMagic) {
    const uint8_t byte = cursor.Byte();
    if (cursor.at_end()) return Result();
    if (byte != expected)
      return InvalidData("the bytes after the base mesh are not a Lacerta refinement (no \"LAC\" mark)");
  }
  const int version_and_curves = cursor.Byte();
  if (cursor.at_end()) return Result();
  const int version = version_and_curves & 0x0f, num_curved = version_and_curves >> 4;
  if (version != kRefinementVersion) {
    return Unsupported("refinement version " + std::to_string(version) + " is not known, this decoder reads version " +
                       std::to_string(kRefinementVersion) + "; a newer Lacerta may read it");
  }
  const int levels_and_flags = cursor.Byte();
  if (cursor.at_end()) return Result();
  const int num_levels = levels_and_flags & 0x0f;
  if (num_levels < 1 || num_levels > kMaxLevels) {
    return InvalidData(std::to_string(num_levels) + " refinement levels; 1 to " + std::to_string(kMaxLevels) +
                       " are legal");
  }
  if (num_curved > num_levels) return InvalidData(std::to_string(num_curved) + " curved levels of " + std::to_string(num_levels));
  RefinementHeader header;
  const bool has_base_step = (levels_and_flags & kHasBaseStep) != 0, has_tags = (levels_and_flags & kHasTags) != 0;
  header.has_layers = (levels_and_flags & kHasLayers) != 0;
  const uint16_t base_step_bits = has_base_step ? cursor.Word16() : uint16_t{0};
  header.base_checksum = cursor.Word16();
  const Status read_steps = ReadSteps(num_levels, &cursor, &header.steps);
  const uint32_t tags_size = has_tags ? cursor.Varint() : 0;
  if (!cursor.at_end() && (tags_size > max_tag_bytes || (has_tags && tags_size == 0))) {
    return InvalidData("the refinement header is damaged (" + std::to_string(tags_size) + " bytes of tags)");
  }
  const Span<const uint8_t> tags = cursor.Take(tags_size);
  header.is_attributed = (levels_and_flags & kHasAttributes) != 0;
  if (header.is_attributed && header.has_layers) return Unsupported("a refinement with quality layers cannot have attributes");
  if (header.is_attributed) {
    const Status read_attributes = ReadAttributes(static_cast<size_t>(num_levels), &cursor, &header.attributes);
    if (!cursor.at_end()) LACERTA_RETURN_IF_ERROR(read_attributes);
  }
  const size_t checked_size = cursor.position();
  const uint16_t checksum = cursor.Word16();
  if (cursor.at_end()) return Result();
  Crc16 crc;
  crc.Add(bytes.First(checked_size));
  if (crc.value() != checksum) return InvalidData("the refinement header is damaged (checksum mismatch)");
  header.tags.assign(tags.begin(), tags.end());
  if (cursor.malformed()) return InvalidData("a number in the refinement header exceeds 32 bits");
  if (has_base_step && !IsStepBits(base_step_bits)) return InvalidData("the base step in the refinement header is not a positive number");
  header.base_step = StepFromBits(base_step_bits);
  for (int i = 0; i < num_curved; ++i) header.steps[static_cast<size_t>(i)].is_curved = true;
  LACERTA_RETURN_IF_ERROR(read_steps);
  return Result(ReadHeader{std::move(header), cursor.position()});
}

StatusOr<std::optional<ReadSegment>> ReadRefinementSegment(Span<const uint8_t> bytes, int level) {
  return ReadChecked(bytes, level, level);
}

StatusOr<std::optional<ReadLayer>> ReadLayerSegment(Span<const uint8_t> bytes) {
  using Result = std::optional<ReadLayer>;
  if (bytes.empty()) return Result();
  const LayerSegment segment = LayerSegmentFromByte(bytes[0]);
  LACERTA_ASSIGN_OR_RETURN(const std::optional<ReadSegment> read, ReadChecked(bytes.Subspan(1), bytes[0], segment.level));
  if (!read) return Result();
  return Result(ReadLayer{segment, read->payload, read->size + 1});
}

}  // namespace lacerta
