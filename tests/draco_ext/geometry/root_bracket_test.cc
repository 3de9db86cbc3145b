#include "geometry/root_bracket.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace lacerta {
namespace {

// Steps until y lies between -least and 0; the bracket holds the root all the while.
int StepsTo(double least, double root, const std::function<double(double)>& y, RootBracket* bracket) {
  int steps = 0;
  for (double x = bracket->Next(); steps < 100; x = bracket->Next()) {
    ++steps;
    EXPECT_GE((x - bracket->below().x) * (bracket->above().x - x), 0) << "outside";
    bracket->Narrow({x, y(x)});
    EXPECT_GE((root - bracket->below().x) * (bracket->above().x - root), 0) << "lost";
    if (y(x) <= 0 && y(x) > -least) break;
  }
  return steps;
}

TEST(RootBracket, FindsRootsOfCurvesInFewSteps) {
  const auto rising = [](double x) { return std::exp(x) - 3; };
  RootBracket up({-5, rising(-5)}, {4, rising(4)});
  EXPECT_LE(StepsTo(0.03, std::log(3.0), rising, &up), 10);
  EXPECT_NEAR(up.below().x, std::log(3.0), 0.02);
  const auto falling = [](double x) { return -2 * x + 1; };  // below 0 on the right
  RootBracket down({3, falling(3)}, {-1, falling(-1)});
  EXPECT_LE(StepsTo(1e-9, 0.5, falling, &down), 2);
}

TEST(RootBracket, BothEndsComeNearer) {
  const auto steep = [](double x) { return std::pow(x, 9) - 1e-3; };
  RootBracket bracket({0, steep(0)}, {2, steep(2)});
  StepsTo(1e-5, std::pow(1e-3, 1.0 / 9), steep, &bracket);
  EXPECT_LT(bracket.above().x - bracket.below().x, 1);
}

TEST(RootBracket, KnowsWhetherItIsKnown) {
  RootBracket bracket({1, RootBracket::kUnknown}, {0, RootBracket::kUnknown});
  EXPECT_FALSE(bracket.IsKnown());
  bracket.Narrow({0.5, 2});
  EXPECT_FALSE(bracket.IsKnown());
  EXPECT_EQ(bracket.above().x, 0.5);
  EXPECT_EQ(bracket.below().x, 1);
  bracket.Narrow({0.75, 0});
  EXPECT_TRUE(bracket.IsKnown());
  EXPECT_EQ(bracket.below().x, 0.75);
  EXPECT_GT(bracket.Next(), 0.5);
  EXPECT_LT(bracket.Next(), 0.75);
}

}  // namespace
}  // namespace lacerta
