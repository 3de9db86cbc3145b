#include "common/base_tags_coding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "common/stream_layout.h"
#include "decoder/range_decoder.h"
#include "draco_ext/encoder/test_streams.h"
#include "encoder/range_encoder.h"
#include "shapes/base_meshes.h"

namespace lacerta {
namespace {

using ::lacerta::testing::OctahedronBesideStillSheets;
using ::lacerta::testing::TaggedBase;
using ::lacerta::testing::TaggedBases;
using ::lacerta::testing::ThreeSheets;
using ::lacerta::testing::Torus;
using ::testing::HasSubstr;

Bytes Encode(const BaseMesh& base, BaseTags tags) {
  RangeEncoder encoder;
  EXPECT_TRUE(CodeBaseTags(base.lattice, base.triangles, &tags, &encoder).ok());
  return encoder.Finish();
}

StatusOr<Topology> Decode(const BaseMesh& base, const Bytes& payload, BaseTags* tags) {
  RangeDecoder decoder(payload);
  return CodeBaseTags(base.lattice, base.triangles, tags, &decoder);
}

void ExpectSame(const BaseTags& a, const BaseTags& b) {
  EXPECT_EQ(a.still, b.still);
  EXPECT_EQ(a.crease, b.crease);
  EXPECT_EQ(a.corner, b.corner);
  EXPECT_EQ(a.joined, b.joined);
}

void ExpectRoundTrip(const BaseMesh& base, const BaseTags& tags) {
  BaseTags decoded;
  const StatusOr<Topology> t = Decode(base, Encode(base, tags), &decoded);
  ASSERT_TRUE(t.ok()) << t.status().message();
  ExpectSame(decoded, NormalizedTags(tags));
  const Topology expected = BuildTopology(static_cast<uint32_t>(base.lattice.size()), base.triangles, tags).value();
  EXPECT_EQ(t.value().triangles, expected.triangles);
  EXPECT_EQ(t.value().edges, expected.edges);
  EXPECT_EQ(t.value().on_curve, expected.on_curve);
  EXPECT_EQ(t.value().role, expected.role);
  if (!tags.joined.empty()) {
    EXPECT_EQ(t.value().master, expected.master);
  }
}

TEST(CodeBaseTagsTest, RoundTripsEachKind) {
  for (const TaggedBase& tagged : TaggedBases()) ExpectRoundTrip(tagged.base, tagged.tags);
  ExpectRoundTrip(Torus(4, 3), {});
}

TEST(CodeBaseTagsTest, RoundTripsAllKindsAtRandom) {
  std::mt19937 random(7);
  for (const uint32_t one_in : {2u, 5u, 40u}) {
    const BaseMesh base = Torus(9, 8);
    BaseTags tags;
    tags.still.assign(base.triangles.size(), 0);
    for (size_t f = 0; f < 4; ++f) tags.still[f] = 1;  // a hole with one fan at each vertex
    const Topology t = BuildTopology(72, base.triangles, tags).value();
    for (uint32_t e = 0; e < t.num_edges(); ++e) tags.crease.push_back(!t.is_border(e) && random() % one_in == 0);
    BaseTags without_corners = tags;
    const Topology curves = BuildTopology(72, base.triangles, without_corners).value();
    for (const CurveRole role : curves.role) tags.corner.push_back(role == CurveRole::kCurve && random() % one_in == 0);
    ExpectRoundTrip(base, tags);
  }
}

TEST(CodeBaseTagsTest, FlagsWhereNoneCanBeAreLeftOut) {
  const BaseMesh base = testing::Square();
  BaseTags tags;
  tags.crease = {1, 1, 1, 1, 1};
  tags.corner = {1, 1, 1, 1};
  BaseTags decoded;
  const Topology t = Decode(base, Encode(base, tags), &decoded).value();
  for (uint32_t e = 0; e < t.num_edges(); ++e) EXPECT_EQ(decoded.crease[e], t.is_border(e) ? 0 : 1);
  // Both ends of the diagonal have three curve edges: corners, told or not.
  EXPECT_EQ(decoded.corner, (std::vector<uint8_t>{0, 1, 0, 1}));
  EXPECT_EQ(t.role, std::vector<CurveRole>(4, CurveRole::kCorner));
}

TEST(CodeBaseTagsTest, OneLongCreaseCostsLessThanABitPerEdge) {
  const TriangleMesh mesh = shapes::Torus(40, 40);
  BaseMesh base{1.0f, std::vector<std::array<int32_t, 3>>(mesh.positions.size()), mesh.triangles};
  for (size_t v = 0; v < base.lattice.size(); ++v) base.lattice[v] = {static_cast<int32_t>(v), 0, 0};
  const Topology t = shapes::TopologyOf(mesh);
  BaseTags tags;
  size_t num_creases = 0;
  for (const auto& [a, b] : t.edges) {
    tags.crease.push_back(a < 40 && b < 40);  // the first row
    num_creases += tags.crease.back();
  }
  ASSERT_EQ(num_creases, 40u);
  ExpectRoundTrip(base, tags);
  const size_t bits = 8 * Encode(base, tags).size();
  EXPECT_LE(bits, 480u);  // of 4,800 edges
  EXPECT_GE(bits, 40u);
}

TEST(CodeBaseTagsTest, AnyPayloadGivesTagsThatAreWrittenAgainAsTheyAre) {
  std::mt19937 random(3);
  int refused = 0, kept = 0;
  for (int i = 0; i < 2000; ++i) {
    const TaggedBase tagged = i % 2 == 0 ? ThreeSheets() : TaggedBase{Torus(5, 4)};
    Bytes payload(random() % 24);
    for (uint8_t& byte : payload) byte = static_cast<uint8_t>(random());
    BaseTags tags;
    const StatusOr<Topology> t = Decode(tagged.base, payload, &tags);
    if (!t.ok()) {
      EXPECT_EQ(t.status().code(), StatusCode::kInvalidData);
      ++refused;
      continue;
    }
    ++kept;
    ExpectSame(tags, NormalizedTags(tags));
    ExpectRoundTrip(tagged.base, tags);
    EXPECT_LE(Encode(tagged.base, tags).size(), MaxTagBytes(tagged.base.lattice.size(), tagged.base.triangles.size()));
  }
  EXPECT_GE(refused, 100);  // split triangles that meet in a vertex only
  EXPECT_GE(kept, 500);
}

TEST(CodeBaseTagsTest, RefusesBasesOfStillTrianglesOnly) {
  const BaseMesh base = testing::Octahedron();
  BaseTags tags;
  tags.still.assign(8, 1);
  RangeEncoder encoder;
  const StatusOr<Topology> t = CodeBaseTags(base.lattice, base.triangles, &tags, &encoder);
  ASSERT_FALSE(t.ok());
  EXPECT_THAT(t.status().message(), HasSubstr("nothing to refine"));
  BaseTags decoded;
  EXPECT_FALSE(Decode(base, {}, &decoded).ok());  // zeros without end are ones
}

TEST(FirstAtSamePointTest, FindsTheFirst) {
  const std::vector<std::array<int32_t, 3>> lattice = {{{5, 0, 0}}, {{1, 2, 3}}, {{5, 0, 0}}, {{1, 2, -3}}, {{1, 2, 3}}, {{5, 0, 0}}};
  const std::vector<uint32_t> first = FirstAtSamePoint(lattice);
  EXPECT_EQ(first, (std::vector<uint32_t>{0, 1, 0, 3, 1, 0}));
  EXPECT_TRUE(JoinsAnything(first));
  EXPECT_FALSE(JoinsAnything(FirstAtSamePoint(Span<const std::array<int32_t, 3>>(lattice).First(2))));
}

TEST(WithStillTrianglesTest, PutsThemLastInTheOrderOfTheBase) {
  const auto [base, tags] = OctahedronBesideStillSheets();
  const std::vector<Triangle> all = WithStillTriangles({{{9, 9, 9}}}, base.triangles, tags);
  EXPECT_EQ(all, (std::vector<Triangle>{{{9, 9, 9}}, {{6, 7, 8}}, {{6, 7, 9}}, {{6, 7, 10}}}));
  EXPECT_EQ(NumStill(tags), 3u);
}

}  // namespace
}  // namespace lacerta
