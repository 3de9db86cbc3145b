#include "base_section.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "common/base_tags_coding.h"
#include "common/stream_layout.h"
#include "decoder/byte_cursor.h"
#include "decoder/stream_reader.h"

namespace lacerta {
namespace {

constexpr std::array<uint8_t, 5> kDracoMark = {'D', 'R', 'A', 'C', 'O'};
constexpr size_t kMethodOffset = 8, kFlagsOffset = 9, kHeaderSize = 11;
constexpr uint8_t kCustomMethod = 'L', kCustomVersion = 1;
constexpr uint8_t kHasMetadata = 0x80;  // of the upper byte of the flags
constexpr int kMaxMetadataDepth = 64;

void SkipName(ByteCursor* cursor) { cursor->Take(cursor->Byte()); }

// Draco's metadata: names with values, and named metadata within it. False: nested too deeply.
bool SkipMetadata(int depth, ByteCursor* cursor) {
  if (depth == kMaxMetadataDepth) return false;
  for (uint32_t entries = cursor->Varint(); entries > 0 && !cursor->at_end(); --entries) {
    SkipName(cursor);
    cursor->Take(cursor->Varint());
  }
  for (uint32_t children = cursor->Varint(); children > 0 && !cursor->at_end(); --children) {
    SkipName(cursor);
    if (!SkipMetadata(depth + 1, cursor)) return false;
  }
  return true;
}

bool SkipGeometryMetadata(ByteCursor* cursor) {
  for (uint32_t attributes = cursor->Varint(); attributes > 0 && !cursor->at_end(); --attributes) {
    cursor->Varint();  // the attribute's number
    if (!SkipMetadata(0, cursor)) return false;
  }
  return SkipMetadata(0, cursor);
}

StatusOr<std::optional<BaseSection>> FindCustomBase(Span<const uint8_t> bytes) {
  ByteCursor cursor(bytes);
  cursor.Take(kHeaderSize);
  if ((bytes[kFlagsOffset + 1] & kHasMetadata) != 0 && !SkipGeometryMetadata(&cursor)) {
    return InvalidData("metadata of the custom form is nested too deeply");
  }
  const uint8_t version_and_coding = cursor.Byte();
  const uint32_t size = cursor.Varint();
  if (cursor.malformed()) return InvalidData("a number at the front of the custom form exceeds 32 bits");
  if (cursor.at_end()) return std::optional<BaseSection>();
  const int version = version_and_coding & 15, coding = version_and_coding >> 4;
  if (version != kCustomVersion) {
    return Unsupported("custom form has version " + std::to_string(version) + ", this library reads version " +
                       std::to_string(kCustomVersion));
  }
  if (coding > 1) return Unsupported("custom form has a base of coding " + std::to_string(coding) + ", which this library does not know");
  return std::optional<BaseSection>({coding == 1 ? BaseForm::kCompact : BaseForm::kStock, cursor.position(), size});
}

// What stands at a place that looks like a refinement header.
enum class Candidate { kNothing, kEndsEarly, kOfAnotherBase, kFits };

Candidate LookAt(Span<const uint8_t> bytes, const TriangleMesh& base) {
  const auto read = ReadRefinementHeader(bytes, MaxTagBytes(base.positions.size(), base.triangles.size()));
  if (!read.ok()) return Candidate::kNothing;
  if (!read.value()) return Candidate::kEndsEarly;
  const auto lattice = BaseMeshFromPositions(base, read.value()->header.base_step);
  const bool fits = lattice.ok() && BaseChecksum(lattice.value()) == read.value()->header.base_checksum;
  return fits ? Candidate::kFits : Candidate::kOfAnotherBase;
}

}  // namespace

StatusOr<std::optional<BaseSection>> FindBaseSection(Span<const uint8_t> bytes) {
  const size_t seen = std::min(bytes.size(), kDracoMark.size());
  if (!std::equal(bytes.begin(), bytes.begin() + seen, kDracoMark.begin())) {
    return InvalidData("this is no Draco or Lacerta stream: it does not begin with \"DRACO\"");
  }
  if (bytes.size() < kHeaderSize) return std::optional<BaseSection>();
  if (bytes[kMethodOffset] == kCustomMethod) return FindCustomBase(bytes);
  return std::optional<BaseSection>(BaseSection());
}

std::optional<size_t> FindRefinement(Span<const uint8_t> stream, const TriangleMesh& base, size_t* from) {
  constexpr std::array<uint8_t, 3> kMark = {'L', 'A', 'C'};  // what follows, the header's reader judges
  constexpr int kMostOfAnotherBase = 16;  // each costs a pass over the base; nothing but bad intent makes more
  size_t first_open = stream.size() - std::min(stream.size(), kMark.size() - 1);
  int of_another_base = 0;
  for (const uint8_t* at = stream.begin() + *from; of_another_base < kMostOfAnotherBase; ++at) {
    at = std::search(at, stream.end(), kMark.begin(), kMark.end());
    if (at == stream.end()) break;
    const auto place = static_cast<size_t>(at - stream.begin());
    const Candidate candidate = LookAt(stream.Subspan(place), base);
    if (candidate == Candidate::kFits) return place;
    if (candidate == Candidate::kEndsEarly) first_open = std::min(first_open, place);
    if (candidate == Candidate::kOfAnotherBase) ++of_another_base;
  }
  *from = std::max(*from, first_open);
  return std::nullopt;
}

}  // namespace lacerta
