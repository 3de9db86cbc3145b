#include "encoder/stream_writer.h"

#include <gtest/gtest.h>

#include <numeric>
#include <utility>

#include "decoder/synthesis.h"
#include "draco_ext/encoder/test_streams.h"

namespace lacerta {
namespace {

using ::lacerta::testing::Coefficients;
using ::lacerta::testing::Octahedron;
using ::lacerta::testing::RandomCoefficients;
using ::lacerta::testing::Square;
using ::lacerta::testing::Torus;

// What a decoder of these coefficients must arrive at.
std::vector<Vec3f> Synthesize(const BaseMesh& base, const Coefficients& c) {
  const std::vector<Topology> topologies = BuildTopologies(base, static_cast<int>(c.levels.size())).value();
  std::vector<Vec3f> positions = base.ToMesh().positions;
  for (size_t i = 0; i < c.levels.size(); ++i) {
    SynthesizeLevel(topologies[i], StencilTable(topologies[i]), c.steps[i], c.levels[i], &positions);
  }
  return positions;
}

void ExpectRoundTrip(const BaseMesh& base, const Coefficients& c) {
  const StatusOr<RefinementBytes> written = WriteRefinement(base, c.steps, c.levels);
  ASSERT_TRUE(written.ok()) << written.status().message();
  const RefinementBytes& refinement = written.value();
  EXPECT_EQ(refinement.part_sizes.size(), c.levels.size());
  EXPECT_EQ(std::accumulate(refinement.part_sizes.begin(), refinement.part_sizes.end(), size_t{0}), refinement.bytes.size());
  const StatusOr<RefinementResult> decoded = DecodeRefinement(base, refinement.bytes, {});
  ASSERT_TRUE(decoded.ok()) << decoded.status().message();
  EXPECT_TRUE(decoded.value().refinement.ok()) << decoded.value().refinement.message();
  EXPECT_EQ(decoded.value().level, static_cast<int>(c.levels.size()));
  EXPECT_EQ(decoded.value().bytes_used, refinement.bytes.size());
  EXPECT_EQ(decoded.value().mesh.positions, Synthesize(base, c));
}

TEST(StreamWriterTest, RoundTripsClosedMeshes) {
  ExpectRoundTrip(Octahedron(), RandomCoefficients(Octahedron(), 4, 1));
  ExpectRoundTrip(Torus(6, 5), RandomCoefficients(Torus(6, 5), 3, 2));
}

TEST(StreamWriterTest, RoundTripsMeshWithBorder) { ExpectRoundTrip(Square(), RandomCoefficients(Square(), 4, 3)); }

TEST(StreamWriterTest, RoundTripsLargeCoefficients) { ExpectRoundTrip(Octahedron(), RandomCoefficients(Octahedron(), 3, 4, 30000)); }

}  // namespace
}  // namespace lacerta
