// A fuzzer's input taken apart where a refinement is in it, so that one part can be changed, and put together again with lengths and
// checksums that are right.
#ifndef LACERTA_TESTS_FUZZ_STRUCTURED_INPUT_H_
#define LACERTA_TESTS_FUZZ_STRUCTURED_INPUT_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta::fuzz {

struct StructuredInput {
  struct Segment {
    uint8_t what = 0;  // level, shift and whether it waits, in streams with layers; else not used
    Bytes payload;
  };

  Bytes before;       // what stands before base and refinement: choices of the target, a stock Draco stream, the head of a file
  bool has_compact_base = false;  // the end of `before` is the head of a custom form: the length of the base follows
  Bytes compact_base;
  Bytes header;       // of the refinement, without its checksum
  std::vector<Segment> segments;
  Bytes after;        // what is no whole segment

  // The first refinement in `input` whose header has the right checksum, or nothing.
  static std::optional<StructuredInput> Parse(Span<const uint8_t> input);

  // Checksums of header, segments and, where a compact base can be decoded, of the base are made right; segments are of the levels that
  // the header, if it can be read, says are not silent.
  Bytes Join() const;
};

}  // namespace lacerta::fuzz

#endif  // LACERTA_TESTS_FUZZ_STRUCTURED_INPUT_H_
