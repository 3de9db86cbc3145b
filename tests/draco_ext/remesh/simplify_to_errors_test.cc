#include "remesh/simplify_to_errors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

constexpr double kAny = std::numeric_limits<double>::infinity();

SimplifiedSurface Simplify(const AttributedMesh& mesh, const ErrorTargets& targets) {
  const auto meter = SurfaceErrorMeter::Create(mesh);
  EXPECT_TRUE(meter.ok()) << meter.status().message();
  auto result = SimplifyToErrors(mesh, meter.value(), targets);
  EXPECT_TRUE(result.ok()) << result.status().message();
  return std::move(result).value();
}

TEST(SimplifyToErrorsTest, MeetsEachTargetAndNotByFar) {
  const AttributedMesh mesh = WeldSoups({shapes::TexturedGrid(60, 60, 0.3f)}).value();
  const ErrorTargets position{1e-3, {kAny, kAny}}, texture{kAny, {0.3, kAny}}, normal{kAny, {kAny, 2}}, all{1e-3, {0.3, 2}};
  size_t most = 0;
  for (const ErrorTargets& targets : {position, texture, normal}) {
    const SimplifiedSurface result = Simplify(mesh, targets);
    EXPECT_TRUE(result.meets_targets);
    EXPECT_LE(WorstRatio(result.errors, targets), 1);
    EXPECT_GE(WorstRatio(result.errors, targets), 0.8);
    EXPECT_LT(result.mesh.surface.triangles.size(), mesh.surface.triangles.size() / 4);
    most = std::max(most, result.mesh.surface.triangles.size());
  }
  const SimplifiedSurface result = Simplify(mesh, all);
  EXPECT_LE(WorstRatio(result.errors, all), 1);
  EXPECT_GE(result.mesh.surface.triangles.size(), 0.9 * static_cast<double>(most));
  EXPECT_LE(result.mesh.surface.triangles.size(), 2.5 * static_cast<double>(most));
}

TEST(SimplifyToErrorsTest, WhatCannotBeSimplifiedComesBack) {
  const AttributedMesh mesh = WeldSoups({shapes::TexturedGrid(6, 6, 0.3f)}).value();
  const SimplifiedSurface result = Simplify(mesh, {1e-6, {1e-2, 1e-2}});
  EXPECT_EQ(result.mesh.surface.triangles.size(), 72u);
}

// Charts of two triangles each, of which most have to stay: the search begins at fewer than there can be.
TEST(SimplifyToErrorsTest, ManyChartsAreSimplifiedAsFarAsTheyCanBe) {
  constexpr int kCharts = 40;
  std::vector<VertexSoup> soups;
  for (int i = 0; i < kCharts; ++i) {
    VertexSoup chart = shapes::TexturedGrid(i == 0 ? 4 : 1, i == 0 ? 4 : 1);
    for (Vec3f& p : chart.positions) p += Vec3f{2.0f * static_cast<float>(i), 0, 0};
    soups.push_back(std::move(chart));
  }
  const AttributedMesh mesh = WeldSoups(soups).value();
  const size_t all = mesh.surface.triangles.size();
  ASSERT_EQ(all, 2u * (kCharts - 1) + 32u);
  const ErrorTargets targets{1e-3, {1, 1}};
  const SimplifiedSurface result = Simplify(mesh, targets);
  EXPECT_TRUE(result.meets_targets);
  EXPECT_LT(result.mesh.surface.triangles.size(), all - 20);
  EXPECT_GE(result.mesh.surface.triangles.size(), 2u * kCharts);
}

TEST(SimplifyToErrorsTest, GoesToTheEndWhereTargetsAllow) {
  const AttributedMesh mesh = WeldSoups({shapes::TexturedBox(6)}).value();
  EXPECT_EQ(Simplify(mesh, {1e-3, {1, 1}}).mesh.surface.triangles.size(), 12u);
}

// A large bump whose texture is plain beside a small patch with a texture that is bent: its error is a mean over the patch alone.
TEST(SimplifyToErrorsTest, WhatASmallPartHasDoesNotHoldTheRest) {
  const VertexSoup large = shapes::TexturedGrid(60, 60, 0.3f);
  VertexSoup patch = shapes::TexturedGrid(20, 20);
  for (Vec3f& p : patch.positions) p = p * 0.1f + Vec3f{2, 0, 0};
  patch.attributes[0].name = "TEXCOORD_1";
  for (size_t i = 0; i < patch.attributes[0].values.size(); i += 2) {
    float& u = patch.attributes[0].values[i];
    u += 0.1f * std::sin(9 * u);
  }
  const AttributedMesh mesh = WeldSoups({large, patch}).value(), alone = WeldSoups({large}).value();
  const ErrorTargets targets{5e-4, {1, 2, 1}}, of_large{5e-4, {1, 2}};
  const SimplifiedSurface both = Simplify(mesh, targets);
  EXPECT_LE(WorstRatio(both.errors, targets), 1);
  const auto of_patch = static_cast<size_t>(std::count(both.mesh.groups.begin(), both.mesh.groups.end(), 1u));
  const size_t rest = both.mesh.groups.size() - of_patch, wanted = Simplify(alone, of_large).mesh.surface.triangles.size();
  EXPECT_GT(of_patch, 20u);
  EXPECT_LT(of_patch, 800u);
  EXPECT_GT(2 * rest, wanted);
  EXPECT_LT(rest, 3 * wanted);  // 3.9 times where weights do not know of the share
}

TEST(SimplifyToErrorsTest, TheWorstRatioIsOfAllThatIsBounded) {
  SurfaceErrors errors;
  errors.distance = 1;
  errors.attributes = {{2, 6, 50, 1}};
  errors.turned = 1e-3;
  ErrorTargets targets{2, {8}};
  EXPECT_EQ(WorstRatio(errors, targets), 0.5);
  targets.everywhere = {8};
  EXPECT_EQ(WorstRatio(errors, targets), 0.75);
  targets.turned = 5e-4;
  EXPECT_EQ(WorstRatio(errors, targets), 2);
  errors.against_normals = 2e-3;
  EXPECT_EQ(WorstRatio(errors, targets), 4);
}

TEST(SimplifyToErrorsTest, OnlyWhatTurnsBesidesTheOriginalsOwnCounts) {
  AttributedMesh mesh = WeldSoups({shapes::TexturedBox(4)}).value();  // 192 triangles of one size
  std::swap(mesh.surface.triangles[20][0], mesh.surface.triangles[20][1]);
  const auto meter = SurfaceErrorMeter::Create(mesh);
  ASSERT_TRUE(meter.ok());
  EXPECT_EQ(meter.value().Measure(mesh, 1000).value().against_normals, 0);
  std::swap(mesh.surface.triangles[100][0], mesh.surface.triangles[100][1]);
  EXPECT_NEAR(meter.value().Measure(mesh, 1000).value().against_normals, 1.0 / 192, 1e-6);
}

TEST(SimplifyToErrorsTest, SmallPartsAreSearchedWithFewerSamples) {
  EXPECT_EQ(SamplesToTell(12, 10'000), 2000u);
  EXPECT_EQ(SamplesToTell(250, 10'000), 4000u);
  EXPECT_EQ(SamplesToTell(625, 10'000), 10'000u);
  EXPECT_EQ(SamplesToTell(1'000'000, 100'000), 100'000u);
  EXPECT_EQ(SamplesToTell(12, 500), 500u);
}

// A part of few triangles, about which few samples are asked: what it is held to is measured with all.
TEST(SimplifyToErrorsTest, SmallPartsMeetTheirTargets) {
  const AttributedMesh mesh = WeldSoups({shapes::TexturedGrid(8, 8, 0.3f)}).value();
  const ErrorTargets targets{8e-3, {3, 8}};
  const SimplifiedSurface result = Simplify(mesh, targets);
  EXPECT_LT(result.mesh.surface.triangles.size(), mesh.surface.triangles.size());
  const SurfaceErrors errors = SurfaceErrorMeter::Create(mesh).value().Measure(result.mesh, 100'000).value();
  EXPECT_LE(WorstRatio(errors, targets), 1);
  EXPECT_GE(WorstRatio(errors, targets), 0.7);
}

TEST(SimplifyToErrorsTest, TargetsAreByKind) {
  VertexSoup soup = shapes::TexturedGrid(2, 2);
  soup.attributes.push_back({"COLOR_0", AttributeKind::kColor, 1, std::vector<float>(9, 0.5f)});
  soup.attributes.push_back({"_HEAT", AttributeKind::kGeneric, 1, {0, 1, 2, 3, 4, 5, 6, 7, 8}});
  const ErrorTargets targets = TargetsFor(WeldSoups({soup}).value(), 0.5, 2, 3);
  EXPECT_EQ(targets.distance, 0.5);
  EXPECT_THAT(targets.attributes, testing::ElementsAre(2, 3, 1.0 / 256, testing::DoubleNear(0.008, 1e-9)));
}

TEST(SimplifyToErrorsTest, RefusesTargetsThatAreNone) {
  const AttributedMesh mesh = WeldSoups({shapes::TexturedGrid(2, 2)}).value();
  const SurfaceErrorMeter meter = SurfaceErrorMeter::Create(mesh).value();
  EXPECT_EQ(SimplifyToErrors(mesh, meter, {1, {1}}).status().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(SimplifyToErrors(mesh, meter, {0, {1, 1}}).status().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(SimplifyToErrors(mesh, meter, {1, {1, 0}}).status().code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace lacerta
