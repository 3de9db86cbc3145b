#include "remesh/surface_errors.h"

#include <gtest/gtest.h>

#include <string>

#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

VertexSoup Moved(VertexSoup soup, const Vec3f& by) {
  for (Vec3f& p : soup.positions) p += by;
  return soup;
}

double DistanceWithoutAttributes(const AttributedMesh& a, const AttributedMesh& b) {
  return MeasureSurfaceDistance(a.surface, b.surface, SurfaceDistanceOptions::RmsOnly(10'000)).value().Rms();
}

// Whether the meter of attributes tells it on the way, as of one group, or the other one has to be asked.
TEST(SurfaceErrorsTest, DistanceIsThatOfTheSurfaces) {
  const VertexSoup soup = shapes::TexturedGrid(30, 30, 0.3f), above = Moved(soup, {0, 0, 0.01f});
  const AttributedMesh one = WeldSoups({soup}).value(), one_above = WeldSoups({above}).value();
  const SurfaceErrors errors = SurfaceErrorMeter::Create(one).value().Measure(one_above, 10'000).value();
  EXPECT_EQ(errors.distance, DistanceWithoutAttributes(one, one_above));
  EXPECT_GT(errors.distance, 0.002);
  EXPECT_LE(errors.distance, 0.01 + 1e-6);
  // Groups that have changed places: each is where the other one was.
  const AttributedMesh two = WeldSoups({soup, above}).value(), swapped = WeldSoups({above, soup}).value();
  const SurfaceErrors none = SurfaceErrorMeter::Create(two).value().Measure(swapped, 10'000).value();
  EXPECT_EQ(none.distance, DistanceWithoutAttributes(two, swapped));
  EXPECT_LT(none.distance, 1e-6);
}

TEST(SurfaceErrorsTest, SwappedSidesOfASheetCountATwentiethOfTurnedOnes) {
  const AttributedMesh sheet = shapes::ThickSheet(4e-4f);
  const SurfaceErrorMeter meter = SurfaceErrorMeter::Create(sheet).value();
  EXPECT_EQ(meter.Measure(sheet, 10'000).value().MostTurned(), 0);
  const SurfaceErrors errors = meter.Measure(shapes::ThickSheet(-4e-4f), 10'000).value();
  EXPECT_EQ(errors.swapped, 1);
  EXPECT_EQ(errors.turned, 0);
  EXPECT_NEAR(errors.MostTurned(), 0.05, 1e-12);
}

TEST(SurfaceErrorsTest, RefusesWhatIsTooSmallToMeasure) {
  AttributedMesh mesh = WeldSoups({shapes::TexturedGrid(2, 2)}).value();
  EXPECT_TRUE(SurfaceErrorMeter::Create(mesh).ok());
  for (Vec3f& p : mesh.surface.positions) p = p * 1e-13f;
  const auto meter = SurfaceErrorMeter::Create(mesh);
  ASSERT_EQ(meter.status().code(), StatusCode::kInvalidData);
  EXPECT_NE(meter.status().message().find("scale the mesh up"), std::string::npos);
}

}  // namespace
}  // namespace lacerta
