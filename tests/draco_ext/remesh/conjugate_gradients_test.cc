#include "remesh/conjugate_gradients.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lacerta {
namespace {

// A chain of springs, each end held.
template <typename Entry>
std::vector<Entry> Chain(const std::vector<Entry>& x) {
  std::vector<Entry> image(x.size());
  for (size_t i = 0; i < x.size(); ++i) {
    image[i] = x[i] * 2.0;
    if (i > 0) image[i] -= x[i - 1];
    if (i + 1 < x.size()) image[i] -= x[i + 1];
  }
  return image;
}

TEST(ConjugateGradients, SolveInAsManyRoundsAsThereAreUnknowns) {
  std::vector<double> expected(12);
  for (size_t i = 0; i < expected.size(); ++i) expected[i] = std::sin(1.0 + static_cast<double>(i * i));
  const std::vector<double> x = ConjugateGradients(Chain(expected), 12, Chain<double>);
  const std::vector<double> few = ConjugateGradients(Chain(expected), 2, Chain<double>);
  double far = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(x[i], expected[i], 1e-12);
    far = std::max(far, std::fabs(few[i] - expected[i]));
  }
  EXPECT_GT(far, 0.01);
}

TEST(ConjugateGradients, TakeVectorsAsEntries) {
  std::vector<Vec3d> expected(5);
  for (int i = 0; i < 5; ++i) expected[i] = {std::sin(1.0 + i), 1.0 * i, std::cos(3.0 * i)};
  const std::vector<Vec3d> x = ConjugateGradients(Chain(expected), 15, Chain<Vec3d>);
  for (size_t i = 0; i < x.size(); ++i) EXPECT_LT(Norm(x[i] - expected[i]), 1e-12);
}

TEST(ConjugateGradients, NothingIsDoneForNothing) {
  EXPECT_TRUE(ConjugateGradients(std::vector<double>(), 3, Chain<double>).empty());
  EXPECT_EQ(ConjugateGradients(std::vector<double>(4, 0.0), 3, Chain<double>), std::vector<double>(4, 0.0));
  const auto zero = [](const std::vector<double>& v) { return std::vector<double>(v.size()); };
  EXPECT_EQ(ConjugateGradients(std::vector<double>(4, 1.0), 3, zero), std::vector<double>(4, 0.0));  // no curvature
}

}  // namespace
}  // namespace lacerta
