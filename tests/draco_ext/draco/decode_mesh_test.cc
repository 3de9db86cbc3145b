#include "draco/decode_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "draco/zero_level.h"
#include "draco_ext/draco/test_progressive_streams.h"
#include "lacerta/codec.h"

namespace lacerta {
namespace {

using ::lacerta::testing::MakeProgressiveStream;
using ::lacerta::testing::Octahedron;
using ::lacerta::testing::ProgressiveStream;
using ::lacerta::testing::SameBits;
using ::lacerta::testing::ThreeSheets;
using ::lacerta::testing::Torus;
using ::testing::HasSubstr;

// Decodes a heap copy of exactly `size` bytes, so that the address sanitizer sees one byte too far.
StatusOr<DecodedMesh> DecodePrefix(const Bytes& stream, size_t size, const DecodeOptions& options = {}) {
  const std::unique_ptr<uint8_t[]> copy(new uint8_t[size]);
  std::copy_n(stream.begin(), size, copy.get());
  return DecodeMesh(Span<const uint8_t>(copy.get(), size), options);
}

TriangleMesh ExpectedLevel(const ProgressiveStream& stream, int level) {
  const RefinementResult refined = DecodeRefinement(stream.base.mesh, stream.refinement, {}).value();
  return MeshAtLevel(refined.mesh, level).value();
}

TEST(DecodeMeshTest, DecodesBothFormsToTheSameMesh) {
  const ProgressiveStream stream = MakeProgressiveStream(Torus(6, 5), 3);
  for (const Bytes& bytes : {stream.DracoForm(), stream.CustomForm()}) {
    const StatusOr<DecodedMesh> decoded = DecodeMesh(bytes, {});
    ASSERT_TRUE(decoded.ok()) << decoded.status().message();
    EXPECT_TRUE(decoded.value().refinement.ok()) << decoded.value().refinement.message();
    EXPECT_EQ(decoded.value().level, 3);
    EXPECT_EQ(decoded.value().num_levels, 3);
    const TriangleMesh expected = ExpectedLevel(stream, 3);
    EXPECT_EQ(expected.triangles.size(), 60u * 64);
    EXPECT_TRUE(SameBits(decoded.value().mesh.positions, expected.positions));
    EXPECT_EQ(decoded.value().mesh.triangles, expected.triangles);
  }
}

TEST(DecodeMeshTest, JoinedSheetsStayTogetherInBothForms) {
  const ProgressiveStream stream = MakeProgressiveStream(ThreeSheets().base, 3, /*joined=*/true);
  const ProgressiveStream apart = MakeProgressiveStream(ThreeSheets().base, 3);
  // Vertices at the place of another one: two more for each of the nine on the common curve, where it is one.
  const auto num_at_taken_places = [](const TriangleMesh& mesh) {
    std::vector<std::array<float, 3>> points;
    for (const Vec3f& p : mesh.positions) points.push_back({p.x, p.y, p.z});
    std::sort(points.begin(), points.end());
    return points.end() - std::unique(points.begin(), points.end());
  };
  for (const Bytes& bytes : {stream.DracoForm(), stream.CustomForm()}) {
    const StatusOr<DecodedMesh> decoded = DecodeMesh(bytes, {});
    ASSERT_TRUE(decoded.ok()) << decoded.status().message();
    EXPECT_TRUE(decoded.value().refinement.ok()) << decoded.value().refinement.message();
    EXPECT_EQ(decoded.value().mesh.triangles.size(), 6u * 64);
    EXPECT_TRUE(SameBits(decoded.value().mesh.positions, ExpectedLevel(stream, 3).positions));
    EXPECT_EQ(num_at_taken_places(decoded.value().mesh), 18);
  }
  EXPECT_LT(num_at_taken_places(DecodeMesh(apart.DracoForm(), {}).value().mesh), 12);
}

TEST(DecodeMeshTest, StopsAtMaxLevel) {
  const ProgressiveStream stream = MakeProgressiveStream(Octahedron(), 3);
  for (const Bytes& bytes : {stream.DracoForm(), stream.CustomForm()}) {
    for (int level = 0; level <= 4; ++level) {
      DecodeOptions options;
      options.max_level = level;
      const DecodedMesh decoded = DecodeMesh(bytes, options).value();
      EXPECT_TRUE(decoded.refinement.ok()) << decoded.refinement.message();
      EXPECT_EQ(decoded.level, std::min(level, 3));
      EXPECT_EQ(decoded.num_levels, 3);
      EXPECT_TRUE(SameBits(decoded.mesh.positions, ExpectedLevel(stream, std::min(level, 3)).positions));
    }
  }
  DecodeOptions options;
  options.max_level = -1;
  EXPECT_EQ(DecodeMesh(stream.DracoForm(), options).status().code(), StatusCode::kInvalidArgument);
}

TEST(DecodeMeshTest, EveryPrefixDecodesToItsLastCompleteLevel) {
  const ProgressiveStream stream = MakeProgressiveStream(Octahedron(), 3);
  for (const bool custom : {false, true}) {
    const Bytes bytes = custom ? stream.CustomForm() : stream.DracoForm();
    const size_t wrapping = bytes.size() - stream.DracoForm().size();
    for (size_t size = 0; size <= bytes.size(); ++size) {
      int expected = -1;
      size_t end = wrapping;
      for (const size_t part : stream.part_sizes) expected += size >= (end += part);
      const StatusOr<DecodedMesh> decoded = DecodePrefix(bytes, size);
      ASSERT_EQ(decoded.ok(), expected >= 0) << size;
      if (!decoded.ok()) {
        EXPECT_FALSE(decoded.status().message().empty());
        continue;
      }
      EXPECT_EQ(decoded.value().level, expected) << size;
      // A stream of the base alone is complete in itself; any other that ends early says so.
      const bool whole = size == bytes.size() || size == wrapping + stream.part_sizes[0];
      EXPECT_EQ(decoded.value().refinement.ok(), whole) << size;
      EXPECT_TRUE(SameBits(decoded.value().mesh.positions, ExpectedLevel(stream, expected).positions)) << size;
    }
  }
}

TEST(DecodeMeshTest, DecodesStockStreams) {
  const CodedZeroLevel coded = EncodeZeroLevel(Torus(6, 5).ToMesh(), 11).value();
  const DecodedMesh decoded = DecodeMesh(coded.stream, {}).value();
  EXPECT_TRUE(decoded.refinement.ok());
  EXPECT_EQ(decoded.level, 0);
  EXPECT_EQ(decoded.num_levels, 0);
  EXPECT_TRUE(SameBits(decoded.mesh.positions, coded.mesh.positions));
}

TEST(DecodeMeshTest, SaysWhyBytesAfterTheBaseAreNoRefinement) {
  Bytes bytes = EncodeBaseMesh(Octahedron()).value().stream;
  bytes.insert(bytes.end(), 40, uint8_t{0x55});
  const DecodedMesh decoded = DecodeMesh(bytes, {}).value();
  EXPECT_EQ(decoded.mesh.triangles.size(), 8u);
  EXPECT_EQ(decoded.refinement.code(), StatusCode::kInvalidData);
}

TEST(DecodeMeshTest, RefusesRefinementOfAnotherBase) {
  const ProgressiveStream stream = MakeProgressiveStream(Octahedron(), 2);
  Bytes bytes = EncodeBaseMesh(Torus(6, 5)).value().stream;
  bytes.insert(bytes.end(), stream.refinement.begin(), stream.refinement.end());
  const DecodedMesh decoded = DecodeMesh(bytes, {}).value();
  EXPECT_EQ(decoded.level, 0);
  EXPECT_EQ(decoded.mesh.triangles.size(), 60u);
  EXPECT_EQ(decoded.refinement.code(), StatusCode::kInvalidData);
}

TEST(DecodeMeshTest, KeepsToTheLimits) {
  const ProgressiveStream stream = MakeProgressiveStream(Octahedron(), 3);
  for (const Bytes& bytes : {stream.DracoForm(), stream.CustomForm()}) {
    DecodeOptions options;
    options.limits.max_triangles = 7;
    EXPECT_EQ(DecodeMesh(bytes, options).status().code(), StatusCode::kLimitExceeded);
    options.limits.max_triangles = 8;
    EXPECT_EQ(DecodeMesh(bytes, options).value().level, 0);
    EXPECT_EQ(DecodeMesh(bytes, options).value().refinement.code(), StatusCode::kLimitExceeded);
    options.limits.max_triangles = 8 * 16;
    EXPECT_EQ(DecodeMesh(bytes, options).value().level, 2);
    options.limits.max_triangles = 8 * 64;
    EXPECT_EQ(DecodeMesh(bytes, options).value().level, 3);
    options.limits.max_vertices = 5;
    EXPECT_EQ(DecodeMesh(bytes, options).status().code(), StatusCode::kLimitExceeded);
  }
}

TEST(DecodeMeshTest, RefusesWhatIsNoMeshStream) {
  EXPECT_EQ(DecodeMesh(Bytes(), {}).status().code(), StatusCode::kInvalidData);
  EXPECT_EQ(DecodeMesh(Bytes(100, uint8_t{0}), {}).status().code(), StatusCode::kInvalidData);
  const Bytes good = MakeProgressiveStream(Octahedron(), 1).DracoForm();
  const auto expect_unsupported = [&](size_t offset, uint8_t value, const char* reason) {
    Bytes bad = good;
    bad[offset] = value;
    const Status status = DecodeMesh(bad, {}).status();
    EXPECT_EQ(status.code(), StatusCode::kUnsupported);
    EXPECT_THAT(status.message(), HasSubstr(reason));
  };
  expect_unsupported(5, 3, "version 3.2");
  expect_unsupported(6, 1, "version 2.1");
  expect_unsupported(7, 0, "no triangle mesh");
  expect_unsupported(8, 77, "encoding method 77");
}

TEST(DecodeMeshTest, RefusesCountsThatTheBytesCannotHold) {
  // Header, traversal, 2^28 vertices and 2^28 triangles as varints: Draco would take gigabytes for them.
  const Bytes bomb = {'D',  'R',  'A',  'C',  'O', 2,    2,    1,    1,    0, 0, 0,
                      0x80, 0x80, 0x80, 0x80, 1,   0x80, 0x80, 0x80, 0x80, 1, 0, 0};
  DecodeOptions options;
  options.limits.max_vertices = options.limits.max_triangles = uint64_t{1} << 40;
  const Status status = DecodeMesh(bomb, options).status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidData);
  EXPECT_THAT(status.message(), HasSubstr("cannot hold"));
}

// Whatever one byte is changed to: decoded or refused, and what is decoded is sound.
void ExpectSoundOnMutations(const Bytes& good) {
  DecodeOptions options;
  options.limits.max_vertices = options.limits.max_triangles = 1 << 16;
  for (size_t offset = 0; offset < good.size(); ++offset) {
    for (int change = 1; change < 256; ++change) {
      Bytes bad = good;
      bad[offset] = static_cast<uint8_t>(bad[offset] ^ change);
      const StatusOr<DecodedMesh> decoded = DecodePrefix(bad, bad.size(), options);
      if (!decoded.ok()) {
        ASSERT_FALSE(decoded.status().message().empty());
        continue;
      }
      const TriangleMesh& mesh = decoded.value().mesh;
      for (const Triangle& t : mesh.triangles) {
        for (const uint32_t v : t) ASSERT_LT(v, mesh.positions.size());
      }
      for (const Vec3f& p : mesh.positions) ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    }
  }
}

TEST(DecodeMeshTest, SurvivesEveryChangedByteOfTheDracoForm) {
  ExpectSoundOnMutations(MakeProgressiveStream(Octahedron(), 2).DracoForm());
}

TEST(DecodeMeshTest, SurvivesEveryChangedByteOfTheCustomForm) {
  ExpectSoundOnMutations(MakeProgressiveStream(Octahedron(), 2).CustomForm());
  ExpectSoundOnMutations(MakeProgressiveStream(Octahedron(), 2, /*joined=*/false, BaseCoding::kCompact).CustomForm());
}

TEST(DecodeMeshTest, SurvivesEveryChangedByteOfASequentialStream) {
  TriangleMesh mesh = Octahedron().ToMesh();
  mesh.triangles.push_back({{0, 0, 1}});
  const CodedZeroLevel coded = EncodeZeroLevel(mesh, 9).value();
  ASSERT_TRUE(coded.sequential);
  ExpectSoundOnMutations(coded.stream);
}

}  // namespace
}  // namespace lacerta
