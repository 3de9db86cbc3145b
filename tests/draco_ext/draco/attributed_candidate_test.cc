#include "draco/attributed_candidate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

TEST(AttributedCandidateTest, StreamsMeetTheirTargetsAndLeaveLittleOfThem) {
  const AttributedMesh mesh = WeldSoups(shapes::HalvedTorus(96, 48)).value();
  const SurfaceErrorMeter meter = SurfaceErrorMeter::Create(mesh).value();
  const AttributedParts parts = SplitAttributedSurface(mesh).value();
  const CollapseHistory history = DecimateAttributed(parts).value();
  const InputSurface surface(parts.refined.surface, parts.topology);
  const GroupSurface original(mesh);
  const AttributedCandidate candidate = AttributedCandidate::Create({original, meter, parts, surface, history}, 60, 4).value();
  size_t bytes = 0;
  for (const double psnr : {60.0, 66.0, 72.0, 78.0}) {
    SCOPED_TRACE(psnr);
    ErrorTargets targets = TargetsFor(mesh, meter.diagonal() * std::pow(10, -psnr / 20), 2, 2);
    targets.turned = 5e-4;  // as assets are packed
    ASSERT_TRUE(candidate.CanMeet(targets));
    const AttributedTrial trial = candidate.Meet(targets, {8, 6, 20'000}).value();
    EXPECT_LE(trial.ratio, 1);
    EXPECT_GT(trial.ratio, 0.7);
    EXPECT_LT(trial.errors.turned, 1e-3);
    EXPECT_GT(trial.stream.size(), 800u);
    EXPECT_LT(trial.stream.size(), 3000u);  // of a surface of 9216 triangles
    // Bytes grow with quality, but for what the texture costs where positions may slide.
    EXPECT_GT(1.05 * static_cast<double>(trial.stream.size()), static_cast<double>(bytes));
    bytes = trial.stream.size();
  }
  EXPECT_GT(bytes, 1600u);
  EXPECT_LT(bytes, 2000u);
  // No stream of that base is as near as this.
  EXPECT_FALSE(candidate.CanMeet(TargetsFor(mesh, meter.diagonal() * 1e-7, 2, 2)));
}

}  // namespace
}  // namespace lacerta
