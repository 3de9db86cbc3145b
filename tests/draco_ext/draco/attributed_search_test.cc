#include "draco/attributed_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

TEST(SmallestAttributedStreamTest, MeetsItsTargetsOrSaysWhyNot) {
  const AttributedMesh mesh = WeldSoups(shapes::HalvedTorus(64, 32)).value();
  const SurfaceErrorMeter meter = SurfaceErrorMeter::Create(mesh).value();
  ErrorTargets targets = TargetsFor(mesh, meter.diagonal() * std::pow(10, -66.0 / 20), 2, 2);
  targets.turned = 5e-4;
  AttributedSearchOptions options;
  options.effort = Effort::kFast;
  options.num_samples = 20'000;
  const AttributedTrial trial = SmallestAttributedStream(mesh, meter, targets, options).value();
  EXPECT_LE(trial.ratio, 1);
  EXPECT_GT(trial.ratio, 0.6);
  EXPECT_GT(trial.stream.size(), 600u);
  EXPECT_LT(trial.stream.size(), 3000u);  // of a surface of 4096 triangles

  options.most_bytes = trial.stream.size() / 3;
  const Status too_many = SmallestAttributedStream(mesh, meter, targets, options).status();
  EXPECT_EQ(too_many.code(), StatusCode::kUnsupported);
  EXPECT_THAT(too_many.message(), ::testing::HasSubstr("bytes"));

  targets.distance = 1e-9 * meter.diagonal();
  const Status too_far = SmallestAttributedStream(mesh, meter, targets, options).status();
  EXPECT_EQ(too_far.code(), StatusCode::kUnsupported);
  EXPECT_THAT(too_far.message(), ::testing::HasSubstr("positions"));
}

}  // namespace
}  // namespace lacerta
