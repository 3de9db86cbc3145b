// The parsers of header and segment on arbitrary bytes: first as they are, then with the checksum that they should
// have.
#include "common/crc16.h"
#include "common/stream_layout.h"
#include "decoder/stream_reader.h"
#include "draco_ext/encoder/test_streams.h"
#include "fuzz/fuzz_input.h"
#include "lacerta/decoder.h"

namespace {

using lacerta::Bytes;
using lacerta::Span;

void ReadBoth(Span<const uint8_t> bytes) {
  const auto header = lacerta::ReadRefinementHeader(bytes);
  if (header.ok() && header.value()) {
    const lacerta::ReadHeader& read = *header.value();
    FUZZ_CHECK(read.size <= bytes.size());
    FUZZ_CHECK(!read.header.steps.empty() && read.header.steps.size() <= lacerta::kMaxLevels);
    for (const lacerta::LevelSteps& steps : read.header.steps) {
      FUZZ_CHECK(lacerta::RoundStep(steps.normal_step) == steps.normal_step);
      FUZZ_CHECK(steps.tangential_bias <= lacerta::kMaxBias);
    }
    FUZZ_CHECK(lacerta::ReadRefinementInfo(bytes).ok());
  }
  for (const int level : {1, 12}) {
    const auto segment = lacerta::ReadRefinementSegment(bytes, level);
    if (segment.ok() && segment.value()) FUZZ_CHECK(segment.value()->size <= bytes.size());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ReadBoth({data, size});
  DecodeRefinement(lacerta::testing::Octahedron(), {data, size}, {}).value();
  if (size < 2) return 0;
  Bytes fixed = {'L', 'A', 'C', lacerta::kRefinementVersion};
  fixed.insert(fixed.end(), data, data + size);
  lacerta::Crc16 crc;
  crc.Add(fixed);
  fixed.push_back(static_cast<uint8_t>(crc.value()));
  fixed.push_back(static_cast<uint8_t>(crc.value() >> 8));
  ReadBoth(fixed);
  const Span<const uint8_t> payload = Span<const uint8_t>(data, size).First(std::min<size_t>(size, 127));
  Bytes segment = {static_cast<uint8_t>(payload.size())};
  const uint16_t checksum = lacerta::SegmentChecksum(1, payload);
  segment.push_back(static_cast<uint8_t>(checksum));
  segment.push_back(static_cast<uint8_t>(checksum >> 8));
  segment.insert(segment.end(), payload.begin(), payload.end());
  const auto read = lacerta::ReadRefinementSegment(segment, 1);
  FUZZ_CHECK(read.ok() && read.value() && read.value()->size == segment.size());
  return 0;
}
