#include "draco/memory_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lacerta {
namespace {

using ::testing::HasSubstr;

constexpr uint64_t kMillion = 1'000'000;

MemoryPlan PlanFor(uint64_t num_triangles, uint64_t memory) { return PlanMemory(num_triangles / 2, num_triangles, memory).value(); }

TEST(MemoryPlan, ChangesNothingWithoutALimitOrWithPlenty) {
  for (const uint64_t triangles : {uint64_t{1000}, 100'000 * uint64_t{1}, 2 * kMillion}) {
    for (const uint64_t memory : {uint64_t{0}, 100'000 * kMillion}) {
      const MemoryPlan plan = PlanFor(triangles, memory);
      EXPECT_FALSE(plan.is_lean);
      EXPECT_TRUE(plan.may_unsubdivide);
      EXPECT_EQ(plan.proxy.fewest_triangles, InputProxyOptions().fewest_triangles);
      EXPECT_GE(plan.proxy.most_triangles, triangles);
      EXPECT_GE(plan.proxy.most_as_a_whole, triangles);
    }
  }
  EXPECT_TRUE(PlanFor(3 * kMillion, 0).is_lean);
}

TEST(MemoryPlan, LessMemoryLetsFewerTrianglesStandForTheInput) {
  for (const uint64_t triangles : {200'000 * uint64_t{1}, 2 * kMillion, 20 * kMillion}) {
    MemoryPlan before = PlanFor(triangles, 1'000'000 * kMillion);
    for (uint64_t memory = 16'000 * kMillion;; memory = memory * 3 / 4) {
      const StatusOr<MemoryPlan> planned = PlanMemory(triangles / 2, triangles, memory);
      if (!planned.ok()) break;
      const MemoryPlan plan = planned.value();
      const InputProxyOptions& proxy = plan.proxy;
      EXPECT_LE(proxy.most_triangles, before.proxy.most_triangles);
      EXPECT_LE(proxy.most_as_a_whole, before.proxy.most_as_a_whole);
      EXPECT_GE(plan.is_lean, before.is_lean);
      EXPECT_LE(plan.may_unsubdivide, before.may_unsubdivide);
      EXPECT_GE(proxy.most_triangles, 50'000u);
      EXPECT_GE(proxy.most_as_a_whole, proxy.most_triangles);
      EXPECT_LE(proxy.fewest_triangles, proxy.most_triangles);
      before = plan;
    }
    EXPECT_TRUE(before.is_lean);
    EXPECT_LE(before.proxy.most_triangles, 200'000u) << triangles;  // down to where it fails
  }
}

// The error names what would do, and that does.
TEST(MemoryPlan, NamesTheLeastThatWouldDo) {
  const uint64_t triangles = 22 * kMillion;
  const Status status = PlanMemory(triangles / 2, triangles, 500 * kMillion).status();
  EXPECT_EQ(status.code(), StatusCode::kLimitExceeded);
  EXPECT_THAT(status.message(), HasSubstr("not enough memory: 22000000 triangles take at least 1069 MB"));
  EXPECT_THAT(status.message(), HasSubstr("500 are allowed"));
  EXPECT_FALSE(PlanMemory(triangles / 2, triangles, 1066 * kMillion).ok());
  EXPECT_TRUE(PlanMemory(triangles / 2, triangles, 1069 * kMillion).ok());
  EXPECT_TRUE(PlanMemory(5000, 10'000, kMillion).ok());  // small ones are tried
}

}  // namespace
}  // namespace lacerta
