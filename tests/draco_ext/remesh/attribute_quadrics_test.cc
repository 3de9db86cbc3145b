#include "remesh/attribute_quadrics.h"

#include <gtest/gtest.h>

#include <array>

namespace lacerta {
namespace {

// s = (2 x - y + 1, 3 z) on the triangles of a corner of a cube: linear, so the error is that of the value alone.
std::array<double, 2> ValueAt(const Vec3d& p) { return {2 * p.x - p.y + 1, 3 * p.z}; }

void Add(const std::array<Vec3d, 3>& p, AttributeQuadrics* quadrics) {
  std::array<std::array<double, 2>, 3> values{};
  for (size_t k = 0; k < 3; ++k) values[k] = ValueAt(p[k]);
  quadrics->AddTriangle(0, p, {values[0].data(), values[1].data(), values[2].data()});
}

TEST(AttributeQuadricsTest, ALinearFunctionOverAPlaneIsExtended) {
  AttributeQuadrics quadrics(2, 2);
  Add({Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}}, &quadrics);
  Add({Vec3d{0, 0, 0}, Vec3d{0, 2, 0}, Vec3d{-3, 0, 0}}, &quadrics);
  Quadric q;
  quadrics.AddReduced(quadrics.row(0), &q);
  double value[2];
  for (const Vec3d& p : {Vec3d{0.3, 0.4, 0}, Vec3d{-2, 5, 0}}) {
    ASSERT_TRUE(quadrics.BestValue(quadrics.row(0), p, value));
    EXPECT_NEAR(value[0], ValueAt(p)[0], 1e-5);  // the ridge flattens slopes by less
    EXPECT_NEAR(value[1], 0, 1e-12);
    EXPECT_NEAR(q.Evaluate(p), 0, 1e-5);
  }
}

TEST(AttributeQuadricsTest, SlopesThatDisagreeCost) {
  // Values 0 and x on either side of x = 0: at x = 1 the two triangles of area 1/2 say 0 and 1.
  AttributeQuadrics quadrics(1, 2);
  const double zero = 0, one = 1;
  quadrics.AddTriangle(0, {Vec3d{0, 0, 0}, Vec3d{0, 1, 0}, Vec3d{-1, 0, 0}}, {&zero, &zero, &zero});
  quadrics.AddTriangle(0, {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}}, {&zero, &one, &zero});
  Quadric q;
  quadrics.AddReduced(quadrics.row(0), &q);
  EXPECT_NEAR(q.Evaluate({1, 0, 0}), 2 * 0.5 * 0.25, 1e-3);
  EXPECT_NEAR(q.Evaluate({0, 3, 0}), 0, 1e-6);
  double value = 0;
  ASSERT_TRUE(quadrics.BestValue(quadrics.row(0), {1, 0, 0}, &value));
  EXPECT_NEAR(value, 0.5, 1e-3);
}

TEST(AttributeQuadricsTest, ATriangleWithoutAreaSaysNothingAndANeedleLittle) {
  AttributeQuadrics quadrics(1, 2);
  const double zero = 0, one = 1;
  quadrics.AddTriangle(0, {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{2, 0, 0}}, {&zero, &one, &zero});
  double value = 7;
  EXPECT_FALSE(quadrics.BestValue(quadrics.row(0), {1, 0, 0}, &value));
  EXPECT_EQ(value, 7);
  // The value rises by 1 over a height of 1e-6: without the ridge the error one unit away would be 1e6^2 times the area, 1e6 / 2.
  quadrics.AddTriangle(0, {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0.5, 1e-6, 0}}, {&zero, &zero, &one});
  Quadric q;
  quadrics.AddReduced(quadrics.row(0), &q);
  EXPECT_LT(q.Evaluate({0, 1, 0}), 1e-3);
}

TEST(AttributeQuadricsTest, NodesAreApartAndClearedAlone) {
  AttributeQuadrics quadrics(1, 2);
  const double zero = 0, one = 1;
  for (const uint32_t node : {0u, 1u}) quadrics.AddTriangle(node, {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}}, {&zero, &one, &zero});
  quadrics.Clear(0);
  double value = 7;
  EXPECT_FALSE(quadrics.BestValue(quadrics.row(0), {1, 0, 0}, &value));
  ASSERT_TRUE(quadrics.BestValue(quadrics.row(1), {1, 0, 0}, &value));
  EXPECT_NEAR(value, 1, 1e-5);
}

}  // namespace
}  // namespace lacerta
