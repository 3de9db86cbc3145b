#include "decoder/stream_reader.h"

#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "common/crc32.h"
#include "decoder/byte_cursor.h"

namespace lacerta {
namespace {

LevelSteps ReadSteps(ByteCursor& cursor) {
  LevelSteps steps;
  const uint16_t normal = cursor.Word16(), tangential = cursor.Word16();
  steps.normal_step = StepFromBits(normal);
  steps.tangential_step = StepFromBits(tangential);
  if (normal != 0 || tangential != 0) {
    const uint8_t biases = cursor.Byte();
    steps.normal_bias = biases & 15;
    steps.tangential_bias = biases >> 4;
  }
  return steps;
}

bool IsStepOfStream(float step) { return step == 0.0f ? !std::signbit(step) : step > 0 && std::isnormal(step); }

}  // namespace

StatusOr<std::optional<ReadHeader>> ReadRefinementHeader(Span<const uint8_t> bytes) {
  using Result = std::optional<ReadHeader>;
  ByteCursor cursor(bytes);
  for (const uint8_t expected : kRefinementMagic) {
    const uint8_t byte = cursor.Byte();
    if (cursor.at_end()) return Result();
    if (byte != expected)
      return InvalidData("the bytes after the base mesh are not a Lacerta refinement (no \"LAC\" mark)");
  }
  const int version = cursor.Byte();
  if (cursor.at_end()) return Result();
  if (version != kRefinementVersion) {
    return Unsupported("refinement version " + std::to_string(version) + " is not known, this decoder reads version " +
                       std::to_string(kRefinementVersion) + "; a newer Lacerta may read it");
  }
  const int levels_and_layers = cursor.Byte();
  if (cursor.at_end()) return Result();
  const int num_levels = levels_and_layers & 0x0f, num_layers = levels_and_layers >> 4;
  if (num_layers != 1) return Unsupported(std::to_string(num_layers) + " quality layers per level; version 1 has one");
  if (num_levels < 1 || num_levels > kMaxLevels) {
    return InvalidData(std::to_string(num_levels) + " refinement levels; 1 to " + std::to_string(kMaxLevels) +
                       " are legal");
  }
  RefinementHeader header;
  header.num_base_vertices = cursor.Varint();
  header.num_base_triangles = cursor.Varint();
  const uint32_t step_bits = cursor.Word32();
  std::memcpy(&header.base_step, &step_bits, sizeof(step_bits));
  header.base_checksum = cursor.Word32();
  for (int level = 1; level <= num_levels; ++level) header.steps.push_back(ReadSteps(cursor));
  const uint32_t tags_size = cursor.Varint();
  if (!cursor.at_end() && tags_size > MaxTagBytes(header.num_base_vertices, header.num_base_triangles)) {
    return InvalidData("the refinement header is damaged (" + std::to_string(tags_size) + " bytes of tags)");
  }
  const Span<const uint8_t> tags = cursor.Take(tags_size);
  const size_t checked_size = cursor.position();
  const uint16_t checksum = cursor.Word16();
  if (cursor.at_end()) return Result();
  Crc32 crc;
  crc.Add(bytes.First(checked_size));
  if (crc.low16() != checksum) return InvalidData("the refinement header is damaged (checksum mismatch)");
  header.tags.assign(tags.begin(), tags.end());
  if (cursor.malformed()) return InvalidData("a count in the refinement header exceeds 32 bits");
  if (!(header.base_step > 0) || !std::isnormal(header.base_step)) {
    return InvalidData("the base step in the refinement header is not a positive number");
  }
  for (const LevelSteps& s : header.steps) {
    if (IsStepOfStream(s.normal_step) && IsStepOfStream(s.tangential_step)) continue;
    return InvalidData("a quantization step in the refinement header is not a positive number");
  }
  return Result(ReadHeader{std::move(header), cursor.position()});
}

StatusOr<std::optional<ReadSegment>> ReadRefinementSegment(Span<const uint8_t> bytes, int level) {
  using Result = std::optional<ReadSegment>;
  ByteCursor cursor(bytes);
  const uint32_t length = cursor.Varint();
  const uint16_t checksum = cursor.Word16();
  if (cursor.malformed())
    return InvalidData("the length of the segment of level " + std::to_string(level) + " exceeds 32 bits");
  if (cursor.at_end() || bytes.size() - cursor.position() < length) return Result();
  const Span<const uint8_t> payload = bytes.Subspan(cursor.position()).First(length);
  if (SegmentChecksum(level, payload) != checksum) {
    return InvalidData("the segment of level " + std::to_string(level) + " is damaged (checksum mismatch)");
  }
  return Result(ReadSegment{payload, cursor.position() + length});
}

}  // namespace lacerta
