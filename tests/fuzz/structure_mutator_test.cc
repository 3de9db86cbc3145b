#include "fuzz/structure_mutator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "decoder/stream_reader.h"
#include "draco_ext/encoder/test_streams.h"
#include "fuzz/read_seed.h"
#include "fuzz/structured_input.h"
#include "lacerta/decoder.h"

namespace lacerta::fuzz {
namespace {

constexpr uint32_t kTimes = 400;

// Stands in for libFuzzer's mutator: changes a byte, takes the last one away, or adds one.
size_t ChangeAByte(uint8_t* data, size_t size, size_t max_size) {
  static std::minstd_rand random;
  const auto kind = random() % 4;
  if (kind == 0 && size > 0) return size - 1;
  if ((kind == 1 || size == 0) && size < max_size) {
    data[size] = static_cast<uint8_t>(random());
    return size + 1;
  }
  data[random() % size] ^= static_cast<uint8_t>(1 + random() % 255);
  return size;
}

// How many of the inputs that `seed` becomes `is_so` of.
template <typename Is>
uint32_t CountMutations(const std::string& seed, size_t room, const Is& is_so) {
  const Bytes input = ReadSeed(seed);
  EXPECT_FALSE(input.empty());
  uint32_t count = 0;
  for (uint32_t i = 0; i < kTimes; ++i) {
    const Bytes changed = MutateStructure(input, input.size() + room, i, ChangeAByte);
    EXPECT_LE(changed.size(), input.size() + room);
    count += is_so(input, changed);
  }
  return count;
}

bool Differs(const Bytes& input, const Bytes& changed) { return input != changed; }

TEST(MutateStructure, ChangesAlmostEveryTime) {
  for (const char* seed : {"stream_reader_fuzzer/octahedron_4_levels.lac", "draco_form_fuzzer/torus.drc", "c_abi_fuzzer/custom_form_compact",
                           "glb_extension_fuzzer/levels.glb", "glb_extension_fuzzer/groups.glb"}) {
    EXPECT_GT(CountMutations(seed, 100, Differs), kTimes * 4 / 5) << seed;
    EXPECT_GT(CountMutations(seed, 0, Differs), kTimes / 2) << seed;
  }
}

// One time in two the structure is changed, of these two in eight the payload of a segment. By a byte changed anywhere hardly any of the
// checksums would be right.
TEST(MutateStructure, ReachesThePayloadsOfSegments) {
  const auto decodes_otherwise = [](const Bytes& input, const Bytes& changed) {
    const auto before = DecodeRefinement(testing::Octahedron(), input, {}), after = DecodeRefinement(testing::Octahedron(), changed, {});
    return after.ok() && after.value().refinement.ok() && after.value().level == before.value().level &&
           !(after.value().mesh.positions == before.value().mesh.positions);
  };
  const uint32_t count = CountMutations("stream_reader_fuzzer/octahedron_4_levels.lac", 100, decodes_otherwise);
  EXPECT_GT(count, kTimes / 16);
  EXPECT_LT(count, kTimes / 2);
}

TEST(MutateStructure, HeadersKeepTheirChecksum) {
  const auto has_another_header = [](const Bytes& input, const Bytes& changed) {
    const auto read = ReadRefinementHeader(changed);
    return read.ok() && read.value() && !std::equal(input.begin(), input.begin() + static_cast<ptrdiff_t>(read.value()->size), changed.begin());
  };
  EXPECT_GT(CountMutations("stream_reader_fuzzer/octahedron_4_levels.lac", 100, has_another_header), kTimes / 20);
}

// A refinement is refused beside another base than its own: the checksum of the base must follow it.
TEST(MutateStructure, RefinementsFollowTheirCompactBase) {
  const auto fits_another_base = [](const Bytes& input, const Bytes& changed) {
    const auto before = StructuredInput::Parse(input), after = StructuredInput::Parse(changed);
    if (!after || !after->has_compact_base || after->compact_base == before->compact_base) return false;
    const auto base = DecodeCompactBase(after->compact_base, {3000, 6000});
    if (!base.ok()) return false;
    Bytes refinement = after->Join();
    refinement.erase(refinement.begin(), std::search(refinement.begin(), refinement.end(), after->header.begin(), after->header.begin() + 5));
    const auto decoded = DecodeRefinement(base.value().mesh, refinement, {});
    return decoded.ok() && decoded.value().level > 0;
  };
  EXPECT_GT(CountMutations("c_abi_fuzzer/custom_form_compact", 100, fits_another_base), kTimes / 40);
}

// Lengths of a GLB's chunks are right though its JSON is another.
TEST(MutateStructure, GlbsStayWhole) {
  const auto is_whole = [](const Bytes& input, const Bytes& changed) {
    const auto word = [&](size_t at) { return changed[at] | changed[at + 1] << 8 | changed[at + 2] << 16 | changed[at + 3] << 24; };
    if (changed.size() < 20 || static_cast<size_t>(word(8)) != changed.size() || changed.size() == input.size()) return false;
    const auto json = static_cast<size_t>(word(12));
    return json + 28 <= changed.size() && static_cast<size_t>(word(20 + json)) == changed.size() - json - 28;
  };
  EXPECT_GT(CountMutations("glb_extension_fuzzer/groups.glb", 100, is_whole), kTimes / 20);
}

TEST(MutateStructure, TheSameSeedGivesTheSame) {
  const auto flip = [](uint8_t* data, size_t size, size_t) { return data[size / 2] ^= 1, size; };
  const Bytes input = ReadSeed("draco_form_fuzzer/draco_form.drc");
  bool differ = false;
  for (uint32_t seed = 0; seed < 50; ++seed) {
    const Bytes first = MutateStructure(input, 4096, seed, flip);
    EXPECT_TRUE(first == MutateStructure(input, 4096, seed, flip));
    differ = differ || first != MutateStructure(input, 4096, seed + 1, flip);
  }
  EXPECT_TRUE(differ);
}

TEST(MutateStructure, TakesAnythingAtAll) {
  std::minstd_rand random(7);
  for (uint32_t i = 0; i < kTimes; ++i) {
    Bytes input(random() % 40);
    for (uint8_t& byte : input) byte = static_cast<uint8_t>(random());
    constexpr char kHead[] = "glTF\2\0\0\0\x30\0\0\0\x08\0\0\0JSON";
    if (i % 2 == 0) std::copy_n(kHead, std::min<size_t>(input.size(), 20), input.begin());
    EXPECT_LE(MutateStructure(input, 64, i, ChangeAByte).size(), 64u);
  }
}

}  // namespace
}  // namespace lacerta::fuzz
