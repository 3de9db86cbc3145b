#include "fuzz/structured_input.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "common/crc16.h"
#include "common/stream_layout.h"
#include "decoder/byte_cursor.h"
#include "decoder/stream_reader.h"
#include "encoder/byte_writer.h"
#include "lacerta/decoder.h"

namespace lacerta::fuzz {
namespace {

// The head of a custom form without metadata whose base is compact (docs/format.md).
constexpr std::array<uint8_t, 12> kCompactHead = {'D', 'R', 'A', 'C', 'O', 2, 2, 1, 'L', 0, 0, 0x11};
constexpr size_t kChecksumSize = 2, kFlagsOffset = 4;

Bytes Copied(Span<const uint8_t> bytes) { return Bytes(bytes.begin(), bytes.end()); }

void Append(Span<const uint8_t> more, Bytes* bytes) { bytes->insert(bytes->end(), more.begin(), more.end()); }

// Moves the compact base at the end of `before` to where it belongs, if there is one.
void SplitCompactBase(StructuredInput* input) {
  Bytes& before = input->before;
  const auto head = std::search(before.begin(), before.end(), kCompactHead.begin(), kCompactHead.end());
  if (head == before.end()) return;
  const auto length_at = head + kCompactHead.size();
  ByteCursor cursor(Span<const uint8_t>(before).Subspan(static_cast<size_t>(length_at - before.begin())));
  if (cursor.Varint() != cursor.Rest().size()) return;
  input->has_compact_base = true;
  input->compact_base = Copied(cursor.Rest());
  before.erase(length_at, before.end());
}

// Levels of the segments of a stream without layers, in order.
std::vector<int> LevelsWithSegments(const RefinementHeader* header) {
  std::vector<int> levels;
  for (int i = 0; i < kMaxLevels; ++i) {
    const auto level = static_cast<size_t>(i);
    if (header == nullptr || (level < header->steps.size() && !header->IsSilent(level))) levels.push_back(i + 1);
  }
  return levels;
}

void SplitSegments(const RefinementHeader& header, Span<const uint8_t> rest, StructuredInput* input) {
  const auto take = [&](uint8_t what, const auto& read) {
    if (!read.ok() || !read.value()) return false;
    input->segments.push_back({what, Copied(read.value()->payload)});
    rest = rest.Subspan(read.value()->size);
    return true;
  };
  if (header.has_layers) {
    while (!rest.empty() && take(rest[0], ReadLayerSegment(rest))) {
    }
  } else {
    const std::vector<int> levels = LevelsWithSegments(&header);
    for (size_t i = 0; i < levels.size() && take(static_cast<uint8_t>(levels[i]), ReadRefinementSegment(rest, levels[i])); ++i) {
    }
  }
  input->after = Copied(rest);
}

// Writes the checksum of a compact base into the header of its refinement.
void SetBaseChecksum(Span<const uint8_t> compact_base, Bytes* header) {
  const size_t offset = kFlagsOffset + 1 + ((*header)[kFlagsOffset] & kHasBaseStep ? 2 : 0);
  if (header->size() < offset + 2) return;
  const StatusOr<CompactBase> base = DecodeCompactBase(compact_base, {3000, 6000});
  if (!base.ok()) return;
  const uint16_t checksum = BaseChecksum(base.value().mesh);
  (*header)[offset] = static_cast<uint8_t>(checksum);
  (*header)[offset + 1] = static_cast<uint8_t>(checksum >> 8);
}

}  // namespace

std::optional<StructuredInput> StructuredInput::Parse(Span<const uint8_t> input) {
  auto mark = input.begin();
  while ((mark = std::search(mark, input.end(), kRefinementMagic.begin(), kRefinementMagic.end())) != input.end()) {
    const auto begin = static_cast<size_t>(mark - input.begin());
    const Span<const uint8_t> refinement = input.Subspan(begin);
    const auto read = ReadRefinementHeader(refinement);
    if (read.ok() && read.value()) {
      StructuredInput result;
      result.before = Copied(input.First(begin));
      result.header = Copied(refinement.First(read.value()->size - kChecksumSize));
      SplitCompactBase(&result);
      SplitSegments(read.value()->header, refinement.Subspan(read.value()->size), &result);
      return result;
    }
    ++mark;
  }
  return std::nullopt;
}

Bytes StructuredInput::Join() const {
  Bytes bytes = before;
  if (has_compact_base) {
    PutVarint(compact_base.size(), &bytes);
    Append(compact_base, &bytes);
  }
  Bytes head = header;
  if (has_compact_base && head.size() > kFlagsOffset) SetBaseChecksum(compact_base, &head);
  Crc16 crc;
  crc.Add(head);
  PutWord16(crc.value(), &head);
  Append(head, &bytes);

  const auto read = ReadRefinementHeader(head);
  const RefinementHeader* readable = read.ok() && read.value() ? &read.value()->header : nullptr;
  const bool has_layers = readable != nullptr && readable->has_layers;
  const std::vector<int> levels = LevelsWithSegments(readable);
  for (size_t i = 0; i < segments.size() && (has_layers || i < levels.size()); ++i) {
    const auto& [what, payload] = segments[i];
    if (has_layers) bytes.push_back(what);
    PutVarint(payload.size(), &bytes);
    PutWord16(SegmentChecksum(has_layers ? what : levels[i], payload), &bytes);
    Append(payload, &bytes);
  }
  Append(after, &bytes);
  return bytes;
}

}  // namespace lacerta::fuzz
