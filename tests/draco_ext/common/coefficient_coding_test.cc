#include "common/coefficient_coding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "common/length_classes.h"
#include "decoder/range_decoder.h"
#include "draco_ext/encoder/test_streams.h"
#include "encoder/range_encoder.h"

namespace lacerta {
namespace {

using ::lacerta::testing::Coefficients;
using ::lacerta::testing::Octahedron;
using ::lacerta::testing::RandomCoefficients;
using ::lacerta::testing::Square;
using ::lacerta::testing::Torus;

Topology TopologyOf(const BaseMesh& base) {
  return BuildTopology(static_cast<uint32_t>(base.lattice.size()), base.triangles).value();
}

// Codes all levels and decodes them again; returns the number of payload bytes.
size_t RoundTrip(const BaseMesh& base, const Coefficients& c, const std::vector<uint8_t>& length_classes = {}) {
  Topology t = TopologyOf(base);
  CodingState encoding, decoding;
  encoding.length_classes = decoding.length_classes = length_classes;
  size_t bytes = 0;
  for (size_t i = 0; i < c.levels.size(); ++i, t = Refine(t)) {
    QuantizedLevel kept = c.levels[i];
    RangeEncoder encoder;
    CodeLevel(t, c.steps[i], &encoding, &kept, &encoder);
    EXPECT_EQ(kept.normal, c.levels[i].normal);
    EXPECT_EQ(kept.tangential, c.levels[i].tangential);
    const Bytes payload = encoder.Finish();
    bytes += payload.size();

    QuantizedLevel decoded{std::vector<int32_t>(t.num_edges()), std::vector<int32_t>(size_t{2} * t.num_edges())};
    RangeDecoder decoder(payload);
    CodeLevel(t, c.steps[i], &decoding, &decoded, &decoder);
    EXPECT_EQ(decoded.normal, c.levels[i].normal) << "level " << i + 1;
    EXPECT_EQ(decoded.tangential, c.levels[i].tangential) << "level " << i + 1;
  }
  return bytes;
}

TEST(CoefficientCodingTest, RoundTripsEveryMagnitudeUpToTheLargest) {
  // One edge set of the torus at a time, filled with magnitudes around all powers of two, both signs.
  const BaseMesh base = Torus(5, 4);
  std::vector<int32_t> values = {0, kMaxMagnitude, -kMaxMagnitude, kMaxMagnitude - 1};
  for (int k = 0; k < 20; ++k) {
    for (int32_t d = -2; d <= 16; ++d) values.push_back(k % 2 ? (1 << k) + d : -(1 << k) - d);
  }
  Coefficients c = RandomCoefficients(base, 4, 1);
  size_t next = 0;
  for (QuantizedLevel& level : c.levels) {
    for (int32_t& q : level.normal) q = values[next++ % values.size()];
  }
  ASSERT_GT(next, values.size());
  RoundTrip(base, c);
}

TEST(CoefficientCodingTest, RoundTripsOnClosedAndOpenMeshes) {
  for (uint32_t seed = 0; seed < 10; ++seed) {
    for (const double scale : {0.02, 0.5, 5.0, 500.0}) {
      RoundTrip(Torus(6, 5), RandomCoefficients(Torus(6, 5), 3, seed, scale));
      RoundTrip(Octahedron(), RandomCoefficients(Octahedron(), 3, seed, scale));
      RoundTrip(Square(), RandomCoefficients(Square(), 4, seed, scale));
    }
  }
}

TEST(CoefficientCodingTest, SetWithoutStepCostsNothing) {
  Coefficients c = RandomCoefficients(Octahedron(), 3, 5);
  const size_t with_tangential = RoundTrip(Octahedron(), c);
  for (size_t i = 0; i < c.levels.size(); ++i) {
    c.steps[i].tangential_step = 0;
    c.levels[i].tangential.assign(c.levels[i].tangential.size(), 0);
  }
  EXPECT_LT(RoundTrip(Octahedron(), c), with_tangential);
  for (size_t i = 0; i < c.levels.size(); ++i) {
    c.steps[i].normal_step = 0;
    c.levels[i].normal.assign(c.levels[i].normal.size(), 0);
  }
  EXPECT_EQ(RoundTrip(Octahedron(), c), 0u);
}

TEST(CoefficientCodingTest, ContextsPayOff) {
  // Coefficients in one half of the torus and none in the other: neighbors and parents tell which half it is.
  const BaseMesh base = Torus(8, 6);
  Topology t = TopologyOf(base);
  std::vector<double> x;
  for (const auto& point : base.lattice) x.push_back(point[0]);
  Coefficients ordered = RandomCoefficients(base, 3, 9, 2.0);
  for (QuantizedLevel& level : ordered.levels) level.tangential.assign(level.tangential.size(), 0);
  Coefficients shuffled = ordered;
  std::mt19937 random(1);
  for (size_t i = 0; i < ordered.levels.size(); ++i, t = Refine(t)) {
    std::vector<int32_t>& normal = ordered.levels[i].normal;
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      x.push_back((x[t.edges[e][0]] + x[t.edges[e][1]]) / 2);
      if (x.back() > 0) normal[e] = 0;
    }
    shuffled.levels[i].normal = normal;
    std::shuffle(shuffled.levels[i].normal.begin(), shuffled.levels[i].normal.end(), random);
  }
  EXPECT_LT(static_cast<double>(RoundTrip(base, ordered)), 0.9 * static_cast<double>(RoundTrip(base, shuffled)));
}

TEST(CoefficientCodingTest, LengthClassesPayOff) {
  // One edge in three is long, and has the only coefficients, as have those that come from it.
  const BaseMesh base = Torus(8, 6);
  Topology t = TopologyOf(base);
  std::vector<uint8_t> classes(t.num_edges()), handed;
  for (uint32_t e = 0; e < t.num_edges(); e += 3) classes[e] = kLongLength;
  Coefficients c = RandomCoefficients(base, 3, 4, 1.0);
  handed = classes;
  for (QuantizedLevel& level : c.levels) {
    level.tangential.assign(level.tangential.size(), 0);
    for (uint32_t e = 0; e < t.num_edges(); ++e) level.normal[e] = handed[e] == kLongLength ? level.normal[e] : 0;
    handed = HandDown(t, handed);
    t = Refine(t);
  }
  EXPECT_LT(static_cast<double>(RoundTrip(base, c, classes)), 0.8 * static_cast<double>(RoundTrip(base, c)));
  EXPECT_GT(RoundTrip(base, c, classes), 0u);
}

TEST(CoefficientModelsTest, ActivityClassesGrowWithTheExpectedMagnitude) {
  EXPECT_EQ(ActivityClass(0), 0);
  EXPECT_EQ(ActivityClass(1), 1);
  EXPECT_EQ(ActivityClass(0xffffffffu), kNumActivityClasses - 1);
  for (uint32_t x = 0; x < 1000; ++x) EXPECT_LE(ActivityClass(x), ActivityClass(x + 1));
}

TEST(ForecastScaleTest, FollowsTheRatioOfSteps) {
  for (const float from : {1e-30f, 0.001f, 0.75f, 1.0f, 3.0f, 1e20f}) {
    for (const float ratio : {0.02f, 0.5f, 1.0f, 1.4f, 2.0f, 7.0f}) {
      const float a = RoundStep(from), b = RoundStep(from / ratio);
      for (const uint32_t magnitude : {0u, 1u, 16u, 1000u}) {
        const double exact = magnitude * (static_cast<double>(a) / b);
        EXPECT_LE(ForecastScale(a, b)({magnitude, -1}).magnitude, exact + 1e-9);
        EXPECT_GT(ForecastScale(a, b)({magnitude, -1}).magnitude, exact - 1 - exact / 128);
        EXPECT_EQ(ForecastScale(a, b)({magnitude, -1}).sign, -1);
      }
    }
  }
}

TEST(ForecastScaleTest, IsBoundedForAbsurdRatios) {
  const float tiny = StepFromBits(0x0080), huge = StepFromBits(0x7f7f);
  EXPECT_EQ(ForecastScale(tiny, huge)({65536, 1}).magnitude, 0u);
  EXPECT_EQ(ForecastScale(huge, tiny)({65536, 1}).magnitude, 65536u);
  EXPECT_EQ(ForecastScale(huge, tiny)({0, 1}).magnitude, 0u);
}

TEST(ForecastTest, ReachesTheFourChildrenOfAnEdge) {
  const Topology t = TopologyOf(Octahedron());
  CodedNeighbors neighbors(t);
  for (uint32_t e = 0; e < t.num_edges(); ++e) neighbors.Add(e, e == 3 ? -10 : 0);
  const std::vector<Forecast> finer = neighbors.ForecastFiner();
  ASSERT_EQ(finer.size(), Refine(t).edges.size());
  int children = 0;
  for (size_t e = 0; e < finer.size(); ++e) {
    if (finer[e].sign == 0) continue;
    ++children;
    EXPECT_EQ(finer[e].sign, -1);
    EXPECT_EQ(finer[e].magnitude, 8u * 40 / 8);
    const bool half = e / 2 == 3;
    const bool inner =
        e >= 2 * t.num_edges() && t.face_edges[(e - 2 * t.num_edges()) / 3][(e - 2 * t.num_edges()) % 3] == 3;
    EXPECT_TRUE(half || inner) << e;
  }
  EXPECT_EQ(children, 4);
}

}  // namespace
}  // namespace lacerta
