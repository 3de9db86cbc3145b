#include "pack/family_meter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <random>
#include <utility>
#include <vector>

namespace lacerta {
namespace {

// Triangles from one point outward, every two of them through each other near it.
Primitive BowTies(uint32_t num_triangles) {
  std::mt19937 random(num_triangles);
  const auto coordinate = [&] { return static_cast<float>(random() % 20001) / 10000 - 1; };
  std::vector<Vec3f> positions = {{0, 0, 0}};
  Primitive primitive;
  for (uint32_t i = 0; i < num_triangles; ++i) {
    const Vec3f out = {coordinate(), coordinate(), coordinate()};
    positions.insert(positions.end(), {out, out + Vec3f{0.01f * coordinate(), 0.01f * coordinate(), 0.01f * coordinate()}});
    primitive.triangles.push_back({0, 2 * i + 1, 2 * i + 2});
  }
  primitive.num_vertices = positions.size();
  primitive.attributes = {{"POSITION", MakeFloatAccessor(positions)}};
  return primitive;
}

// Every query looks at a share of all triangles, so that fewer are made.
TEST(FamilyMeter, MeasuresACrowdInTheTimeOfASurface) {
  const Primitive primitive = BowTies(20'000);
  const FamilyMeter meter({&primitive}, 1e-3, {}, 1024, [](size_t, uint64_t) { return 1024.0; });
  ASSERT_TRUE(meter.status().ok()) << meter.status().message();
  Primitive moved = primitive;
  const Vec3f shift = {0.002f, 0, 0};
  std::vector<Vec3f> positions;
  for (uint32_t v = 0; v < moved.num_vertices; ++v) {
    positions.push_back(Vec3f{moved.attributes[0].data.Float(v, 0), moved.attributes[0].data.Float(v, 1), moved.attributes[0].data.Float(v, 2)} + shift);
  }
  moved.attributes[0].data = MakeFloatAccessor(positions);
  const std::clock_t begin = std::clock();
  const StatusOr<SurfaceErrors> errors = meter.Measure({&moved});
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  ASSERT_TRUE(errors.ok()) << errors.status().message();
  EXPECT_LE(errors.value().distance, 0.002);
  EXPECT_GE(errors.value().distance, 0.0004);
  EXPECT_LT(seconds, 3.0);
}

// A flat square of two triangles in each of 200 by 200 cells; the first triangle of some cells looks down.
Primitive Square(uint32_t num_turned) {
  constexpr uint32_t kCells = 200;
  std::vector<Vec3f> positions;
  Primitive primitive;
  for (uint32_t i = 0; i < (kCells + 1) * (kCells + 1); ++i) {
    positions.push_back({static_cast<float>(i % (kCells + 1)), static_cast<float>(i / (kCells + 1)), 0});
  }
  for (uint32_t cell = 0; cell < kCells * kCells; ++cell) {
    const uint32_t v = cell / kCells * (kCells + 1) + cell % kCells, up = v + kCells + 1;
    primitive.triangles.insert(primitive.triangles.end(), {{v, v + 1, up}, {v + 1, up + 1, up}});
  }
  for (uint32_t i = 0; i < num_turned; ++i) {
    Triangle& turned = primitive.triangles[(2 * 1009 * i) % primitive.triangles.size()];
    std::swap(turned[0], turned[1]);
  }
  primitive.num_vertices = positions.size();
  primitive.attributes = {{"POSITION", MakeFloatAccessor(positions)}};
  return primitive;
}

// How far off the measured share of the area that looks down is, relative to it, where `times` as much is allowed.
double OffAtBoundOf(double times) {
  constexpr uint32_t kTurned = 38;
  const Primitive original = Square(0), stored = Square(kTurned);
  const double share = kTurned / static_cast<double>(original.triangles.size());
  AttributeTargets targets;
  targets.turned = times * share;
  const FamilyMeter meter({&original}, 0.1, targets, 1024, [](size_t, uint64_t) { return 1024.0; });
  return std::fabs(meter.Measure({&stored}).value().turned / share - 1.0);
}

TEST(FamilyMeter, TakesMoreSamplesOfATurnedAreaNearItsBound) {
  EXPECT_LT(OffAtBoundOf(1.25), 0.015);  // it is held to 0.85 of that
  EXPECT_GT(OffAtBoundOf(10.0), 0.025);
}

// What linear light may be off for an error on screens; integers of 8 bits are 1 / (255 sqrt(12)) off.
TEST(FamilyMeter, ColorsAreHeldToWhatScreensShow) {
  const auto allowed = [](const std::vector<float>& grays, double error) {
    Primitive primitive;
    primitive.num_vertices = 3 * grays.size();
    std::vector<Vec3f> positions, colors;
    for (uint32_t i = 0; i < grays.size(); ++i) {
      const float x = static_cast<float>(i);
      positions.insert(positions.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}});
      colors.insert(colors.end(), 3, {grays[i], grays[i], grays[i]});
      primitive.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    primitive.attributes = {{"POSITION", MakeFloatAccessor(positions)}, {"COLOR_0", MakeFloatAccessor(colors)}};
    AttributeTargets targets;
    targets.color = error / 255;
    const FamilyMeter meter({&primitive}, 1e-3, targets, 1024, [](size_t, uint64_t) { return 1024.0; });
    EXPECT_TRUE(meter.status().ok()) << meter.status().message();
    return 255 * meter.targets().attributes[0] / 2;  // of three components, and of integers again
  };
  constexpr double kOfIntegers = 0.2887;
  EXPECT_NEAR(allowed({1.0f}, 1.5), 1.5 * 2.4 / 1.055, 0.01);
  EXPECT_NEAR(allowed({0.2159f}, 1.5), 1.5 / 1.0748, 0.01);  // 128 of 255 on a screen
  EXPECT_NEAR(allowed({0.0f}, 15), 15 / 12.92, 0.01);
  EXPECT_NEAR(allowed({0.0f}, 1.5), kOfIntegers, 0.01);
  EXPECT_NEAR(allowed({1.0f, 0.2159f}, 1.5), 1.5 / std::sqrt((0.1932 + 1.1552) / 2), 0.01);
  EXPECT_NEAR(allowed({5.0f}, 1.5), allowed({1.0f}, 1.5), 1e-6);  // brighter than screens
}

}  // namespace
}  // namespace lacerta
