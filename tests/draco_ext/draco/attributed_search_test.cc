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

// The scanner's few triangles that look the other way cost nothing but their own area; many are not what was seen any more.
TEST(SmallestAttributedStreamTest, TurnsAFewTrianglesOver) {
  const AttributedMesh mesh = WeldSoups(shapes::HalvedTorus(64, 32)).value();
  const auto stream_with = [&](uint32_t num_turned) {
    AttributedMesh turned = mesh;
    for (uint32_t i = 0; i < num_turned; ++i) {
      const uint32_t f = 1000 + 7 * i;
      std::swap(turned.surface.triangles[f][1], turned.surface.triangles[f][2]);
      for (MeshAttribute& attribute : turned.attributes) std::swap(attribute.corners[f][1], attribute.corners[f][2]);
    }
    const SurfaceErrorMeter meter = SurfaceErrorMeter::Create(turned).value();
    ErrorTargets targets = TargetsFor(turned, meter.diagonal() * std::pow(10, -60.0 / 20), 2, 5);
    targets.turned = 2e-3;
    AttributedSearchOptions options;
    options.effort = Effort::kFast;
    options.num_samples = 20'000;
    return SmallestAttributedStream(turned, meter, targets, options);
  };
  const AttributedTrial none = stream_with(0).value(), few = stream_with(3).value();
  EXPECT_LE(few.ratio, 1);
  EXPECT_LE(few.stream.size(), 1.05 * static_cast<double>(none.stream.size()));
  EXPECT_GE(few.stream.size(), 0.95 * static_cast<double>(none.stream.size()));
  EXPECT_THAT(stream_with(40).status().message(), ::testing::HasSubstr("look the other way"));
}

}  // namespace
}  // namespace lacerta
