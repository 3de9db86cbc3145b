// Golden streams with one byte changed, or cut short anywhere: decoded or refused, and what is decoded is sound, within the bounds below.
// Checksums stop almost every change at the door; the same changes with the checksum made right again show what is behind it.
// LACERTA_ALL_MUTATIONS=1 gives every byte all 255 other values, else it gets four of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "common/crc16.h"
#include "common/stream_layout.h"
#include "decoder/stream_reader.h"
#include "draco_ext/encoder/attributed_test_streams.h"
#include "draco_ext/encoder/test_streams.h"
#include "lacerta/decoder.h"
#ifdef LACERTA_HEAP_METER
#include "bench/heap_meter.h"
#endif

namespace lacerta {
namespace {

using ::lacerta::testing::Octahedron;
using ::lacerta::testing::OctahedronWithAttributes;

constexpr DecodeLimits kLimits = {20000, 40000};
// Of one decoder, whatever the stream says: processor seconds (sanitizers take twenty times what a release build does), and heap for a
// mesh at the limits: 20,000 positions and attributes of 64 floats each, with tables and integers beside them.
constexpr double kMostSeconds = 2.0;
[[maybe_unused]] constexpr size_t kMostHeap = 32 << 20;

ProgressiveDecoder MakeDecoder(const std::string& name) {
  RefinementOptions options;
  options.limits = kLimits;
  if (name.rfind("octahedron_attributes", 0) == 0) return ProgressiveDecoder::Create(OctahedronWithAttributes(), options).value();
  return ProgressiveDecoder::Create(Octahedron(), options).value();
}

void ExpectSound(const ProgressiveDecoder& decoder) {
  const SemiRegularMesh& mesh = decoder.mesh();
  ASSERT_LE(mesh.positions.size(), kLimits.max_vertices);
  for (const Vec3f& p : mesh.positions) ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  const std::vector<Triangle> triangles = decoder.Triangles();
  ASSERT_LE(triangles.size(), kLimits.max_triangles);
  for (const Triangle& t : triangles) ASSERT_LT(*std::max_element(t.begin(), t.end()), mesh.positions.size());
  for (size_t a = 0; a < decoder.attributes().size(); ++a) {
    const std::vector<Triangle> corners = decoder.Corners(a);
    ASSERT_EQ(corners.size(), triangles.size());
    for (const Triangle& t : corners) {
      for (const uint32_t row : t) ASSERT_TRUE(row < decoder.attributes()[a].num_values() || row == MeshAttribute::kNoValue);
    }
  }
}

// A decoder that was given an exact-size heap copy of the bytes, so that the address sanitizer sees one byte too far.
ProgressiveDecoder Decode(const std::string& name, const Bytes& bytes, size_t size) {
  const std::unique_ptr<uint8_t[]> exact(new uint8_t[size]);
  std::copy_n(bytes.begin(), size, exact.get());
#ifdef LACERTA_HEAP_METER
  ResetHeapPeak();
  const size_t in_use = HeapInUse();
#endif
  const std::clock_t begin = std::clock();
  ProgressiveDecoder decoder = MakeDecoder(name);
  static_cast<void>(decoder.Append({exact.get(), size}));  // the decoder keeps it
  EXPECT_LE(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, kMostSeconds);
#ifdef LACERTA_HEAP_METER
  EXPECT_LE(HeapPeak() - in_use, kMostHeap);
#endif
  ExpectSound(decoder);
  return decoder;
}

// Where checksums are and what they cover.
struct Part {
  size_t begin = 0, end = 0;  // without the checksum
  size_t checksum = 0;
  int what = 0;  // as in SegmentChecksum; 0: the header
};

std::vector<Part> PartsOf(const Bytes& bytes) {
  const ReadHeader read = *ReadRefinementHeader(bytes).value();
  std::vector<Part> parts = {{0, read.size - 2, read.size - 2, 0}};
  size_t begin = read.size;
  for (int level = 1; begin < bytes.size(); ++level) {
    const Span<const uint8_t> rest = Span<const uint8_t>(bytes).Subspan(begin);
    if (!read.header.has_layers && read.header.IsSilent(static_cast<size_t>(level - 1))) continue;
    const int what = read.header.has_layers ? bytes[begin] : level;
    const ReadSegment segment =
        read.header.has_layers ? ReadSegment{ReadLayerSegment(rest).value()->payload, ReadLayerSegment(rest).value()->size} : *ReadRefinementSegment(rest, level).value();
    const size_t end = begin + segment.size, payload = end - segment.payload.size();
    parts.push_back({payload, end, payload - 2, what});
    begin = end;
  }
  return parts;
}

void MakeChecksumRight(const Part& part, Bytes* bytes) {
  const Span<const uint8_t> covered = Span<const uint8_t>(*bytes).Subspan(part.begin).First(part.end - part.begin);
  Crc16 crc;
  crc.Add(covered);
  const uint16_t checksum = part.what == 0 ? crc.value() : SegmentChecksum(part.what, covered);
  (*bytes)[part.checksum] = static_cast<uint8_t>(checksum);
  (*bytes)[part.checksum + 1] = static_cast<uint8_t>(checksum >> 8);
}

// Other values of a byte.
std::vector<uint8_t> OtherValues(uint8_t value, std::mt19937* random) {
  std::vector<uint8_t> others;
  for (int change = 1; change < 256; ++change) others.push_back(static_cast<uint8_t>(value ^ change));
  if (std::getenv("LACERTA_ALL_MUTATIONS") != nullptr) return others;
  constexpr size_t kFew = 4;
  std::shuffle(others.begin(), others.end(), *random);
  others.resize(kFew);
  return others;
}

class MutationTest : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    std::ifstream in(std::string(LACERTA_GOLDEN_DIR) + "/v1/" + GetParam() + ".lac", std::ios::binary);
    ASSERT_TRUE(in.good());
    stream_.assign(std::istreambuf_iterator<char>(in), {});
    whole_.emplace(Decode(GetParam(), stream_, stream_.size()));
    ASSERT_TRUE(whole_->is_complete());
  }

  // Whether the levels are those of the whole stream. A state of a stream with layers need not be.
  bool IsPrefixOfWhole(const ProgressiveDecoder& decoder) const {
    const auto same = [](const auto& part, const auto& all) { return part.size() <= all.size() && std::equal(part.begin(), part.end(), all.begin()); };
    if (!same(decoder.mesh().positions, whole_->mesh().positions)) return false;
    for (size_t a = 0; a < decoder.attributes().size(); ++a) {
      if (!same(decoder.attributes()[a].values, whole_->attributes()[a].values)) return false;
    }
    return true;
  }

  Bytes stream_;
  std::optional<ProgressiveDecoder> whole_;
};

TEST_P(MutationTest, EveryTruncationDecodesToWhatItHolds) {
  const bool has_layers = ReadRefinementInfo(stream_).value().has_layers;
  for (size_t size = 0, state = 0; size <= stream_.size(); ++size) {
    const ProgressiveDecoder decoder = Decode(GetParam(), stream_, size);
    ASSERT_TRUE(decoder.refinement().ok()) << decoder.refinement().message();
    ASSERT_GE(decoder.state(), static_cast<int>(state));
    ASSERT_LE(decoder.bytes_used(), size);
    ASSERT_EQ(decoder.is_complete(), size == stream_.size());
    ASSERT_TRUE(has_layers || IsPrefixOfWhole(decoder)) << size;
    state = static_cast<size_t>(decoder.state());
  }
}

// A CRC-16 notices every change of one byte that leaves the length of what it covers alone; of others it would miss one in 65,536.
TEST_P(MutationTest, ChangedBytesAreNoticed) {
  std::mt19937 random(5);
  const bool has_layers = ReadRefinementInfo(stream_).value().has_layers;
  for (size_t i = 0; i < stream_.size(); ++i) {
    for (const uint8_t value : OtherValues(stream_[i], &random)) {
      Bytes changed = stream_;
      changed[i] = value;
      const ProgressiveDecoder decoder = Decode(GetParam(), changed, changed.size());
      ASSERT_FALSE(decoder.is_complete()) << "byte " << i << " as " << int{value};
      ASSERT_TRUE(has_layers || IsPrefixOfWhole(decoder)) << "byte " << i << " as " << int{value};
      ASSERT_LE(decoder.bytes_used(), i) << "byte " << i << " as " << int{value};
    }
  }
}

TEST_P(MutationTest, ChangedBytesWithTheRightChecksumDecodeOrAreRefused) {
  std::mt19937 random(6);
  for (const Part& part : PartsOf(stream_)) {
    for (size_t i = part.begin; i < part.end; ++i) {
      for (const uint8_t value : OtherValues(stream_[i], &random)) {
        Bytes changed = stream_;
        changed[i] = value;
        MakeChecksumRight(part, &changed);
        const ProgressiveDecoder decoder = Decode(GetParam(), changed, changed.size());
        // A payload decodes to some coefficients whatever its bytes; a header may say anything.
        const bool is_header = part.what == 0;
        ASSERT_TRUE(is_header || decoder.is_complete()) << "byte " << i << " as " << int{value} << ": " << decoder.refinement().message();
        ASSERT_TRUE(decoder.refinement().ok() || !decoder.refinement().message().empty());
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Version1, MutationTest, ::testing::Values("octahedron_4_levels", "octahedron_layers_silent_level", "octahedron_attributes",
                                                           "octahedron_attributes_chained"),
                         [](const auto& name) { return std::string(name.param); });

}  // namespace
}  // namespace lacerta
