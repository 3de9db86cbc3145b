#include "encoder/stream_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

#include "decoder/stream_reader.h"
#include "decoder/synthesis.h"
#include "draco_ext/encoder/test_streams.h"

namespace lacerta {
namespace {

using ::lacerta::testing::Coefficients;
using ::lacerta::testing::Curved;
using ::lacerta::testing::LawfulSteps;
using ::lacerta::testing::Octahedron;
using ::lacerta::testing::RandomCoefficients;
using ::lacerta::testing::Square;
using ::lacerta::testing::TaggedBase;
using ::lacerta::testing::TaggedBases;
using ::lacerta::testing::ThreeSheets;
using ::lacerta::testing::Torus;
using ::testing::HasSubstr;

// What a decoder of these coefficients must arrive at.
std::vector<Vec3f> Synthesize(const BaseMesh& base, const Coefficients& c, const BaseTags& tags) {
  const std::vector<Topology> topologies = BuildTopologies(base, static_cast<int>(c.levels.size()), tags).value();
  std::vector<Vec3f> positions = base.ToMesh().positions;
  for (size_t i = 0; i < c.levels.size(); ++i) {
    SynthesizeLevel(topologies[i], StencilTable(topologies[i]), c.steps[i], c.levels[i], &positions);
  }
  return positions;
}

void ExpectRoundTrip(const BaseMesh& base, const Coefficients& c, const BaseTags& tags = {}) {
  const StatusOr<RefinementBytes> written = WriteRefinement(base, c.steps, c.levels, tags);
  ASSERT_TRUE(written.ok()) << written.status().message();
  const RefinementBytes& refinement = written.value();
  EXPECT_EQ(refinement.part_sizes.size(), c.levels.size());
  EXPECT_EQ(std::accumulate(refinement.part_sizes.begin(), refinement.part_sizes.end(), size_t{0}),
            refinement.bytes.size());
  const StatusOr<RefinementResult> decoded = DecodeRefinement(base, refinement.bytes, {});
  ASSERT_TRUE(decoded.ok()) << decoded.status().message();
  EXPECT_TRUE(decoded.value().refinement.ok()) << decoded.value().refinement.message();
  EXPECT_EQ(decoded.value().level, static_cast<int>(c.levels.size()));
  EXPECT_EQ(decoded.value().bytes_used, refinement.bytes.size());
  const SemiRegularMesh& mesh = decoded.value().mesh;
  EXPECT_EQ(mesh.positions, Synthesize(base, c, tags));
  EXPECT_EQ(mesh.tags.still, tags.still);
  EXPECT_EQ(mesh.tags.crease, tags.crease);
  EXPECT_EQ(mesh.tags.corner, tags.corner);
  EXPECT_EQ(mesh.tags.joined, tags.joined);
}

TEST(StreamWriterTest, RoundTripsClosedMeshes) {
  ExpectRoundTrip(Octahedron(), RandomCoefficients(Octahedron(), 4, 1));
  ExpectRoundTrip(Torus(6, 5), RandomCoefficients(Torus(6, 5), 3, 2));
}

TEST(StreamWriterTest, RoundTripsMeshWithBorder) { ExpectRoundTrip(Square(), RandomCoefficients(Square(), 4, 3)); }

TEST(StreamWriterTest, RoundTripsLargeCoefficients) {
  ExpectRoundTrip(Octahedron(), RandomCoefficients(Octahedron(), 3, 4, 30000));
}

TEST(StreamWriterTest, RoundTripsTags) {
  for (const TaggedBase& tagged : TaggedBases()) {
    ExpectRoundTrip(tagged.base, RandomCoefficients(tagged.base, 3, 6, 4.0, tagged.tags), tagged.tags);
  }
}

TEST(StreamWriterTest, RoundTripsCurvedLevels) {
  for (int num_curved = 1; num_curved <= 3; ++num_curved) {
    for (const TaggedBase& tagged : TaggedBases()) {
      const Coefficients plain = RandomCoefficients(tagged.base, 3, 6, 4.0, tagged.tags), curved = Curved(plain, num_curved);
      ExpectRoundTrip(tagged.base, curved, tagged.tags);
      const Bytes bytes = WriteRefinement(tagged.base, curved.steps, curved.levels, tagged.tags).value().bytes;
      EXPECT_EQ(bytes.size(), WriteRefinement(tagged.base, plain.steps, plain.levels, tagged.tags).value().bytes.size());
    }
  }
  const Coefficients plain = RandomCoefficients(Torus(6, 5), 3, 6);
  EXPECT_FALSE(Synthesize(Torus(6, 5), Curved(plain, 1), {}) == Synthesize(Torus(6, 5), plain, {}));
}

TEST(StreamWriterTest, MoreCurvedLevelsThanLevelsAreRefused) {
  const Coefficients c = Curved(RandomCoefficients(Octahedron(), 2, 6), 2);
  Bytes bytes = WriteRefinement(Octahedron(), c.steps, c.levels).value().bytes;
  ASSERT_EQ(bytes[3], 1 | 2 << 4);
  EXPECT_TRUE(DecodeRefinement(Octahedron(), bytes, {}).value().refinement.ok());
  bytes[3] = 1 | 3 << 4;
  EXPECT_THAT(DecodeRefinement(Octahedron(), bytes, {}).value().refinement.message(), HasSubstr("3 curved levels of 2"));
}

TEST(StreamWriterTest, TagsOfNothingCostNothing) {
  const Coefficients c = RandomCoefficients(Octahedron(), 2, 7);
  const BaseTags nothing = {std::vector<uint8_t>(8), std::vector<uint8_t>(12), std::vector<uint8_t>(6), {0, 1, 2, 3, 4, 5}};
  EXPECT_EQ(WriteRefinement(Octahedron(), c.steps, c.levels, nothing).value().bytes,
            WriteRefinement(Octahedron(), c.steps, c.levels).value().bytes);
}

TEST(StreamWriterTest, RefusesTagsThatDoNotFit) {
  const auto [base, tags] = ThreeSheets();
  Coefficients c = RandomCoefficients(base, 1, 5, 4.0, tags);
  const auto message = [&](const BaseMesh& b, const BaseTags& t) {
    const StatusOr<RefinementBytes> written = WriteRefinement(b, c.steps, c.levels, t);
    return written.ok() ? "" : written.status().message();
  };
  EXPECT_EQ(message(base, tags), "");
  BaseMesh apart = base;
  apart.lattice[4][0] += 1;
  BaseMesh touching = base;
  touching.lattice[2] = touching.lattice[7];  // no border edge is joined that was not
  EXPECT_EQ(message(touching, tags), "");
  touching.lattice[3] = touching.lattice[6];
  EXPECT_THAT(message(touching, tags), HasSubstr("take a smaller step"));
  EXPECT_THAT(message(apart, tags), HasSubstr("borders are joined on the base lattice"));
  const std::vector<Topology> topologies = BuildTopologies(base, 1, tags).value();
  EXPECT_THAT(WriteRefinement(base, topologies, c.steps, c.levels).status().message(), HasSubstr("not those of the topologies"));
  BaseTags still = tags;
  still.still.assign(6, 1);
  EXPECT_THAT(message(base, still), HasSubstr("nothing to refine"));
  BaseTags longer = tags;
  longer.corner.assign(13, 1);
  EXPECT_THAT(message(base, longer), HasSubstr("corners are not as many as the vertices"));
  const Topology t = BuildTopology(12, base.triangles, tags).value();
  const auto copy = std::find_if(t.master.begin(), t.master.end(), [](uint32_t m) { return m != kNone; });
  c.levels[0].normal[static_cast<size_t>(copy - t.master.begin())] = 1;
  EXPECT_THAT(message(base, tags), HasSubstr("is a copy and has coefficients"));
}

TEST(StreamWriterTest, NoLevelNoByte) {
  const RefinementBytes refinement = WriteRefinement(Octahedron(), {}, {}).value();
  EXPECT_TRUE(refinement.bytes.empty());
  EXPECT_TRUE(refinement.part_sizes.empty());
}

TEST(StreamWriterTest, FixedOverheadIsSmall) {
  // Five levels by the default mode's law: 3 + 1 mark and version, 1 levels, 2 base step, 2 checksum of the base, 3 flags of levels, 2 first
  // step, 2 checksum; 5 times length (1) and checksum (2), and zeros, which cost a few bits.
  const BaseMesh base = Torus(10, 20);
  Coefficients c = RandomCoefficients(base, 5, 1, 0.0);
  c.steps = LawfulSteps(5);
  const size_t size = WriteRefinement(base, c.steps, c.levels).value().bytes.size();
  EXPECT_GE(size, 16u + 15u);
  EXPECT_LE(size, 16u + 15u + 5 * 12u);
  EXPECT_EQ(WriteRefinement(base, c.steps, c.levels, {}, BaseStepField::kLeftOut).value().bytes.size(), size - 2);
  c.steps[2] = {};
  c.steps[4] = {};
  const RefinementBytes sparse = WriteRefinement(base, c.steps, c.levels).value();
  EXPECT_EQ(sparse.part_sizes[2], 0u);
  EXPECT_EQ(sparse.part_sizes[4], 0u);
  EXPECT_LE(sparse.bytes.size(), size - 6);
  ExpectRoundTrip(base, c);
  for (LevelSteps& steps : c.steps) steps = {};
  EXPECT_EQ(WriteRefinement(base, c.steps, c.levels).value().bytes.size(), 16u);
  ExpectRoundTrip(base, c);
}

TEST(StreamWriterTest, StepsOfEveryKindRoundTrip) {
  const BaseMesh base = Octahedron();
  std::mt19937 random(31);
  const auto any_step = [&]() -> float {
    const uint32_t kind = random() % 8;
    if (kind < 2) return 0.0f;
    if (kind == 2) return StepFromBits(0x7f7f);
    if (kind == 3) return StepFromBits(0x0080);
    return StepFromBits(static_cast<uint16_t>(0x0080 + random() % (kind == 4 ? 0x7f00 : 0x100) + (kind == 4 ? 0 : 0x3e00)));
  };
  for (int trial = 0; trial < 2000; ++trial) {
    const int num_levels = 1 + static_cast<int>(random() % 3);
    Coefficients c = RandomCoefficients(base, num_levels, 1, 0.0);
    c.steps = LawfulSteps(static_cast<size_t>(num_levels));
    c = Curved(std::move(c), static_cast<int>(random() % static_cast<uint32_t>(num_levels + 1)));
    for (LevelSteps& s : c.steps) {
      if (random() % 2 == 0) s.normal_step = any_step();
      if (random() % 2 == 0) s.tangential_step = any_step();
      s.normal_bias = static_cast<uint8_t>(s.normal_step > 0 ? random() % 3 : 0);
      s.tangential_bias = static_cast<uint8_t>(s.tangential_step > 0 ? random() % 3 : 0);
    }
    const Bytes bytes = WriteRefinement(base, c.steps, c.levels).value().bytes;
    const std::vector<LevelSteps> read = ReadRefinementHeader(bytes).value()->header.steps;
    ASSERT_EQ(read.size(), c.steps.size());
    for (size_t i = 0; i < read.size(); ++i) {
      EXPECT_EQ(read[i].normal_step, c.steps[i].normal_step) << trial;
      EXPECT_EQ(read[i].tangential_step, c.steps[i].tangential_step) << trial;
      EXPECT_EQ(read[i].normal_bias, c.steps[i].normal_bias) << trial;
      EXPECT_EQ(read[i].tangential_bias, c.steps[i].tangential_bias) << trial;
      EXPECT_EQ(read[i].is_curved, c.steps[i].is_curved) << trial;
    }
    ASSERT_EQ(DecodeRefinement(base, bytes, {}).value().level, num_levels) << trial;
  }
}

TEST(StreamWriterTest, LevelsBeforeTheFirstCodedOneCostNoDifference) {
  const BaseMesh base = Octahedron();
  Coefficients c = RandomCoefficients(base, 2, 1, 0.0);
  c.steps = LawfulSteps(2);
  const size_t both = ReadRefinementHeader(WriteRefinement(base, c.steps, c.levels).value().bytes).value()->size;
  c.steps[0] = {};
  EXPECT_EQ(ReadRefinementHeader(WriteRefinement(base, c.steps, c.levels).value().bytes).value()->size, both);
  c.steps[1].normal_step = 0;
  EXPECT_EQ(ReadRefinementHeader(WriteRefinement(base, c.steps, c.levels).value().bytes).value()->size, both);
}

TEST(StreamWriterTest, RefusesWhatAStreamCannotHold) {
  const BaseMesh base = Octahedron();
  const Coefficients good = RandomCoefficients(base, 2, 5);
  const auto refusal = [&](const Coefficients& c) {
    return WriteRefinement(base, c.steps, c.levels).status().message();
  };
  ASSERT_EQ(refusal(good), "");

  Coefficients c = good;
  c.steps.pop_back();
  EXPECT_THAT(refusal(c), HasSubstr("differ"));
  c = good;
  c.steps[1].is_curved = true;
  EXPECT_THAT(refusal(c), HasSubstr("level 2 is curved, and a coarser one is not"));
  c = good;
  c.levels[1].normal.pop_back();
  EXPECT_THAT(refusal(c), HasSubstr("normal set of level 2 has 47 coefficients, not 48"));
  c = good;
  c.levels[0].tangential.push_back(0);
  EXPECT_THAT(refusal(c), HasSubstr("tangential set of level 1 has 25 coefficients, not 24"));
  c = good;
  c.steps[0].normal_step = 0.1f;
  EXPECT_THAT(refusal(c), HasSubstr("not rounded"));
  c.steps[0].normal_step = -0.5f;
  EXPECT_THAT(refusal(c), HasSubstr("not rounded"));
  BaseMesh fine = base;
  fine.step = 0.1f;
  EXPECT_THAT(WriteRefinement(fine, good.steps, good.levels).status().message(), HasSubstr("8 significant bits"));
  c = good;
  c.steps[0].normal_bias = 16;
  EXPECT_THAT(refusal(c), HasSubstr("bias over 15"));
  c = good;
  c.levels[1].normal[7] = -kMaxMagnitude - 1;
  EXPECT_THAT(refusal(c), HasSubstr("take a larger step"));
  c.levels[1].normal[7] = std::numeric_limits<int32_t>::min();
  EXPECT_THAT(refusal(c), HasSubstr("magnitude 2147483648"));
  c = good;
  c.levels[1].tangential[0] = 1;  // its step is 0
  EXPECT_THAT(refusal(c), HasSubstr("but no step"));
}

TEST(BuildTopologiesTest, RefusesWhatCannotBeRefined) {
  EXPECT_EQ(BuildTopologies(Octahedron(), 3).value().size(), 3u);
  EXPECT_EQ(BuildTopologies(Octahedron(), 3).value()[2].num_edges(), 12u * 16);
  EXPECT_EQ(BuildTopologies(Octahedron(), 13).status().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(BuildTopologies(Octahedron(), -1).status().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(BuildTopologies(Torus(20, 20), 12).status().code(), StatusCode::kInvalidArgument);  // 2e10 edges
  BaseMesh fans = Octahedron();
  fans.triangles.push_back({0, 1, 2});
  EXPECT_EQ(BuildTopologies(fans, 1).status().code(), StatusCode::kInvalidData);
}

}  // namespace
}  // namespace lacerta
