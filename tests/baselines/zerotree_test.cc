#include "baselines/zerotree.h"

#include <gmock/gmock.h>

#include <random>

#include "common/coefficient_models.h"
#include "shapes/shapes.h"

namespace lacerta::baselines {
namespace {

EdgeTrees Trees(int num_levels) {
  const TriangleMesh mesh = shapes::Icosphere(0);
  std::vector<Topology> levels = {BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles).value()};
  while (static_cast<int>(levels.size()) < num_levels) levels.push_back(Refine(levels.back()));
  return BuildEdgeTrees(levels);
}

// What details look like: most are zero, the finer the smaller.
std::vector<int32_t> Details(const EdgeTrees& trees, double scale, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<int32_t> values;
  for (int level = 0; level < trees.num_levels(); ++level, scale /= 3) {
    std::exponential_distribution<double> magnitude(1 / scale);
    while (values.size() < trees.first[level + 1])
      values.push_back(static_cast<int32_t>(magnitude(random)) * (random() % 2 ? 1 : -1));
  }
  return values;
}

TEST(Zerotree, WholeStreamsComeBack) {
  const EdgeTrees trees = Trees(4);
  for (const double scale : {0.1, 3.0, 1000.0}) {
    const std::vector<std::vector<int32_t>> sets = {Details(trees, scale, 1), Details(trees, scale / 50, 2)};
    const auto known = DecodeZerotrees(trees, 2, EncodeZerotrees(trees, sets));
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(known[i].values, sets[i]);
      EXPECT_THAT(known[i].unknown_bits, testing::Each(0));
    }
  }
}

TEST(Zerotree, ZerosTakeNoBytes) {
  const EdgeTrees trees = Trees(3);
  const std::vector<int32_t> zeros(trees.num_nodes(), 0);
  EXPECT_EQ(EncodeZerotrees(trees, {zeros}).size(), 1u);
  EXPECT_EQ(DecodeZerotrees(trees, 1, EncodeZerotrees(trees, {zeros}))[0].values, zeros);
}

TEST(Zerotree, EveryTruncationDecodesToWhatWasCoded) {
  const EdgeTrees trees = Trees(3);
  const std::vector<std::vector<int32_t>> sets = {Details(trees, 20, 3), Details(trees, 2, 4)};
  const Bytes whole = EncodeZerotrees(trees, sets);
  uint64_t last_unknown = ~uint64_t{0}, decisions = 0;
  for (; last_unknown > 0; ++decisions) {
    const auto from_cut = DecodeZerotrees(trees, 2, EncodeZerotrees(trees, sets, decisions), decisions);
    const auto from_whole = DecodeZerotrees(trees, 2, whole, decisions);
    uint64_t unknown = 0;
    for (int i = 0; i < 2; ++i) {
      ASSERT_EQ(from_cut[i].values, from_whole[i].values) << decisions;
      ASSERT_EQ(from_cut[i].unknown_bits, from_whole[i].unknown_bits) << decisions;
      for (uint32_t n = 0; n < trees.num_nodes(); ++n) {
        const uint32_t magnitude = Magnitude(sets[i][n]), low = Magnitude(from_cut[i].values[n]);
        const int bits = from_cut[i].unknown_bits[n];
        ASSERT_EQ(magnitude >> bits, low >> bits) << decisions << " decisions, node " << n;
        ASSERT_TRUE(low == 0 || (from_cut[i].values[n] < 0) == (sets[i][n] < 0));
        unknown += static_cast<uint64_t>(bits);
      }
    }
    ASSERT_LE(unknown, last_unknown);  // no decision takes back what an earlier one told
    last_unknown = unknown;
  }
  EXPECT_GT(decisions, 1000u);
  EXPECT_EQ(DecodeZerotrees(trees, 2, whole, decisions)[0].values, sets[0]);
}

// Trees are what makes it small: a lone root among many zeros costs little, and less than the same value among leaves.
TEST(Zerotree, LoneRootsAreCheap) {
  const EdgeTrees trees = Trees(6);
  std::vector<int32_t> root(trees.num_nodes(), 0), leaf = root;
  root[0] = 1;
  leaf.back() = 1;
  const size_t root_bytes = EncodeZerotrees(trees, {root}).size(), leaf_bytes = EncodeZerotrees(trees, {leaf}).size();
  EXPECT_GE(root_bytes, 3u);
  EXPECT_LE(root_bytes, 8u);
  EXPECT_GT(leaf_bytes, root_bytes);
  EXPECT_LE(leaf_bytes, 20u);
}

}  // namespace
}  // namespace lacerta::baselines
