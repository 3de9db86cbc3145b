#include "common/large_array.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

namespace lacerta {
namespace {

constexpr size_t kMebi = size_t{1} << 20;

TEST(LargeArrayTest, HoldsZeros) {
  for (const size_t size : {size_t{0}, size_t{1}, 2 * kMebi - 1, 2 * kMebi, 5 * kMebi + 3}) {
    EXPECT_EQ(LargeArray<uint8_t>(size), std::vector<uint8_t>(size)) << size;
  }
}

TEST(LargeArrayTest, KeepsWhatWasThereAndAddsZeros) {
  for (const size_t before : {size_t{0}, size_t{10}, kMebi}) {
    for (const size_t after : {before, before + 1, 4 * kMebi}) {
      std::vector<uint32_t> array(before), expected(before);
      std::iota(array.begin(), array.end(), 1u);
      std::iota(expected.begin(), expected.end(), 1u);
      expected.resize(after);
      GrowLarge(&array, after);
      EXPECT_EQ(array, expected) << before << " to " << after;
    }
  }
}

#if defined(__linux__)

// Whether the mapping that holds an address was marked for large pages.
bool IsMarked(const void* address) {
  std::ifstream maps("/proc/self/smaps");
  bool is_here = false;
  for (std::string line; std::getline(maps, line);) {
    uintptr_t begin = 0, end = 0;
    if (std::sscanf(line.c_str(), "%lx-%lx ", &begin, &end) == 2) is_here = begin <= reinterpret_cast<uintptr_t>(address) && reinterpret_cast<uintptr_t>(address) < end;
    if (is_here && line.rfind("VmFlags:", 0) == 0) return line.find(" hg") != std::string::npos;
  }
  return false;
}

TEST(LargeArrayTest, AsksForLargePages) {
  if (!std::filesystem::exists("/sys/kernel/mm/transparent_hugepage")) GTEST_SKIP() << "this system has no large pages";
  const std::vector<uint8_t> large = LargeArray<uint8_t>(64 * kMebi);
  EXPECT_TRUE(IsMarked(large.data() + 32 * kMebi));
  std::vector<uint32_t> grown(10);
  GrowLarge(&grown, 16 * kMebi);
  EXPECT_TRUE(IsMarked(grown.data() + 8 * kMebi));
  const std::vector<uint8_t> usual(64 * kMebi);
  EXPECT_FALSE(IsMarked(usual.data() + 32 * kMebi));
}

TEST(LargeArrayTest, AskingForLessThanAPageDoesNothing) {
  std::vector<uint8_t> small(100, 7);
  AskForLargePages(small.data() + 1, 98);
  AskForLargePages(small.data(), 0);
  EXPECT_EQ(small, std::vector<uint8_t>(100, 7));
}

#endif

}  // namespace
}  // namespace lacerta
