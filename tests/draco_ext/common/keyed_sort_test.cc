#include "common/keyed_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

namespace lacerta {
namespace {

// Keys of `bits` random bits each, the lowest of them and the highest, in the order of index.
std::vector<KeyedIndex> RandomTable(size_t size, int bits) {
  std::mt19937_64 random(17);
  std::vector<KeyedIndex> table(size);
  for (uint32_t i = 0; i < size; ++i) {
    const uint64_t low = random() >> (64 - bits), high = random() >> (64 - bits) << (64 - bits);
    table[i] = {low | high, i};
  }
  return table;
}

// Few items and many are sorted by different means.
class KeyedSort : public testing::TestWithParam<size_t> {};

TEST_P(KeyedSort, IsStable) {
  for (const int bits : {1, 3, 20}) {
    std::vector<KeyedIndex> table = RandomTable(GetParam(), bits), expected = table;
    std::stable_sort(expected.begin(), expected.end(), [](const KeyedIndex& a, const KeyedIndex& b) { return a.key < b.key; });
    SortKeyed(&table, 0, table.size());
    for (size_t i = 0; i < table.size(); ++i) {
      ASSERT_EQ(table[i].key, expected[i].key) << i;
      ASSERT_EQ(table[i].index, expected[i].index) << i;
    }
  }
}

TEST_P(KeyedSort, LeavesAloneWhatLiesOutside) {
  std::vector<KeyedIndex> table = RandomTable(GetParam() + 7, 20);
  const std::vector<KeyedIndex> before = table;
  SortKeyed(&table, 3, 3 + GetParam());
  for (const size_t i : {size_t{0}, size_t{2}, GetParam() + 3, GetParam() + 6}) EXPECT_EQ(table[i].index, before[i].index) << i;
}

TEST_P(KeyedSort, FindsTheFirstOfEachKey) {
  std::vector<KeyedIndex> table = RandomTable(GetParam(), 2);
  const std::vector<KeyedIndex> given = table;
  std::vector<uint32_t> first(table.size());
  FindFirstEqual(&table, 0, table.size(), &first);
  for (uint32_t i = 0; i < given.size(); ++i) {
    const auto same = [&](const KeyedIndex& other) { return other.key == given[i].key; };
    EXPECT_EQ(first[i], static_cast<uint32_t>(std::find_if(given.begin(), given.end(), same) - given.begin())) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, KeyedSort, testing::Values(0, 1, 2, 47, 48, 49, 1000));

}  // namespace
}  // namespace lacerta
