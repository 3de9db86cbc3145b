// What the refinement of a base mesh looks like in bytes, for reader (decoder/stream_reader.h) and writer
// (encoder/stream_writer.h). Specified in docs/format.md, "Refinement header" and "Segments".
#ifndef LACERTA_COMMON_STREAM_LAYOUT_H_
#define LACERTA_COMMON_STREAM_LAYOUT_H_

#include <array>
#include <cstdint>
#include <vector>

#include "common/attribute_layout.h"
#include "common/coefficient_sets.h"
#include "lacerta/attributed_base.h"
#include "lacerta/decoder.h"

namespace lacerta {

inline constexpr std::array<uint8_t, 3> kRefinementMagic = {'L', 'A', 'C'};
inline constexpr uint8_t kRefinementVersion = 1;  // lower half of its byte; the upper one is the number of curved levels
inline constexpr int kMaxLevels = 12;
// A base vertex has at most this many edges, so that no stencil makes a decoder slow.
inline constexpr int kMaxBaseValence = 1024;
// Bytes that the tags of a base may take: every decision costs less than 12 bits, and there are at most one per triangle, three
// per triangle for its edges, and one per vertex.
inline uint64_t MaxTagBytes(uint64_t num_vertices, uint64_t num_triangles) {
  return 8 + 3 * (num_vertices + 4 * num_triangles) / 2;
}
inline constexpr int32_t kMaxLatticeValue = (1 << 24) - 1;  // a binary32 holds it exactly

// Flags of the refinement header, above the number of levels.
inline constexpr uint8_t kHasTags = 1 << 4;
inline constexpr uint8_t kHasBaseStep = 1 << 5;
inline constexpr uint8_t kHasLayers = 1 << 6;  // levels come in several segments, which tell what they are
inline constexpr uint8_t kHasAttributes = 1 << 7;

// Flags of a level.
inline constexpr uint8_t kCodesNormal = 1;
inline constexpr uint8_t kCodesTangential = 2;
inline constexpr uint8_t kHasDifferences = 4;  // of the steps from the expected ones (common/step_forecast.h)
inline constexpr uint8_t kHasBiases = 8;

// The fields of the refinement header. The number of levels is steps.size().
struct RefinementHeader {
  float base_step = 0.0f;  // 0: the base section tells it
  uint16_t base_checksum = 0;
  std::vector<LevelSteps> steps;  // of levels 1, 2, ...
  bool has_layers = false;
  Bytes tags;                     // payload of CodeBaseTags (common/base_tags_coding.h); empty: none
  bool is_attributed = false;     // made for an AttributedBase
  std::vector<AttributeHeader> attributes;

  // Whether level i + 1 has no segment.
  bool IsSilent(size_t i) const;
};

// What a segment of a stream with layers holds: level `level` on steps 2^shift times those of the header.
struct LayerSegment {
  int level = 1;       // 1..12
  int shift = 0;       // 0..7
  bool waits = false;  // to be shown together with the next segment only: alone it would make the mesh worse
};
inline constexpr int kMaxLayerShift = 7;
inline uint8_t LayerSegmentByte(const LayerSegment& s) { return static_cast<uint8_t>(s.level | s.shift << 4 | (s.waits ? 0x80 : 0)); }
inline LayerSegment LayerSegmentFromByte(uint8_t byte) { return {byte & 15, byte >> 4 & 7, (byte & 0x80) != 0}; }

// The CRC-16 over step, lattice values (three per vertex) and triangles (three indices each) as 4-byte little-endian words.
uint16_t BaseChecksum(const BaseMesh& base);

// The same of a base with attributes: followed by the sizes of the groups, and for each attribute by its flags of groups and by the
// values at the vertices of triangles that have it, in the order of these vertices.
uint16_t BaseChecksum(const AttributedBase& base);

// The checksum that a segment carries. what: the level, or LayerSegmentByte.
uint16_t SegmentChecksum(int what, Span<const uint8_t> payload);

}  // namespace lacerta

#endif  // LACERTA_COMMON_STREAM_LAYOUT_H_
