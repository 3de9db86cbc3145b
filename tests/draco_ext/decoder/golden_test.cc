// Streams of every released version decode to the same coefficients for ever: tests/golden/v<version>/*.lac.
// LACERTA_REGENERATE_GOLDEN=1 writes the files of the current version anew; do that only before the version is released.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "draco_ext/encoder/test_streams.h"
#include "encoder/stream_writer.h"
#include "lacerta/decoder.h"

namespace lacerta {
namespace {

using ::lacerta::testing::Coefficients;
using ::lacerta::testing::Octahedron;
using ::lacerta::testing::RandomCoefficients;
using ::lacerta::testing::Square;
using ::lacerta::testing::Torus;

struct Golden {
  const char* name;
  BaseMesh base;
  int num_levels;
  uint32_t seed;
  double scale;  // of the coefficients of level 1
};

std::string PathOf(const Golden& golden) { return std::string(LACERTA_GOLDEN_DIR) + "/v1/" + golden.name + ".lac"; }

class GoldenTest : public ::testing::TestWithParam<Golden> {};

TEST_P(GoldenTest, DecodesAndIsWrittenAgain) {
  const Golden& golden = GetParam();
  const Coefficients c = RandomCoefficients(golden.base, golden.num_levels, golden.seed, golden.scale);
  const Bytes written = WriteRefinement(golden.base, c.steps, c.levels).value().bytes;
  if (std::getenv("LACERTA_REGENERATE_GOLDEN") != nullptr) {
    std::ofstream out(PathOf(golden), std::ios::binary);
    out.write(reinterpret_cast<const char*>(written.data()), static_cast<std::streamsize>(written.size()));
    ASSERT_TRUE(out.good()) << "cannot write " << PathOf(golden);
  }
  std::ifstream in(PathOf(golden), std::ios::binary);
  ASSERT_TRUE(in.good()) << "cannot read " << PathOf(golden);
  const Bytes stored{std::istreambuf_iterator<char>(in), {}};
  const RefinementResult decoded = DecodeRefinement(golden.base, stored, {}).value();
  EXPECT_TRUE(decoded.refinement.ok()) << decoded.refinement.message();
  EXPECT_EQ(decoded.level, golden.num_levels);
  EXPECT_EQ(decoded.bytes_used, stored.size());
  EXPECT_EQ(stored, written) << "the writer of version 1 changed: streams in the field would not decode";
  const RefinementResult again = DecodeRefinement(golden.base, written, {}).value();
  EXPECT_EQ(decoded.mesh.positions, again.mesh.positions);
}

INSTANTIATE_TEST_SUITE_P(Version1, GoldenTest,
                         ::testing::Values(Golden{"octahedron_4_levels", Octahedron(), 4, 21, 6.0},
                                           Golden{"torus_regular_3_levels", Torus(6, 5), 3, 22, 2.0},
                                           Golden{"square_border_4_levels", Square(), 4, 23, 3.0},
                                           Golden{"octahedron_large_coefficients", Octahedron(), 2, 24, 40000.0},
                                           Golden{"torus_mostly_zero", Torus(8, 6), 3, 25, 0.3}),
                         [](const auto& golden) { return std::string(golden.param.name); });

}  // namespace
}  // namespace lacerta
