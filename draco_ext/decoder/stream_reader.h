// Reading the refinement header and the segments from a stream that may end anywhere. Twin: encoder/stream_writer.h.
#ifndef LACERTA_DECODER_STREAM_READER_H_
#define LACERTA_DECODER_STREAM_READER_H_

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "common/stream_layout.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

struct ReadHeader {
  RefinementHeader header;
  size_t size = 0;  // bytes that it took
};

// The header at the beginning of `bytes`, or nothing where `bytes` ends inside it. Fails with kInvalidData where a
// field or the checksum is wrong and with kUnsupported on a version or flag that this decoder does not know.
//   max_tag_bytes  MaxTagBytes of the base where that is at hand, so that no decoder waits for more
StatusOr<std::optional<ReadHeader>> ReadRefinementHeader(Span<const uint8_t> bytes,
                                                         uint64_t max_tag_bytes = std::numeric_limits<uint64_t>::max());

struct ReadSegment {
  Span<const uint8_t> payload;
  size_t size = 0;  // bytes that it took
};

// The segment of `level`, which is not silent, at the beginning of `bytes`, or nothing where `bytes` ends inside it. Fails with kInvalidData
// where the length is malformed or the checksum is wrong.
StatusOr<std::optional<ReadSegment>> ReadRefinementSegment(Span<const uint8_t> bytes, int level);

struct ReadLayer {
  LayerSegment segment;
  Span<const uint8_t> payload;
  size_t size = 0;
};

// The segment at the beginning of `bytes` of a stream with layers, as above.
StatusOr<std::optional<ReadLayer>> ReadLayerSegment(Span<const uint8_t> bytes);

}  // namespace lacerta

#endif  // LACERTA_DECODER_STREAM_READER_H_
