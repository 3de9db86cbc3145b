#include "common/octahedral.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lacerta {
namespace {

TEST(OctahedralTest, LatticePointsComeBack) {
  for (const int bits : {2, 3, 6, 8}) {
    const int32_t largest = (1 << bits) - 2;
    for (int32_t s = 0; s <= largest; ++s) {
      for (int32_t t = 0; t <= largest; ++t) {
        const Vec3f normal = NormalFromOctahedral({s, t}, bits);
        EXPECT_NEAR(Norm(normal), 1, 1e-6);
        const auto back = OctahedralFromNormal(normal, bits);
        const bool at_rim = s == 0 || t == 0 || s == largest || t == largest;
        EXPECT_TRUE(at_rim || (back[0] == s && back[1] == t)) << s << " " << t;
        EXPECT_LT(Norm(NormalFromOctahedral(back, bits) - normal), 1e-6f);  // at the rim two points are one direction
        EXPECT_EQ(OctahedralFromNormal(NormalFromOctahedral(back, bits), bits), back);
      }
    }
  }
}

TEST(OctahedralTest, DirectionsAreAtMostHalfACellOff) {
  double largest = 0;
  for (int i = 0; i < 2000; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 2000, angle = 2.399963 * i, r = std::sqrt(1 - z * z);
    const Vec3f normal = Vec3Cast<float>(Vec3d{r * std::cos(angle), r * std::sin(angle), z});
    largest = std::max<double>(largest, Norm(NormalFromOctahedral(OctahedralFromNormal(normal, 8), 8) - normal));
  }
  EXPECT_LT(largest, 2.0 / 127);
  EXPECT_GT(largest, 0.5 / 127);
}

TEST(OctahedralTest, WhatHasNoDirectionPointsAlongX) {
  for (const Vec3f& v : {Vec3f{0, 0, 0}, Vec3f{NAN, 0, 0}, Vec3f{INFINITY, 1, 0}}) {
    EXPECT_EQ(NormalFromOctahedral(OctahedralFromNormal(v, 8), 8), (Vec3f{1, 0, 0}));
  }
}

}  // namespace
}  // namespace lacerta
