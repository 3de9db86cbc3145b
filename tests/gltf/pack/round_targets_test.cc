#include "pack/round_targets.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lacerta {
namespace {

// Of three vertices, of which one does not move.
AccessorData Offsets(float largest) { return MakeFloatAccessor({0, 0, 0, 0.25f, -0.1f, 0.013f, largest, 0, 0.7f}, 3); }

AccessorData Rounded(const AccessorData& offsets, const TargetTolerance& tolerance, const std::string& name = "POSITION") {
  return RoundTargets({{{name, offsets}}}, tolerance)[0][0].data;
}

double Error(const AccessorData& a, const AccessorData& b) {
  double worst = 0.0;
  for (uint64_t i = 0; i < a.count; ++i) worst = std::max(worst, double{Norm(VectorAt(a, i) - VectorAt(b, i))});
  return worst;
}

TEST(RoundTargets, TakesTheCoarsestIntegersThatAreNearEnough) {
  const AccessorData offsets = Offsets(-1.0f);
  const AccessorData bytes = Rounded(offsets, {0.01, 0.0}), shorts = Rounded(offsets, {1e-4, 0.0}), floats = Rounded(offsets, {1e-6, 0.0});
  EXPECT_EQ(bytes.type, ComponentType::kInt8);
  EXPECT_EQ(shorts.type, ComponentType::kInt16);
  EXPECT_EQ(floats.type, ComponentType::kFloat);
  EXPECT_TRUE(bytes.normalized && shorts.normalized);
  EXPECT_EQ(bytes.bytes.size(), 9u);
  EXPECT_EQ(shorts.bytes.size(), 18u);
  EXPECT_EQ(floats.bytes, offsets.bytes);
  EXPECT_LT(Error(bytes, offsets), 0.01);
  EXPECT_GT(Error(bytes, offsets), 1e-3);
  EXPECT_LT(Error(shorts, offsets), 1e-4);
  EXPECT_GT(Error(shorts, offsets), 1e-6);
  EXPECT_EQ(VectorAt(bytes, 0), Vec3f());
  EXPECT_EQ(VectorAt(bytes, 2).x, -1.0f);
}

TEST(RoundTargets, DirectionsHaveATolerance) {
  EXPECT_EQ(Rounded(Offsets(0.5f), {0.01, 0.0}, "NORMAL").type, ComponentType::kFloat);
  EXPECT_EQ(Rounded(Offsets(0.5f), {0.0, 0.01}, "NORMAL").type, ComponentType::kInt8);
  EXPECT_EQ(Rounded(Offsets(0.5f), {0.0, 0.01}).type, ComponentType::kFloat);
}

TEST(RoundTargets, WhatIsOutOfReachStays) {
  const AccessorData far = Offsets(1.001f);
  EXPECT_EQ(Rounded(far, {0.1, 0.0}).bytes, far.bytes);
  EXPECT_EQ(Rounded(Offsets(std::nanf("")), {0.1, 0.0}).type, ComponentType::kFloat);
  const AccessorData integers = Rounded(Offsets(1.0f), {1e-4, 0.0});
  EXPECT_EQ(Rounded(integers, {0.1, 0.0}).bytes, integers.bytes);
}

TEST(RoundTargets, TellsWhatReadersHaveToKnow) {
  const std::vector<MorphTarget> floats = {{{"POSITION", Offsets(1.0f)}}, {{"NORMAL", Offsets(1.0f)}}};
  EXPECT_FALSE(AreQuantized(floats));
  EXPECT_FALSE(AreQuantized({}));
  EXPECT_TRUE(AreQuantized(RoundTargets(floats, {0.0, 0.01})));
}

TEST(RoundTargets, IndependentErrorsAddUpInSquares) {
  EXPECT_NEAR(RoomBeside(0.6, 1.0), 0.8, 1e-12);
  EXPECT_EQ(RoomBeside(1.1, 1.0), 0.0);
}

}  // namespace
}  // namespace lacerta
