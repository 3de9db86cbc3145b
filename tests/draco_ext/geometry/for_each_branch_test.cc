#include "geometry/for_each_branch.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <new>
#include <numeric>
#include <stdexcept>
#include <string>

namespace lacerta {
namespace {

// While one branch throws, and after it, the loops of the others leave nothing out.
TEST(ForEachBranch, LoopsWithinOtherBranchesRunToTheirEnd) {
  constexpr int kTurns = 200, kSize = 2000;
  for (int turn = 0; turn < kTurns; ++turn) {
    std::vector<std::vector<int>> filled(4, std::vector<int>(kSize, 0));
    std::atomic<bool> has_thrown{false};
    const auto work = [&](size_t branch) {
      if (branch == 1) {
        has_thrown = true;
        throw std::bad_alloc();
      }
      for (int spin = 0; !has_thrown && spin < 1'000'000; ++spin) continue;
      tbb::parallel_for(0, kSize, [&](int i) { filled[branch][i] = 1; });
      EXPECT_EQ(std::accumulate(filled[branch].begin(), filled[branch].end(), 0), kSize);
    };
    EXPECT_THROW(ForEachBranch(4, work), std::bad_alloc);
  }
}

TEST(ForEachBranch, ThrowsTheFirstByNumber) {
  const auto work = [](size_t branch) {
    if (branch % 3 == 2) throw std::runtime_error(std::to_string(branch));
  };
  try {
    ForEachBranch(10, work);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "2");
  }
  int calls = 0;
  ForEachBranch(0, [&](size_t) { ++calls; });
  EXPECT_EQ(calls, 0);
}

}  // namespace
}  // namespace lacerta
