#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "common/crc16.h"
#include "decoder/stream_reader.h"
#include "draco_ext/encoder/test_streams.h"
#include "encoder/stream_writer.h"
#include "lacerta/decoder.h"

namespace lacerta {
namespace {

using ::lacerta::testing::Coefficients;
using ::lacerta::testing::Octahedron;
using ::lacerta::testing::OctahedronBesideStillSheets;
using ::lacerta::testing::RandomCoefficients;
using ::lacerta::testing::Silence;
using ::lacerta::testing::Square;
using ::lacerta::testing::SquareWithCorners;
using ::lacerta::testing::TaggedBases;
using ::lacerta::testing::ThreeSheets;
using ::lacerta::testing::Torus;
using ::testing::HasSubstr;

RefinementBytes SmallStream(const BaseMesh& base, int num_levels) {
  const Coefficients c = RandomCoefficients(base, num_levels, 11);
  return WriteRefinement(base, c.steps, c.levels).value();
}

// Decodes an exact-size heap copy, so that the address sanitizer sees one byte too far.
RefinementResult Decode(const BaseMesh& base, const Bytes& bytes, size_t size, const RefinementOptions& options = {}) {
  const std::unique_ptr<uint8_t[]> exact(new uint8_t[size]);
  std::copy(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(size), exact.get());
  return DecodeRefinement(base, Span<const uint8_t>(exact.get(), size), options).value();
}

RefinementResult Decode(const BaseMesh& base, const Bytes& bytes) { return Decode(base, bytes, bytes.size()); }

// Writes the right checksum into the header at the beginning of a stream.
void FixHeaderChecksum(size_t header_size, Bytes* bytes) {
  Crc16 crc;
  crc.Add(Span<const uint8_t>(*bytes).First(header_size - 2));
  (*bytes)[header_size - 2] = static_cast<uint8_t>(crc.value());
  (*bytes)[header_size - 1] = static_cast<uint8_t>(crc.value() >> 8);
}

// Where fields of the header of two levels are: after mark and version, levels, base step, checksum of the base.
constexpr size_t kLevelsAt = 3 + 1, kLevelFlagsAt = kLevelsAt + 1 + 2 + 2, kFirstStepAt = kLevelFlagsAt + 1;

// Size of the header of a stream: that of level 1's part without its segment, which begins with its length.
size_t HeaderSize(const Bytes& bytes) { return ReadRefinementHeader(bytes).value()->size; }

TEST(ProgressiveDecoderTest, EveryPrefixDecodesToItsLastCompleteLevel) {
  const BaseMesh base = Octahedron();
  const RefinementBytes refinement = SmallStream(base, 4);
  const RefinementResult whole = Decode(base, refinement.bytes);
  ASSERT_EQ(whole.level, 4);
  for (size_t size = 0; size <= refinement.bytes.size(); ++size) {
    int expected_level = 0;
    size_t end = 0, used = 0;
    for (const size_t part : refinement.part_sizes) {
      end += part;
      if (size >= end) {
        ++expected_level;
        used = end;
      }
    }
    const RefinementResult result = Decode(base, refinement.bytes, size);
    ASSERT_TRUE(result.refinement.ok()) << size << ": " << result.refinement.message();
    ASSERT_EQ(result.level, expected_level) << size;
    ASSERT_EQ(result.mesh.num_levels, expected_level) << size;
    ASSERT_GE(result.bytes_used, used) << size;  // over it where only the header is complete
    ASSERT_LE(result.bytes_used, expected_level > 0 ? used : size) << size;
    const auto& part = result.mesh.positions;
    ASSERT_EQ(part.size(), 4 * (size_t{1} << 2 * expected_level) + 2) << size;  // of a closed surface of genus 0
    ASSERT_TRUE(std::equal(part.begin(), part.end(), whole.mesh.positions.begin())) << size;
  }
}

TEST(ProgressiveDecoderTest, EveryChangedByteDecodesOrIsRefused) {
  const BaseMesh base = Octahedron();
  const RefinementBytes refinement = SmallStream(base, 3);
  const RefinementResult whole = Decode(base, refinement.bytes);
  size_t refused = 0, changes = 0;
  for (size_t i = 0; i < refinement.bytes.size(); ++i) {
    for (const int change : {0x01, 0x10, 0x80, 0xff}) {
      Bytes changed = refinement.bytes;
      changed[i] = static_cast<uint8_t>(changed[i] ^ change);
      const RefinementResult result = Decode(base, changed);
      ++changes;
      refused += !result.refinement.ok();
      EXPECT_TRUE(!result.refinement.ok() || result.level < 3) << "byte " << i << " changed without notice";
      EXPECT_EQ(result.refinement.ok(), result.refinement.message().empty());
      // What came before the damage stays.
      ASSERT_LE(result.mesh.positions.size(), whole.mesh.positions.size());
      EXPECT_TRUE(std::equal(result.mesh.positions.begin(), result.mesh.positions.end(), whole.mesh.positions.begin()));
    }
  }
  EXPECT_GT(refused, changes * 9 / 10);  // the others lengthen a segment: the stream just ends early
}

TEST(ProgressiveDecoderTest, DamagedSegmentKeepsTheLevelsBefore) {
  const BaseMesh base = Octahedron();
  RefinementBytes refinement = SmallStream(base, 3);
  refinement.bytes[refinement.part_sizes[0] + refinement.part_sizes[1] / 2] ^= 0x20;
  const RefinementResult result = Decode(base, refinement.bytes);
  EXPECT_EQ(result.level, 1);
  EXPECT_EQ(result.num_levels, 3);
  EXPECT_EQ(result.refinement.code(), StatusCode::kInvalidData);
  EXPECT_THAT(result.refinement.message(), HasSubstr("segment of level 2"));
}

TEST(ProgressiveDecoderTest, SwappedSegmentsAreNoticed) {
  const BaseMesh base = Octahedron();
  const Coefficients c =
      RandomCoefficients(base, 3, 1, 0.0);  // all zero: segments that differ in nothing but their level
  const RefinementBytes refinement = WriteRefinement(base, c.steps, c.levels).value();
  Bytes swapped(refinement.bytes.begin(), refinement.bytes.begin() + static_cast<ptrdiff_t>(refinement.part_sizes[0]));
  const auto level2 = refinement.bytes.begin() + static_cast<ptrdiff_t>(refinement.part_sizes[0]);
  const auto level3 = level2 + static_cast<ptrdiff_t>(refinement.part_sizes[1]);
  swapped.insert(swapped.end(), level3, refinement.bytes.end());
  swapped.insert(swapped.end(), level2, level3);
  EXPECT_EQ(Decode(base, refinement.bytes).level, 3);
  EXPECT_EQ(Decode(base, swapped).level, 1);
}

TEST(ProgressiveDecoderTest, IgnoresBytesAfterTheLastSegment) {
  const BaseMesh base = Torus(4, 3);
  const RefinementBytes refinement = SmallStream(base, 2);
  Bytes longer = refinement.bytes;
  longer.insert(longer.end(), 1000, 0xaa);
  const RefinementResult result = Decode(base, longer);
  EXPECT_TRUE(result.refinement.ok());
  EXPECT_EQ(result.level, 2);
  EXPECT_EQ(result.bytes_used, refinement.bytes.size());
}

TEST(ProgressiveDecoderTest, RefusesUnknownVersionByName) {
  const BaseMesh base = Octahedron();
  Bytes bytes = SmallStream(base, 2).bytes;
  bytes[3] = 9;
  const RefinementResult result = Decode(base, bytes);
  EXPECT_EQ(result.level, 0);
  EXPECT_EQ(result.refinement.code(), StatusCode::kUnsupported);
  EXPECT_THAT(result.refinement.message(), HasSubstr("version 9"));
  EXPECT_EQ(ReadRefinementInfo(bytes).status().code(), StatusCode::kUnsupported);
}

TEST(ProgressiveDecoderTest, RefusesUnknownFlagsAndLevels) {
  const BaseMesh base = Octahedron();
  const Bytes bytes = SmallStream(base, 2).bytes;
  const auto with_counts = [&](uint8_t byte) {
    Bytes changed = bytes;
    changed[kLevelsAt] = byte;
    return Decode(base, changed).refinement;
  };
  EXPECT_TRUE(with_counts(0x22).ok());
  EXPECT_EQ(with_counts(0x62).code(), StatusCode::kInvalidData);  // layers, of which the checksum does not know
  EXPECT_EQ(with_counts(0xe2).code(), StatusCode::kUnsupported);  // layers and attributes
  EXPECT_EQ(with_counts(0xa2).code(), StatusCode::kInvalidData);  // attributes, which are not there
  EXPECT_EQ(with_counts(0x20).code(), StatusCode::kInvalidData);
  EXPECT_EQ(with_counts(0x2d).code(), StatusCode::kInvalidData);
}

TEST(ProgressiveDecoderTest, RefusesBytesThatAreNoRefinement) {
  const RefinementResult result = Decode(Octahedron(), {'D', 'R', 'A', 'C', 'O'});
  EXPECT_EQ(result.refinement.code(), StatusCode::kInvalidData);
  EXPECT_THAT(result.refinement.message(), HasSubstr("not a Lacerta refinement"));
}

TEST(ProgressiveDecoderTest, RefusesAnotherBase) {
  const BaseMesh base = Octahedron();
  const Bytes bytes = SmallStream(base, 2).bytes;
  BaseMesh moved = base, rescaled = base;
  moved.lattice[3][1] += 1;
  rescaled.step *= 2;
  for (const BaseMesh& other : {moved, rescaled, Torus(4, 3)}) {
    const RefinementResult result = Decode(other, bytes);
    EXPECT_EQ(result.refinement.code(), StatusCode::kInvalidData);
    EXPECT_THAT(result.refinement.message(), HasSubstr("another base mesh"));
    EXPECT_EQ(result.level, 0);
    EXPECT_EQ(result.mesh.positions, other.ToMesh().positions);
  }
}

TEST(ProgressiveDecoderTest, RefusesStepsOutOfRange) {
  const BaseMesh base = Octahedron();
  const Bytes bytes = SmallStream(base, 2).bytes;
  const size_t header_size = HeaderSize(bytes);
  for (const int bits :
       {0x7f80 /* infinite */, 0x7fc0 /* NaN */, 0xbf80 /* -1 */, 0x0001 /* denormal */, 0x8000 /* -0 */}) {
    const auto with_bits_at = [&, bits = bits](size_t at) {
      Bytes changed = bytes;
      changed[at] = static_cast<uint8_t>(bits);
      changed[at + 1] = static_cast<uint8_t>(bits >> 8);
      FixHeaderChecksum(header_size, &changed);
      return Decode(base, changed).refinement.message();
    };
    EXPECT_THAT(with_bits_at(kFirstStepAt), HasSubstr("quantization step")) << bits;
    EXPECT_THAT(with_bits_at(kLevelsAt + 1), HasSubstr("base step")) << bits;
  }
  Bytes same = bytes;
  FixHeaderChecksum(header_size, &same);
  EXPECT_EQ(same, bytes);  // the layout that this test relies on
}

// A header of `num_levels` silent levels, with other flags and fields of levels in place of theirs.
Bytes HeaderWith(const BaseMesh& base, size_t num_levels, const Bytes& flags_and_fields) {
  const std::vector<QuantizedLevel> none = RandomCoefficients(base, static_cast<int>(num_levels), 1, 0.0).levels;
  Bytes bytes = WriteRefinement(base, std::vector<LevelSteps>(num_levels), none).value().bytes;
  bytes.resize(kLevelFlagsAt);
  bytes.insert(bytes.end(), flags_and_fields.begin(), flags_and_fields.end());
  bytes.resize(bytes.size() + 2);
  FixHeaderChecksum(bytes.size(), &bytes);
  return bytes;
}

TEST(ProgressiveDecoderTest, RefusesFlagsAndDifferencesOfLevelsThatMakeNoSense) {
  const BaseMesh base = Octahedron();
  const auto refusal = [&](size_t num_levels, const Bytes& flags_and_fields) {
    return Decode(base, HeaderWith(base, num_levels, flags_and_fields)).refinement.message();
  };
  EXPECT_EQ(refusal(1, {0x01, 0x80, 0x3f}), "");
  EXPECT_THAT(refusal(1, {0x04, 0x80, 0x3f}), HasSubstr("has flags, but no coefficients"));
  EXPECT_THAT(refusal(1, {0x08, 0x80, 0x3f, 0x00}), HasSubstr("has flags, but no coefficients"));
  EXPECT_THAT(refusal(1, {0x11, 0x80, 0x3f}), HasSubstr("has flags, but no coefficients"));  // of level 2 of 1
  EXPECT_EQ(refusal(1, {0x05, 0x80, 0x3f, 0x03}), "");
  EXPECT_THAT(refusal(1, {0x05, 0x80, 0x00, 0x01}), HasSubstr("quantization step"));  // 0x007f
  EXPECT_THAT(refusal(1, {0x05, 0x80, 0x3f, 0xff, 0xff, 0xff, 0xff, 0x0f}), HasSubstr("quantization step"));
  EXPECT_THAT(refusal(1, {0x05, 0x80, 0x3f, 0xfe, 0xff, 0xff, 0xff, 0x0f}), HasSubstr("quantization step"));
  EXPECT_THAT(refusal(1, {0x05, 0x80, 0x3f, 0xff, 0xff, 0xff, 0xff, 0x1f}), HasSubstr("exceeds 32 bits"));
  EXPECT_EQ(refusal(1, {0x03, 0xff, 0x7e}), "");
  EXPECT_THAT(refusal(1, {0x03, 0x00, 0x7f}), HasSubstr("quantization step"));  // tangential: twice that
}

TEST(ProgressiveDecoderTest, SilentLevelsAreCompleteAsSoonAsTheLevelBefore) {
  const BaseMesh base = Octahedron();
  Coefficients c = RandomCoefficients(base, 4, 11);
  for (const size_t level : {1, 3, 4}) Silence(level, &c);
  const RefinementBytes refinement = WriteRefinement(base, c.steps, c.levels).value();
  const size_t header_size = HeaderSize(refinement.bytes);
  EXPECT_EQ(refinement.part_sizes[0], header_size);
  EXPECT_EQ(refinement.part_sizes[2] + refinement.part_sizes[3], 0u);
  for (size_t size = 0; size <= refinement.bytes.size(); ++size) {
    const RefinementResult result = Decode(base, refinement.bytes, size);
    ASSERT_TRUE(result.refinement.ok()) << result.refinement.message();
    ASSERT_EQ(result.level, size < header_size ? 0 : size < refinement.bytes.size() ? 1 : 4) << size;
  }
  for (int max_level = 0; max_level < 4; ++max_level) {
    RefinementOptions options;
    options.max_level = max_level;
    EXPECT_EQ(Decode(base, refinement.bytes, refinement.bytes.size(), options).level, max_level);
  }
}

TEST(ProgressiveDecoderTest, BaseStepMayBeLeftOut) {
  const BaseMesh base = Octahedron();
  const Coefficients c = RandomCoefficients(base, 2, 11);
  const Bytes bytes = WriteRefinement(base, c.steps, c.levels, {}, BaseStepField::kLeftOut).value().bytes;
  EXPECT_EQ(Decode(base, bytes).level, 2);
  EXPECT_EQ(ReadRefinementInfo(bytes).value().base_step, 0.0f);
  BaseMesh other = base;
  other.step *= 2;
  EXPECT_THAT(Decode(other, bytes).refinement.message(), HasSubstr("another base mesh"));
}

TEST(ProgressiveDecoderTest, StopsAtPositionsThatAreNotFinite) {
  BaseMesh base = Octahedron();
  base.step = RoundStep(1e36f);
  Coefficients c = RandomCoefficients(base, 2, 3);
  c.steps[1] = {StepFromBits(0x7f7f), 0.0f, 0, 0};
  c.levels[1].tangential.assign(c.levels[1].tangential.size(), 0);
  c.levels[1].normal.assign(c.levels[1].normal.size(), kMaxMagnitude);
  const RefinementBytes refinement = WriteRefinement(base, c.steps, c.levels).value();
  const RefinementResult result = Decode(base, refinement.bytes);
  EXPECT_EQ(result.level, 1);
  EXPECT_THAT(result.refinement.message(), HasSubstr("not finite"));
  EXPECT_EQ(result.mesh.positions.size(), 18u);
}

TEST(ProgressiveDecoderTest, RespectsTheLimits) {
  const BaseMesh base = Octahedron();
  const RefinementBytes refinement = SmallStream(base, 4);
  RefinementOptions options;
  options.limits = {66, 1000};  // level 2 has 66 vertices and 128 triangles, level 3 has 258
  const RefinementResult by_vertices = Decode(base, refinement.bytes, refinement.bytes.size(), options);
  EXPECT_EQ(by_vertices.level, 2);
  EXPECT_EQ(by_vertices.refinement.code(), StatusCode::kLimitExceeded);
  EXPECT_THAT(by_vertices.refinement.message(), HasSubstr("level 3 (258 vertices, 512 triangles)"));
  options.limits = {1000, 127};
  EXPECT_EQ(Decode(base, refinement.bytes, refinement.bytes.size(), options).level, 1);
  options.limits = {5, 1000};
  EXPECT_EQ(DecodeRefinement(base, refinement.bytes, options).status().code(), StatusCode::kLimitExceeded);
}

TEST(ProgressiveDecoderTest, TwelveLevelsInFewBytesStayWithinTheLimits) {
  // Twelve levels of nothing on 200 triangles would be 3.4e9 triangles: a bomb of 19 bytes.
  const BaseMesh base = Torus(10, 10);
  Bytes bytes = HeaderWith(base, 1, {0, 0, 0, 0, 0, 0, 0x80, 0x3f});  // flags of twelve levels, first step
  bytes[kLevelsAt] = 0x2c;
  FixHeaderChecksum(bytes.size(), &bytes);
  ASSERT_EQ(bytes.size(), 19u);
  RefinementOptions options;
  options.limits = {100000, 200000};
  const RefinementResult result = Decode(base, bytes, bytes.size(), options);
  EXPECT_EQ(result.level, 4);  // 51,200 triangles; the next one has 204,800
  EXPECT_EQ(result.num_levels, 12);
  EXPECT_EQ(result.refinement.code(), StatusCode::kLimitExceeded);
}

TEST(ProgressiveDecoderTest, RefusesToRefineVerticesOfAbsurdValence) {
  BaseMesh fan{1.0f, {{{0, 0, 0}}}, {}};
  constexpr uint32_t kRim = 1025;
  for (uint32_t i = 0; i < kRim; ++i) {
    fan.lattice.push_back({{static_cast<int32_t>(i) + 1, static_cast<int32_t>(i * i), 7}});
    fan.triangles.push_back({{0, 1 + i, 1 + (i + 1) % kRim}});
  }
  EXPECT_THAT(BuildTopologies(fan, 1).status().message(), HasSubstr("1025 edges"));
  fan.triangles.pop_back();  // open: vertex 0 still has 1,025 edges
  EXPECT_FALSE(BuildTopologies(fan, 1).ok());
  fan.triangles.pop_back();
  fan.lattice.pop_back();
  EXPECT_TRUE(BuildTopologies(fan, 1).ok());
}

TEST(TaggedStreamTest, EveryPrefixDecodesToItsLastCompleteLevel) {
  for (const auto& [base, tags] : TaggedBases()) {
    const Coefficients c = RandomCoefficients(base, 3, 12, 4.0, tags);
    const RefinementBytes refinement = WriteRefinement(base, c.steps, c.levels, tags).value();
    const RefinementResult whole = Decode(base, refinement.bytes);
    ASSERT_EQ(whole.level, 3) << whole.refinement.message();
    for (size_t size = 0; size < refinement.bytes.size(); ++size) {
      const RefinementResult result = Decode(base, refinement.bytes, size);
      ASSERT_TRUE(result.refinement.ok()) << size << ": " << result.refinement.message();
      size_t end = 0;
      int expected_level = 0;
      for (const size_t part : refinement.part_sizes) expected_level += size >= (end += part);
      ASSERT_EQ(result.level, expected_level) << size;
      EXPECT_EQ(result.mesh.tags.empty(), size < HeaderSize(refinement.bytes)) << size;
      ASSERT_TRUE(std::equal(result.mesh.positions.begin(), result.mesh.positions.end(), whole.mesh.positions.begin())) << size;
      ASSERT_TRUE(MeshAtLevel(result.mesh, result.level).ok());
    }
  }
}

TEST(TaggedStreamTest, DamagedTagsWithASoundChecksumDecodeToSomething) {
  int other = 0, refused = 0;
  for (const auto& [base, tags] : TaggedBases()) {
    const Coefficients c = RandomCoefficients(base, 2, 12, 4.0, tags);
    const Bytes bytes = WriteRefinement(base, c.steps, c.levels, tags).value().bytes;
    const RefinementResult whole = Decode(base, bytes);
    const size_t header_size = HeaderSize(bytes);
    const size_t tags_size = ReadRefinementHeader(bytes).value()->header.tags.size();
    ASSERT_GE(tags_size, 1u);
    for (size_t i = header_size - 2 - tags_size; i < header_size - 2; ++i) {
      for (int change = 1; change < 256; ++change) {
        Bytes changed = bytes;
        changed[i] = static_cast<uint8_t>(changed[i] ^ change);
        EXPECT_THAT(Decode(base, changed).refinement.message(), HasSubstr("checksum mismatch"));
        FixHeaderChecksum(header_size, &changed);
        const RefinementResult result = Decode(base, changed);
        refused += !result.refinement.ok();
        other += result.refinement.ok() && result.mesh.positions != whole.mesh.positions;
        ASSERT_TRUE(MeshAtLevel(result.mesh, result.level).ok());
      }
    }
  }
  EXPECT_GE(other, 500);
  EXPECT_GE(refused, 10);
}

TEST(TaggedStreamTest, RefusesTagsLongerThanTheBaseCanHave) {
  const auto [base, tags] = SquareWithCorners();
  const Coefficients c = RandomCoefficients(base, 1, 1, 4.0, tags);
  Bytes bytes = WriteRefinement(base, c.steps, c.levels, tags).value().bytes;
  const size_t length_at = HeaderSize(bytes) - 2 - ReadRefinementHeader(bytes).value()->header.tags.size() - 1;
  bytes[length_at] = 26;  // 8 + 3 (4 + 4 * 2) / 2: just what may be
  EXPECT_THAT(Decode(base, bytes).refinement.message(), ::testing::Not(HasSubstr("bytes of tags")));
  bytes[length_at] = 0;
  EXPECT_THAT(Decode(base, bytes).refinement.message(), HasSubstr("(0 bytes of tags)"));
  bytes[length_at] = 27;
  EXPECT_THAT(Decode(base, bytes).refinement.message(), HasSubstr("27 bytes of tags"));
}

TEST(TaggedStreamTest, StillTrianglesComeLastAndCountInTheLimits) {
  const auto [base, tags] = OctahedronBesideStillSheets();
  const Coefficients c = RandomCoefficients(base, 2, 12, 4.0, tags);
  const Bytes bytes = WriteRefinement(base, c.steps, c.levels, tags).value().bytes;
  const RefinementResult whole = Decode(base, bytes);
  const TriangleMesh finest = MeshAtLevel(whole.mesh, 2).value();
  ASSERT_EQ(finest.triangles.size(), 128u + 3u);
  EXPECT_EQ(finest.triangles[128], (Triangle{6, 7, 8}));
  EXPECT_EQ(finest.triangles[130], (Triangle{6, 7, 10}));
  for (uint32_t v = 6; v < 11; ++v) EXPECT_EQ(finest.positions[v], base.ToMesh().positions[v]);
  EXPECT_EQ(MeshAtLevel(whole.mesh, 0).value().triangles, base.triangles);
  RefinementOptions options;
  options.limits = {1000, 131};
  EXPECT_EQ(Decode(base, bytes, bytes.size(), options).level, 2);
  options.limits = {1000, 130};
  const RefinementResult limited = Decode(base, bytes, bytes.size(), options);
  EXPECT_EQ(limited.level, 1);
  EXPECT_THAT(limited.refinement.message(), HasSubstr("131 triangles"));
}

TEST(TaggedStreamTest, JoinedSheetsStayTogetherOnEveryLevel) {
  const auto [base, tags] = ThreeSheets();
  const Coefficients c = RandomCoefficients(base, 3, 13, 6.0, tags);
  const RefinementResult whole = Decode(base, WriteRefinement(base, c.steps, c.levels, tags).value().bytes);
  ASSERT_EQ(whole.level, 3) << whole.refinement.message();
  Topology t = BuildTopology(12, base.triangles, tags).value();
  const std::vector<Vec3f>& positions = whole.mesh.positions;
  int copies = 0, bent = 0;
  for (int level = 0; level < 3; ++level, t = Refine(t)) {
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      if (!t.is_copy(e)) continue;
      ++copies;
      const Vec3f& p = positions[t.num_vertices + e];
      EXPECT_EQ(p, positions[t.num_vertices + t.master[e]]);
      bent += p.x != 0 || p.y != 0;
    }
  }
  EXPECT_EQ(copies, 2 * (1 + 2 + 4));
  EXPECT_GE(bent, 10);  // details are at work there
}

TEST(TaggedStreamTest, RefusesBasesOfStillTrianglesOnly) {
  const BaseMesh base = Octahedron();
  Bytes bytes = SmallStream(base, 1).bytes;
  const size_t header_size = HeaderSize(bytes);
  bytes[kLevelsAt] |= 0x10;  // there are tags: a payload of one byte, zero, which is ones without end
  const Bytes tags = {1, 0};
  bytes.insert(bytes.begin() + static_cast<ptrdiff_t>(header_size) - 2, tags.begin(), tags.end());
  FixHeaderChecksum(header_size + 2, &bytes);
  const RefinementResult result = Decode(base, bytes);
  EXPECT_EQ(result.refinement.code(), StatusCode::kInvalidData);
  EXPECT_THAT(result.refinement.message(), HasSubstr("nothing to refine"));
  EXPECT_EQ(result.level, 0);
  EXPECT_TRUE(result.mesh.tags.empty());
}

TEST(ProgressiveDecoderTest, StopsAtMaxLevel) {
  const BaseMesh base = Octahedron();
  const RefinementBytes refinement = SmallStream(base, 3);
  RefinementOptions options;
  for (int max_level = 0; max_level <= 5; ++max_level) {
    options.max_level = max_level;
    const RefinementResult result = Decode(base, refinement.bytes, refinement.bytes.size(), options);
    EXPECT_TRUE(result.refinement.ok());
    EXPECT_EQ(result.level, std::min(max_level, 3));
    EXPECT_EQ(result.num_levels, 3);
  }
}

TEST(ProgressiveDecoderTest, ByteByByteEqualsOneShot) {
  const BaseMesh base = Torus(5, 4);
  const RefinementBytes refinement = SmallStream(base, 3);
  ProgressiveDecoder decoder = ProgressiveDecoder::Create(base, {}).value();
  size_t next_end = 0;
  int expected_level = 0;
  for (size_t i = 0; i < refinement.bytes.size(); ++i) {
    EXPECT_EQ(decoder.level(), expected_level);
    ASSERT_TRUE(decoder.Append(Span<const uint8_t>(&refinement.bytes[i], 1)).ok());
    if (i + 1 == next_end + refinement.part_sizes[expected_level]) next_end += refinement.part_sizes[expected_level++];
    EXPECT_EQ(decoder.level(), expected_level) << i;
  }
  const RefinementResult whole = Decode(base, refinement.bytes);
  EXPECT_EQ(decoder.mesh().positions, whole.mesh.positions);
  EXPECT_EQ(decoder.bytes_used(), whole.bytes_used);
  EXPECT_EQ(decoder.num_levels(), 3);
}

TEST(ProgressiveDecoderTest, StaysFailed) {
  const BaseMesh base = Octahedron();
  const RefinementBytes refinement = SmallStream(base, 2);
  ProgressiveDecoder decoder = ProgressiveDecoder::Create(base, {}).value();
  const Bytes wrong = {'L', 'A', 'D'};
  EXPECT_FALSE(decoder.Append(wrong).ok());
  EXPECT_FALSE(decoder.Append(refinement.bytes).ok());
  EXPECT_EQ(decoder.level(), 0);
}

TEST(ProgressiveDecoderTest, RefusesBasesOutOfRange) {
  BaseMesh base = Octahedron();
  for (const float step : {0.0f, -1.0f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
    base.step = step;
    EXPECT_EQ(ProgressiveDecoder::Create(base, {}).status().code(), StatusCode::kInvalidData) << step;
  }
  base = Octahedron();
  base.lattice[2][0] = 1 << 24;
  EXPECT_EQ(ProgressiveDecoder::Create(base, {}).status().code(), StatusCode::kInvalidData);
}

TEST(ProgressiveDecoderTest, TakesBasesThatCannotBeRefined) {
  // Not manifold, but nothing wants to refine it.
  const BaseMesh base{
      1.0f, {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{1, 1, 1}}}, {{{0, 1, 2}}, {{0, 1, 3}}, {{0, 1, 4}}}};
  const RefinementResult result = Decode(base, {});
  EXPECT_TRUE(result.refinement.ok());
  EXPECT_EQ(result.level, 0);
  EXPECT_EQ(MeshAtLevel(result.mesh, 0).value().triangles, base.triangles);
}

TEST(ReadRefinementInfoTest, TellsWhatTheHeaderSays) {
  const BaseMesh base = Torus(10, 20);
  const RefinementBytes refinement = SmallStream(base, 2);
  const RefinementInfo info = ReadRefinementInfo(refinement.bytes).value();
  EXPECT_EQ(info.num_levels, 2);
  EXPECT_EQ(info.base_step, base.step);
  EXPECT_FALSE(ReadRefinementInfo(Span<const uint8_t>(refinement.bytes).First(12)).ok());
  EXPECT_FALSE(ReadRefinementInfo({}).ok());
}

TEST(MeshAtLevelTest, GivesEveryLevel) {
  const BaseMesh base = Octahedron();
  const RefinementResult result = Decode(base, SmallStream(base, 3).bytes);
  for (int level = 0; level <= 3; ++level) {
    const TriangleMesh mesh = MeshAtLevel(result.mesh, level).value();
    EXPECT_EQ(mesh.triangles.size(), size_t{8} << 2 * level);
    EXPECT_EQ(mesh.positions.size(), mesh.triangles.size() / 2 + 2);
    for (const Triangle& t : mesh.triangles) EXPECT_LT(std::max({t[0], t[1], t[2]}), mesh.positions.size());
  }
  EXPECT_EQ(MeshAtLevel(result.mesh, 4).status().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(MeshAtLevel(result.mesh, -1).status().code(), StatusCode::kInvalidArgument);
}

TEST(ProgressiveDecoderTest, TrianglesAreThoseOfTheFinestCompleteLevel) {
  for (const auto& [base, tags] : TaggedBases()) {
    const Coefficients c = RandomCoefficients(base, 3, 12, 4.0, tags);
    const RefinementBytes refinement = WriteRefinement(base, c.steps, c.levels, tags).value();
    const RefinementResult whole = Decode(base, refinement.bytes);
    ProgressiveDecoder decoder = ProgressiveDecoder::Create(base, {}).value();
    EXPECT_EQ(decoder.Triangles(), base.triangles);
    for (size_t i = 0; i < refinement.bytes.size(); ++i) {
      ASSERT_TRUE(decoder.Append(Span<const uint8_t>(&refinement.bytes[i], 1)).ok());
      ASSERT_EQ(decoder.Triangles(), MeshAtLevel(whole.mesh, decoder.level()).value().triangles) << i;
    }
    EXPECT_EQ(decoder.level(), 3);
    EXPECT_EQ(std::move(decoder).TakeMesh().positions, whole.mesh.positions);
  }
}

// The last level has no coefficients and is made without tables of the one before; with another level after it, it is made like any.
TEST(ProgressiveDecoderTest, ASilentLastLevelIsTheSameAsOneAmongOthers) {
  for (const auto& [base, tags] : TaggedBases()) {
    Coefficients c = RandomCoefficients(base, 4, 13, 4.0, tags);
    for (const size_t level : {3, 4}) Silence(level, &c);
    const RefinementBytes refinement = WriteRefinement(base, c.steps, c.levels, tags).value();
    const RefinementResult whole = Decode(base, refinement.bytes);
    ASSERT_EQ(whole.level, 4);
    RefinementOptions options;
    options.max_level = 3;
    ProgressiveDecoder decoder = ProgressiveDecoder::Create(base, options).value();
    ASSERT_TRUE(decoder.Append(refinement.bytes).ok());
    const TriangleMesh expected = MeshAtLevel(whole.mesh, 3).value();
    EXPECT_EQ(decoder.mesh().positions, expected.positions);
    EXPECT_EQ(decoder.Triangles(), expected.triangles);
  }
}

TEST(BaseMeshTest, SurvivesFloatsOfAHost) {
  BaseMesh base = Torus(9, 7);
  base.step = 0.00317f;
  base.lattice[0] = {(1 << 20) - 1, -(1 << 20) + 3, 77777};
  const BaseMesh again = BaseMeshFromPositions(base.ToMesh(), base.step).value();
  EXPECT_EQ(again.lattice, base.lattice);
  EXPECT_EQ(again.triangles, base.triangles);
}

TEST(BaseMeshTest, RefusesPositionsOffTheLattice) {
  const TriangleMesh mesh = Octahedron().ToMesh();
  EXPECT_TRUE(BaseMeshFromPositions(mesh, 1.0f / 64).ok());
  EXPECT_EQ(BaseMeshFromPositions(mesh, 1.0f / 50).status().code(),
            StatusCode::kOk);  // 50 lattice units: fits by chance
  EXPECT_EQ(BaseMeshFromPositions(mesh, 1.0f / 63.5f).status().code(), StatusCode::kInvalidData);
  EXPECT_EQ(BaseMeshFromPositions(mesh, 0.0f).status().code(), StatusCode::kInvalidArgument);
  TriangleMesh broken = mesh;
  broken.positions[1].y = std::nanf("");
  EXPECT_EQ(BaseMeshFromPositions(broken, 1.0f / 64).status().code(), StatusCode::kInvalidData);
  broken.positions[1].y = std::numeric_limits<float>::infinity();
  EXPECT_EQ(BaseMeshFromPositions(broken, 1.0f / 64).status().code(), StatusCode::kInvalidData);
  broken.positions[1].y = 1e9f;
  EXPECT_EQ(BaseMeshFromPositions(broken, 1.0f / 64).status().code(), StatusCode::kInvalidData);
}

}  // namespace
}  // namespace lacerta
