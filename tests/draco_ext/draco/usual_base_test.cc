// Bases by themselves, which tell where the search for a base size begins.
#include "draco/usual_base.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "draco_ext/draco/simplified_input.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

struct Simplified : testing::SimplifiedInput {
  using SimplifiedInput::SimplifiedInput;
  double PsnrAt(uint32_t num_vertices) const { return BasePsnr(Refinable(), num_vertices, meter); }
  double AskewAt(uint32_t num_vertices) const { return AskewShare(Refinable(), num_vertices); }
};

TEST(BasePsnrTest, FourTimesTheVerticesBringTwelveDecibels) {
  const Simplified sphere(shapes::Icosphere(4));
  const double coarse = sphere.PsnrAt(40), fine = sphere.PsnrAt(160), finest = sphere.PsnrAt(640);
  EXPECT_NEAR(fine - coarse, 12, 3);  // chords of a smooth surface: four times as near
  EXPECT_NEAR(finest - fine, 12, 3);
  EXPECT_GT(coarse, 25);
  EXPECT_LT(coarse, 40);
}

TEST(BasePsnrTest, AllVerticesAreTheSurfaceAndNoneTheCoarsest) {
  const Simplified sphere(shapes::Icosphere(3));
  const auto num_input = static_cast<uint32_t>(sphere.mesh.positions.size());
  EXPECT_GT(sphere.PsnrAt(num_input), 120);
  EXPECT_GT(sphere.PsnrAt(num_input + 1), 120);
  EXPECT_EQ(sphere.PsnrAt(0), sphere.PsnrAt(num_input - sphere.history.num_collapses()));
  EXPECT_LT(sphere.PsnrAt(0), 40);
}

TEST(BasePsnrTest, ShapesWithMuchInThemNeedLargerBases) {
  const Simplified smooth(shapes::Icosphere(4)), rough(shapes::BumpySphere(4, 0.0f, 0.02f));
  EXPECT_GT(smooth.PsnrAt(640), rough.PsnrAt(640) + 3);
  EXPECT_LT(smooth.PsnrAt(640), rough.PsnrAt(640) + 20);
}

TEST(BasePsnrTest, WhatStandsStillIsThere) {
  const Simplified alone(shapes::Icosphere(4)), accompanied(shapes::Icosphere(4), testing::Moved(shapes::Icosphere(1), {5, 0, 0}));
  EXPECT_GT(accompanied.PsnrAt(160), alone.PsnrAt(160));  // as near, of a larger whole
  EXPECT_LT(accompanied.PsnrAt(160), alone.PsnrAt(160) + 14);
}

TEST(AskewShareTest, SmoothSurfacesHaveNoneAndLimbsTheirSides) {
  const Simplified sphere(shapes::Icosphere(4)), spiky(shapes::SpikySphere(4));
  EXPECT_EQ(sphere.AskewAt(40), 0);
  const double coarse = spiky.AskewAt(30), fine = spiky.AskewAt(600);
  EXPECT_GT(coarse, 0.02);
  EXPECT_LT(coarse, 0.6);
  EXPECT_LT(fine, 0.5 * coarse);
}

TEST(AskewShareTest, NothingIsAskewToItself) {
  const Simplified rough(shapes::BumpySphere(3, 0.0f, 0.02f)), spiky(shapes::SpikySphere(3));
  for (const Simplified* shape : {&rough, &spiky}) EXPECT_LT(shape->AskewAt(static_cast<uint32_t>(shape->mesh.positions.size())), 1e-3);
}

TEST(UsualAskewShareTest, FallsAsStreamsGetBetter) {
  EXPECT_LT(UsualAskewShare(80), 0.6 * UsualAskewShare(70));
  EXPECT_GT(UsualAskewShare(80), 0.1 * UsualAskewShare(70));
  EXPECT_LT(UsualAskewShare(60), 0.1);
}

TEST(UsualBasePsnrTest, GrowsLessThanTheStreams) {
  EXPECT_GT(UsualBasePsnr(80), UsualBasePsnr(60) + 4);
  EXPECT_LT(UsualBasePsnr(80), UsualBasePsnr(60) + 16);
  EXPECT_LT(UsualBasePsnr(60), 50);
}

}  // namespace
}  // namespace lacerta
