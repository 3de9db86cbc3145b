#include "encoder/allocation/monotone_cubic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace lacerta {
namespace {

TEST(MonotoneCubicTest, PassesThroughItsPointsAndClampsBeyond) {
  const std::vector<double> xs = {-1, 0, 0.5, 3}, ys = {5, 4, 4, -2};
  const MonotoneCubic curve(xs, ys);
  for (size_t i = 0; i < xs.size(); ++i) EXPECT_NEAR(curve(xs[i]), ys[i], 1e-14);
  EXPECT_EQ(curve(-100), 5);
  EXPECT_EQ(curve(100), -2);
  EXPECT_EQ(curve.min_x(), -1);
  EXPECT_EQ(curve.max_x(), 3);
}

TEST(MonotoneCubicTest, NeverOvershoots) {
  const MonotoneCubic curve({0, 1, 2, 3, 4, 5}, {0, 0, 0.1, 9.9, 10, 10});
  double last = 0.0;
  for (double x = 0; x <= 5; x += 0.001) {
    EXPECT_GE(curve(x), last - 1e-12);
    EXPECT_LE(curve(x), 10 + 1e-12);
    last = curve(x);
  }
  EXPECT_GT(last, 9.99);
}

TEST(MonotoneCubicTest, IsExactForLinesAndCloseForSmoothCurves) {
  std::vector<double> xs, line, exponential;
  for (int i = 0; i <= 20; ++i) {
    xs.push_back(0.1 * i);
    line.push_back(3 - 2 * xs.back());
    exponential.push_back(std::exp(xs.back()));
  }
  const MonotoneCubic straight(xs, line), curved(xs, exponential);
  for (double x = 0.1; x < 1.9; x += 0.013) {
    EXPECT_NEAR(straight(x), 3 - 2 * x, 1e-13);
    EXPECT_NEAR(curved(x), std::exp(x), 2e-4 * std::exp(x));
  }
}

}  // namespace
}  // namespace lacerta
