// Streams with quality layers through the public decoder: prefixes, order of segments, limits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "common/stream_layout.h"
#include "decoder/stream_reader.h"
#include "draco_ext/encoder/test_streams.h"
#include "encoder/layer_writer.h"
#include "encoder/stream_writer.h"
#include "lacerta/decoder.h"

namespace lacerta {
namespace {

using ::lacerta::testing::Coefficients;
using ::lacerta::testing::InLayers;
using ::lacerta::testing::RandomCoefficients;
using ::lacerta::testing::TaggedBase;
using ::lacerta::testing::TaggedBases;
using ::lacerta::testing::Torus;
using ::testing::HasSubstr;

struct Stream {
  Coefficients coefficients;
  std::vector<LayerValues> segments;
  RefinementBytes written;
};

Stream MakeStream(const TaggedBase& tagged, int num_levels) {
  Stream s;
  s.coefficients = RandomCoefficients(tagged.base, num_levels, 41, 9.0, tagged.tags);
  s.segments = InLayers(s.coefficients);
  const std::vector<Topology> topologies = BuildTopologies(tagged.base, num_levels, tagged.tags).value();
  s.written = WriteLayers(tagged.base, topologies, s.coefficients.steps, s.coefficients.levels, s.segments, tagged.tags, BaseStepField::kWritten).value();
  return s;
}

// Decodes an exact-size heap copy, so that the address sanitizer sees one byte too far.
RefinementResult Decode(const BaseMesh& base, const Bytes& bytes, size_t size, const RefinementOptions& options = {}) {
  const std::unique_ptr<uint8_t[]> exact(new uint8_t[size]);
  std::copy(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(size), exact.get());
  return DecodeRefinement(base, Span<const uint8_t>(exact.get(), size), options).value();
}

TEST(LayerDecoderTest, TheWholeStreamIsTheSurfaceOfOneLayer) {
  for (const TaggedBase& tagged : TaggedBases()) {
    const Stream s = MakeStream(tagged, 3);
    const RefinementResult layered = Decode(tagged.base, s.written.bytes, s.written.bytes.size());
    EXPECT_TRUE(layered.refinement.ok()) << layered.refinement.message();
    EXPECT_TRUE(layered.is_complete);
    EXPECT_EQ(layered.bytes_used, s.written.bytes.size());
    const Bytes one = WriteRefinement(tagged.base, s.coefficients.steps, s.coefficients.levels, tagged.tags).value().bytes;
    EXPECT_EQ(layered.mesh.positions, Decode(tagged.base, one, one.size()).mesh.positions);
  }
}

TEST(LayerDecoderTest, EveryPrefixDecodesToItsLastCompleteState) {
  const BaseMesh base = Torus(5, 4);
  const Stream s = MakeStream({base, {}}, 3);
  const Bytes& bytes = s.written.bytes;
  // Level 1 alone in the first round, both in it; then what does not wait: levels 2 and 3, twice.
  ASSERT_EQ(s.written.part_sizes.size(), 6u);
  size_t complete = 0, next_end = s.written.part_sizes[0], used = ReadRefinementHeader(bytes).value()->size;
  const size_t header_size = used;
  std::vector<Vec3f> positions = base.ToMesh().positions;
  for (size_t size = 0; size <= bytes.size(); ++size) {
    const RefinementResult result = Decode(base, bytes, size);
    EXPECT_TRUE(result.refinement.ok()) << result.refinement.message();
    if (size == next_end) {
      ++complete;
      used = size;
      if (complete < s.written.part_sizes.size()) next_end += s.written.part_sizes[complete];
      EXPECT_NE(result.mesh.positions, positions);
      positions = result.mesh.positions;
    }
    EXPECT_EQ(result.state, static_cast<int>(complete));
    EXPECT_EQ(result.bytes_used, size < header_size ? 0 : used);
    EXPECT_EQ(result.mesh.positions, positions) << "at " << size << " bytes";
    EXPECT_EQ(result.is_complete, size == bytes.size());
  }
}

TEST(LayerDecoderTest, ByteByByteEqualsOneShot) {
  const BaseMesh base = Torus(5, 4);
  const Stream s = MakeStream({base, {}}, 3);
  ProgressiveDecoder decoder = ProgressiveDecoder::Create(base, {}).value();
  size_t end = 0, part = 0;
  for (size_t i = 0; i < s.written.bytes.size(); ++i) {
    EXPECT_TRUE(decoder.Append(Span<const uint8_t>(&s.written.bytes[i], 1)).ok());
    if (i + 1 != end + s.written.part_sizes[part]) continue;
    end += s.written.part_sizes[part++];
    const RefinementResult prefix = Decode(base, s.written.bytes, end);
    EXPECT_EQ(decoder.mesh().positions, prefix.mesh.positions);
    EXPECT_EQ(decoder.level(), prefix.level);
    EXPECT_EQ(decoder.state(), static_cast<int>(part));
    EXPECT_EQ(decoder.bytes_used(), end);
    const TriangleMesh finest = MeshAtLevel(decoder.mesh(), decoder.level()).value();
    EXPECT_EQ(decoder.Triangles(), finest.triangles);
    EXPECT_EQ(decoder.mesh().positions, finest.positions);
  }
  EXPECT_TRUE(decoder.is_complete());
}

TEST(LayerDecoderTest, ShowsTwoSmoothLevelsAheadAndNoMore) {
  const BaseMesh base = Torus(5, 4);
  const Stream s = MakeStream({base, {}}, 5);
  const RefinementResult first = Decode(base, s.written.bytes, s.written.part_sizes[0]);
  EXPECT_EQ(first.level, 3);  // of level 1, which has begun
  const RefinementResult second = Decode(base, s.written.bytes, s.written.part_sizes[0] + s.written.part_sizes[1]);
  EXPECT_EQ(second.level, 4);
}

TEST(LayerDecoderTest, StopsAtMaxLevelWithAllOfItsLayers) {
  const BaseMesh base = Torus(5, 4);
  const Stream s = MakeStream({base, {}}, 3);
  const RefinementResult all = Decode(base, s.written.bytes, s.written.bytes.size());
  RefinementOptions options;
  for (int level = 0; level <= 3; ++level) {
    options.max_level = level;
    const RefinementResult result = Decode(base, s.written.bytes, s.written.bytes.size(), options);
    EXPECT_TRUE(result.is_complete);
    EXPECT_EQ(result.level, level);
    EXPECT_EQ(MeshAtLevel(result.mesh, level).value().positions, MeshAtLevel(all.mesh, level).value().positions);
  }
}

TEST(LayerDecoderTest, EveryChangedByteDecodesOrIsRefused) {
  const BaseMesh base = Torus(4, 3);
  const Stream s = MakeStream({base, {}}, 2);
  int refused = 0;
  for (size_t i = 0; i < s.written.bytes.size(); ++i) {
    Bytes changed = s.written.bytes;
    changed[i] ^= 0x5a;
    const RefinementResult result = Decode(base, changed, changed.size());
    refused += !result.refinement.ok();
    EXPECT_FALSE(result.refinement.ok() && result.is_complete) << "byte " << i;
    EXPECT_LE(result.mesh.positions.size(), MeshAtLevel(Decode(base, s.written.bytes, s.written.bytes.size()).mesh, 2).value().positions.size());
  }
  EXPECT_GT(refused, static_cast<int>(s.written.bytes.size() * 9 / 10));
}

TEST(LayerDecoderTest, RefusesSegmentsOutOfOrder) {
  const BaseMesh base = Torus(4, 3);
  const Stream s = MakeStream({base, {}}, 2);
  const size_t header_size = ReadRefinementHeader(s.written.bytes).value()->size;
  const auto refusal = [&](LayerSegment segment) {
    Bytes bytes(s.written.bytes.begin(), s.written.bytes.begin() + static_cast<ptrdiff_t>(header_size));
    const uint8_t what = LayerSegmentByte(segment);
    const uint16_t checksum = SegmentChecksum(what, {});
    bytes.insert(bytes.end(), {what, 0, static_cast<uint8_t>(checksum), static_cast<uint8_t>(checksum >> 8)});
    const RefinementResult result = Decode(base, bytes, bytes.size());
    EXPECT_EQ(result.refinement.ok() || result.level == 0, true);
    return result.refinement;
  };
  EXPECT_TRUE(refusal({1, 7, false}).ok());  // all zero: no payload
  EXPECT_THAT(refusal({2, 0, false}).message(), HasSubstr("before a coarser one"));
  EXPECT_THAT(refusal({3, 0, false}).message(), HasSubstr("does not have"));
  EXPECT_THAT(refusal({0, 0, false}).message(), HasSubstr("does not have"));
  Bytes twice = s.written.bytes;
  twice.resize(s.written.part_sizes[0]);
  const Bytes again(twice.begin() + static_cast<ptrdiff_t>(header_size), twice.end());
  twice.insert(twice.end(), again.begin(), again.end());
  const RefinementResult result = Decode(base, twice, twice.size());
  EXPECT_THAT(result.refinement.message(), HasSubstr("does not refine"));
  EXPECT_EQ(result.state, 1);
}

TEST(LayerDecoderTest, RespectsTheLimits) {
  const BaseMesh base = Torus(5, 4);
  const Stream s = MakeStream({base, {}}, 3);
  const RefinementResult all = Decode(base, s.written.bytes, s.written.bytes.size());
  RefinementOptions options;
  options.limits.max_triangles = 16 * base.triangles.size();
  const RefinementResult limited = Decode(base, s.written.bytes, s.written.bytes.size(), options);
  EXPECT_EQ(limited.refinement.code(), StatusCode::kLimitExceeded);
  EXPECT_EQ(limited.level, 2);
  EXPECT_EQ(limited.state, 3);  // the last before a segment of level 3
  options.limits.max_triangles = 64 * base.triangles.size();
  EXPECT_EQ(Decode(base, s.written.bytes, s.written.bytes.size(), options).mesh.positions, all.mesh.positions);
}

TEST(LayerWriterTest, RefusesSegmentsThatBreakTheRules) {
  const BaseMesh base = Torus(4, 3);
  const Stream s = MakeStream({base, {}}, 2);
  const std::vector<Topology> topologies = BuildTopologies(base, 2).value();
  const auto write = [&](const std::vector<LayerValues>& segments) {
    return WriteLayers(base, topologies, s.coefficients.steps, s.coefficients.levels, segments, {}, BaseStepField::kWritten).status();
  };
  EXPECT_TRUE(write(s.segments).ok());
  std::vector<LayerValues> broken = s.segments;
  broken.pop_back();
  EXPECT_EQ(write(broken).code(), StatusCode::kInvalidArgument);  // level 2 is not brought to its steps
  broken = s.segments;
  broken.back().segment.waits = true;
  EXPECT_EQ(write(broken).code(), StatusCode::kInvalidArgument);
  broken = s.segments;
  std::swap(broken[0], broken[1]);
  EXPECT_EQ(write(broken).code(), StatusCode::kInvalidArgument);
  broken = s.segments;
  ++broken.back().values.normal[0];
  EXPECT_EQ(write(broken).code(), StatusCode::kInvalidArgument);
  broken = s.segments;
  broken.push_back(broken.back());
  EXPECT_EQ(write(broken).code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace lacerta
