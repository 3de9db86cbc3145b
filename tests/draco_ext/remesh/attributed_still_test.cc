#include "remesh/attributed_still.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "common/subdivision.h"
#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

AttributedParts PartsBeside(const Vec3f& offset) {
  std::vector<VertexSoup> soups = shapes::HalvedTorus(40, 20);
  VertexSoup box = shapes::TexturedBox(6);  // 432 triangles
  for (Vec3f& p : box.positions) p += offset;
  soups.push_back(std::move(box));
  return SplitAttributedSurface(WeldSoups(soups).value()).value();
}

TEST(AttributedStillTest, WhatStandsStillIsSimplifiedWithinTheTargets) {
  AttributedParts parts = PartsBeside({3, 0, 0});
  const AttributedMesh before = parts.still;
  ASSERT_EQ(before.surface.triangles.size(), 432u);
  const ErrorTargets targets = TargetsFor(before, 1e-3, 1, 2);
  ASSERT_TRUE(SimplifyStill(targets, 1024, &parts).ok());
  EXPECT_EQ(parts.still.surface.triangles.size(), 12u);  // a box
  EXPECT_EQ(parts.still.attributes[1].num_values(), 6u);
  const SurfaceErrorMeter meter = SurfaceErrorMeter::Create(before).value();
  EXPECT_LE(WorstRatio(meter.Measure(parts.still, 10'000).value(), targets), 1);
  EXPECT_TRUE(BuildTopology(static_cast<uint32_t>(parts.still.surface.positions.size()), parts.still.surface.triangles).ok());
}

TEST(AttributedStillTest, WhatTouchesTheRestStays) {
  AttributedParts parts = PartsBeside({1.4f, 0, 0});  // a corner of the box on the outer circle of the torus
  ASSERT_TRUE(SimplifyStill(TargetsFor(parts.still, 1e-3, 1, 2), 1024, &parts).ok());
  EXPECT_EQ(parts.still.surface.triangles.size(), 432u);
}

}  // namespace
}  // namespace lacerta
