#include "fuzz/structured_input.h"

#include <gtest/gtest.h>

#include <string>

#include "fuzz/read_seed.h"
#include "lacerta/decoder.h"

namespace lacerta::fuzz {
namespace {

class StructuredInputOfSeed : public ::testing::TestWithParam<const char*> {};

TEST_P(StructuredInputOfSeed, IsTheSameTogetherAgain) {
  const Bytes seed = ReadSeed(GetParam());
  const auto parsed = StructuredInput::Parse(seed);
  ASSERT_TRUE(parsed.has_value());
  EXPECT_FALSE(parsed->segments.empty());
  EXPECT_TRUE(parsed->Join() == seed);
}

INSTANTIATE_TEST_SUITE_P(Seeds, StructuredInputOfSeed,
                         ::testing::Values("stream_reader_fuzzer/octahedron_4_levels.lac", "stream_reader_fuzzer/octahedron_attributes.lac",
                                           "stream_reader_fuzzer/octahedron_crease.lac", "draco_form_fuzzer/custom_form.drc",
                                           "draco_form_fuzzer/draco_form.drc", "c_abi_fuzzer/custom_form_compact", "c_abi_fuzzer/groups",
                                           "glb_extension_fuzzer/levels.glb", "glb_extension_fuzzer/levels_and_layers.glb",
                                           "glb_extension_fuzzer/levels_of_groups.glb"));

TEST(StructuredInput, FindsTheCompactBase) {
  EXPECT_TRUE(StructuredInput::Parse(ReadSeed("c_abi_fuzzer/custom_form_compact"))->has_compact_base);
  EXPECT_FALSE(StructuredInput::Parse(ReadSeed("draco_form_fuzzer/draco_form.drc"))->has_compact_base);
}

TEST(StructuredInput, NothingWithoutARefinement) {
  EXPECT_FALSE(StructuredInput::Parse(ReadSeed("draco_form_fuzzer/torus.drc")).has_value());
  EXPECT_FALSE(StructuredInput::Parse(Bytes{}).has_value());
  Bytes cut = ReadSeed("stream_reader_fuzzer/octahedron_4_levels.lac");
  cut.resize(8);
  EXPECT_FALSE(StructuredInput::Parse(cut).has_value());
}

// What is left of a segment that is cut short stands behind the whole ones.
TEST(StructuredInput, KeepsWhatIsNoSegment) {
  Bytes cut = ReadSeed("stream_reader_fuzzer/octahedron_4_levels.lac");
  const size_t num_segments = StructuredInput::Parse(cut)->segments.size();
  cut.pop_back();
  const auto parsed = StructuredInput::Parse(cut);
  EXPECT_EQ(parsed->segments.size(), num_segments - 1);
  EXPECT_FALSE(parsed->after.empty());
  EXPECT_TRUE(parsed->Join() == cut);
}

}  // namespace
}  // namespace lacerta::fuzz
