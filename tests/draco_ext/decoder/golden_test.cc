// Streams of every released version decode to the same mesh for ever: tests/golden/v<version>/*.lac, with base,
// coefficients and positions beside them as .json, from which tests/format/reference_decoder.py checks docs/format.md
// too. LACERTA_REGENERATE_GOLDEN=1 writes the files of the current version anew; do that only before the version is
// released.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "draco_ext/encoder/test_streams.h"
#include "encoder/stream_writer.h"
#include "lacerta/decoder.h"

namespace lacerta {
namespace {

using ::lacerta::testing::Coefficients;
using ::lacerta::testing::Curved;
using ::lacerta::testing::InLayers;
using ::lacerta::testing::LawfulSteps;
using ::lacerta::testing::Octahedron;
using ::lacerta::testing::OctahedronBesideStillSheets;
using ::lacerta::testing::OctahedronWithCrease;
using ::lacerta::testing::RandomCoefficients;
using ::lacerta::testing::Silence;
using ::lacerta::testing::Square;
using ::lacerta::testing::SquareWithCorners;
using ::lacerta::testing::TaggedBase;
using ::lacerta::testing::ThreeSheets;
using ::lacerta::testing::Torus;

struct Golden {
  const char* name;
  TaggedBase tagged;
  int num_levels;
  uint32_t seed;
  double scale;         // of the coefficients of level 1
  bool lawful = false;  // steps of the default mode, level 2 silent, the base step left out
  bool layered = false;  // in three rounds
  int num_curved = 0;
};

std::string PathOf(const Golden& golden, const char* extension) {
  return std::string(LACERTA_GOLDEN_DIR) + "/v1/" + golden.name + extension;
}

// The lattice and the triangles of a base, or the coefficients of a level: rows of numbers as JSON.
template <typename Row>
std::string Rows(const std::vector<Row>& rows) {
  std::ostringstream out;
  out.precision(9);
  for (size_t i = 0; i < rows.size(); ++i) {
    out << (i == 0 ? "[[" : ",[") << rows[i][0] << ',' << rows[i][1] << ',' << rows[i][2] << ']';
  }
  return out.str() + "]";
}

template <typename Value>
std::string List(const std::vector<Value>& values) {
  std::ostringstream out;
  out << "[";
  for (size_t i = 0; i < values.size(); ++i) out << (i == 0 ? "" : ",") << static_cast<int64_t>(values[i]);
  return out.str() + "]";
}

// Nothing where there are none.
std::string DescribeTags(const BaseTags& tags) {
  if (tags.empty()) return "";
  return ",\n\"tags\": {\"still\": " + List(tags.still) + ",\n\"crease\": " + List(tags.crease) + ",\n\"corner\": " + List(tags.corner) +
         ",\n\"joined\": " + List(tags.joined) + "}";
}

std::string Describe(const Golden& golden, const Coefficients& c, const std::vector<Vec3f>& positions) {
  const BaseMesh& base = golden.tagged.base;
  std::ostringstream out;
  out.precision(9);
  out << "{\"base\": {\"step\": " << base.step << ",\n\"lattice\": " << Rows(base.lattice) << ",\n\"triangles\": " << Rows(base.triangles)
      << DescribeTags(golden.tagged.tags) << "},\n\"levels\": [";
  for (size_t i = 0; i < c.levels.size(); ++i) {
    out << (i == 0 ? "" : ",") << "\n{\"normal\": " << List(c.levels[i].normal)
        << ",\n\"tangential\": " << List(c.levels[i].tangential) << "}";
  }
  std::vector<std::array<float, 3>> rows;
  for (const Vec3f& p : positions) rows.push_back({p.x, p.y, p.z});
  out << "],\n\"positions\": " << Rows(rows) << "}\n";
  return out.str();
}

std::string ReadFile(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  EXPECT_TRUE(in.good()) << "cannot read " << path;
  return {std::istreambuf_iterator<char>(in), {}};
}

void WriteFile(const std::string& path, const std::string& content) {
  std::ofstream out(path, std::ios::binary);
  out << content;
  ASSERT_TRUE(out.good()) << "cannot write " << path;
}

class GoldenTest : public ::testing::TestWithParam<Golden> {};

TEST_P(GoldenTest, DecodesAndIsWrittenAgain) {
  const Golden& golden = GetParam();
  const auto& [base, tags] = golden.tagged;
  Coefficients c = RandomCoefficients(base, golden.num_levels, golden.seed, golden.scale, tags);
  if (golden.lawful) {
    c.steps = LawfulSteps(c.steps.size());
    Silence(2, &c);
  }
  c = Curved(std::move(c), golden.num_curved);
  const BaseStepField base_step = golden.lawful ? BaseStepField::kLeftOut : BaseStepField::kWritten;
  const std::vector<Topology> topologies = BuildTopologies(base, golden.num_levels, tags).value();
  const Bytes written = golden.layered ? WriteLayers(base, topologies, c.steps, c.levels, InLayers(c), tags, base_step).value().bytes
                                       : WriteRefinement(base, c.steps, c.levels, tags, base_step).value().bytes;
  const RefinementResult again = DecodeRefinement(base, written, {}).value();
  if (std::getenv("LACERTA_REGENERATE_GOLDEN") != nullptr) {
    WriteFile(PathOf(golden, ".lac"), std::string(written.begin(), written.end()));
    WriteFile(PathOf(golden, ".json"), Describe(golden, c, again.mesh.positions));
  }
  const std::string file = ReadFile(PathOf(golden, ".lac"));
  const Bytes stored(file.begin(), file.end());
  EXPECT_EQ(stored, written) << "the writer of version 1 changed: streams in the field would not decode";
  const RefinementResult decoded = DecodeRefinement(base, stored, {}).value();
  EXPECT_TRUE(decoded.refinement.ok()) << decoded.refinement.message();
  EXPECT_EQ(decoded.level, golden.num_levels);
  EXPECT_EQ(decoded.bytes_used, stored.size());
  EXPECT_EQ(DescribeTags(decoded.mesh.tags), DescribeTags(tags));
  // Nine digits tell every binary32 apart.
  EXPECT_EQ(Describe(golden, c, decoded.mesh.positions), ReadFile(PathOf(golden, ".json")));
}

INSTANTIATE_TEST_SUITE_P(Version1, GoldenTest,
                         ::testing::Values(Golden{"octahedron_4_levels", {Octahedron()}, 4, 21, 6.0},
                                           Golden{"torus_regular_3_levels", {Torus(6, 5)}, 3, 22, 2.0},
                                           Golden{"square_border_4_levels", {Square()}, 4, 23, 3.0},
                                           Golden{"octahedron_large_coefficients", {Octahedron()}, 2, 24, 40000.0},
                                           Golden{"torus_mostly_zero", {Torus(8, 6)}, 3, 25, 0.3},
                                           Golden{"octahedron_crease", OctahedronWithCrease(), 3, 26, 4.0},
                                           Golden{"square_corners", SquareWithCorners(), 3, 27, 3.0},
                                           Golden{"octahedron_beside_still_sheets", OctahedronBesideStillSheets(), 3, 28, 4.0},
                                           Golden{"three_sheets_joined", ThreeSheets(), 3, 29, 3.0},
                                           Golden{"octahedron_silent_level", {Octahedron()}, 3, 30, 4.0, true},
                                           Golden{"torus_layers", {Torus(6, 5)}, 3, 31, 9.0, false, true},
                                           Golden{"octahedron_layers_silent_level", {Octahedron()}, 4, 32, 12.0, true, true},
                                           Golden{"three_sheets_layers", ThreeSheets(), 3, 33, 6.0, false, true},
                                           Golden{"torus_curved", {Torus(6, 5)}, 3, 34, 2.0, false, false, 3},
                                           Golden{"octahedron_crease_curved", OctahedronWithCrease(), 3, 35, 4.0, false, false, 2},
                                           Golden{"octahedron_layers_silent_level_curved", {Octahedron()}, 4, 36, 12.0, true, true, 3}),
                         [](const auto& golden) { return std::string(golden.param.name); });

}  // namespace
}  // namespace lacerta
