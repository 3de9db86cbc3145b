#include "remesh/parity_forest.h"

#include <gtest/gtest.h>

namespace lacerta {
namespace {

TEST(ParityForest, TellsWhoIsTurnedAgainstWhom) {
  // A chain in which every third link turns; whoever joins the parts, the parities along it are the same.
  constexpr uint32_t kSize = 1000;
  ParityForest forest(kSize);
  for (const uint32_t stride : {7u, 1u}) {
    for (uint32_t i = 0; i + 1 < kSize; i += stride) EXPECT_TRUE(forest.Join(i + 1, i, i % 3 == 0));
  }
  const ParityForest::Place first = forest.Find(0);
  for (uint32_t i = 0, parity = first.parity; i < kSize; ++i) {
    EXPECT_EQ(forest.Find(i).root, first.root);
    EXPECT_EQ(forest.Find(i).parity, parity);
    parity ^= i % 3 == 0;
  }
}

TEST(ParityForest, RefusesWhatContradicts) {
  ParityForest forest(4);
  EXPECT_TRUE(forest.Join(0, 1, 1));
  EXPECT_TRUE(forest.Join(1, 2, 0));
  EXPECT_TRUE(forest.Join(0, 2, 1));
  EXPECT_FALSE(forest.Join(0, 2, 0));
  EXPECT_NE(forest.Find(3).root, forest.Find(0).root);
  EXPECT_TRUE(forest.Join(3, 0, 0));
  EXPECT_FALSE(forest.Join(3, 1, 0));
}

}  // namespace
}  // namespace lacerta
