#include "remesh/quadric.h"

#include <gtest/gtest.h>

#include <random>

namespace lacerta {
namespace {

Vec3d RandomPoint(std::mt19937* random) {
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const double x = coordinate(*random), y = coordinate(*random), z = coordinate(*random);
  return {x, y, z};
}

TEST(Quadric, IsTheSquaredDistanceTimesTheArea) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const Vec3d a = RandomPoint(&random), b = RandomPoint(&random), c = RandomPoint(&random), p = RandomPoint(&random);
    const Vec3d cross = Cross(b - a, c - a);
    const double area = Norm(cross) / 2, distance = Dot(p - a, cross) / Norm(cross);
    const Quadric q = Quadric::OfTriangle(a, b, c);
    EXPECT_NEAR(q.Evaluate(p), area * distance * distance, 1e-13);
    EXPECT_NEAR(q.Evaluate(a * 0.2 + b * 0.3 + c * 0.5), 0, 1e-14);
    EXPECT_NEAR(Quadric::OfTriangle(c, b, a).Evaluate(p), q.Evaluate(p), 1e-14) << "whichever way the triangle looks";
  }
}

TEST(Quadric, Adds) {
  std::mt19937 random(2);
  const Quadric a = Quadric::OfTriangle(RandomPoint(&random), RandomPoint(&random), RandomPoint(&random));
  const Quadric b = Quadric::OfTriangle(RandomPoint(&random), RandomPoint(&random), RandomPoint(&random));
  Quadric sum = a;
  sum += b;
  for (int i = 0; i < 20; ++i) {
    const Vec3d p = RandomPoint(&random);
    EXPECT_NEAR(sum.Evaluate(p), a.Evaluate(p) + b.Evaluate(p), 1e-13);
    EXPECT_GT(sum.Evaluate(p), 0);
  }
}

TEST(Quadric, TriangleWithoutAreaWeighsNothing) {
  EXPECT_EQ(Quadric::OfTriangle({1, 2, 3}, {1, 2, 3}, {4, 5, 6}).Evaluate({7, 8, 9}), 0);
  EXPECT_EQ(Quadric::OfTriangle({0, 0, 0}, {1, 0, 0}, {2, 0, 0}).Evaluate({7, 8, 9}), 0);
}

TEST(Quadric, IsNeverBelowZero) {
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d a = RandomPoint(&random), b = RandomPoint(&random), c = RandomPoint(&random);
    EXPECT_GE(Quadric::OfTriangle(a, b, c).Evaluate(a + (b - a) * 3.7 - (c - a) * 2.2), 0);
  }
}

}  // namespace
}  // namespace lacerta
