#include "remesh/attributed_proxy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

constexpr double kAny = std::numeric_limits<double>::infinity();

class AttributedProxyTest : public ::testing::Test {
 protected:
  std::optional<AttributedMesh> ProxyFor(const ErrorTargets& targets, const AttributedProxyOptions& options) const {
    return AttributedProxy(mesh_, meter_, targets, options).value();
  }

  const AttributedMesh mesh_ = WeldSoups({shapes::TexturedGrid(100, 100, 0.3f)}).value();  // 20,000 triangles
  const SurfaceErrorMeter meter_ = SurfaceErrorMeter::Create(mesh_).value();
};

TEST_F(AttributedProxyTest, HasAsFewTrianglesAsItsSharesOfTheErrorsAllow) {
  AttributedProxyOptions options;
  options.fewest_triangles = 500;
  for (const ErrorTargets& targets : {ErrorTargets{1e-3, {kAny, kAny}}, {kAny, {0.3, kAny}}, {kAny, {kAny, 2}}, {1e-3, {0.3, 2}}}) {
    const std::optional<AttributedMesh> proxy = ProxyFor(targets, options);
    ASSERT_TRUE(proxy.has_value());
    const SurfaceErrors errors = meter_.Measure(*proxy, 100'000).value();
    const double worst = std::max({errors.distance / targets.distance / options.share, errors.attributes[0].rms_99 / targets.attributes[0] / options.attribute_share,
                                   errors.attributes[1].rms_99 / targets.attributes[1] / options.attribute_share});
    EXPECT_LE(worst, 1.05);
    EXPECT_GE(worst, 0.2);  // half the triangles would have been taken otherwise
    EXPECT_LE(proxy->surface.triangles.size(), mesh_.surface.triangles.size() / 2);
    EXPECT_GE(proxy->surface.triangles.size(), 490u);
  }
}

TEST_F(AttributedProxyTest, IsNotThereForSmallInputsAndFineTargets) {
  const ErrorTargets loose{1, {100, 90}}, fine{1e-3, {0.01, kAny}};
  EXPECT_FALSE(ProxyFor(loose, {}).has_value());
  AttributedProxyOptions options;
  options.fewest_triangles = 500;
  const std::optional<AttributedMesh> proxy = ProxyFor(loose, options);
  ASSERT_TRUE(proxy.has_value());
  EXPECT_LE(proxy->surface.triangles.size(), 500u);
  EXPECT_FALSE(ProxyFor(fine, options).has_value());
}

// Normals off by noise that no number of triangles follows, and that no coarser surface has: the distances tell how coarse it may be.
TEST_F(AttributedProxyTest, IsThereBesideNoiseThatLeavesRoom) {
  AttributedMesh noisy = mesh_;
  std::vector<float>& normals = noisy.attributes[1].values;
  for (size_t i = 0; i < normals.size(); ++i) normals[i] += 0.03f * std::sin(static_cast<float>(7919 * i));
  const SurfaceErrorMeter meter = SurfaceErrorMeter::Create(noisy).value();
  AttributedProxyOptions options;
  options.fewest_triangles = 500;
  const ErrorTargets targets{1e-3, {kAny, 2}};
  const std::optional<AttributedMesh> proxy = AttributedProxy(noisy, meter, targets, options).value();
  ASSERT_TRUE(proxy.has_value());
  const double degrees = meter.Measure(*proxy, 100'000).value().attributes[1].rms_99;
  EXPECT_LE(degrees, targets.attributes[1]);
  EXPECT_GE(degrees, 1.5 * options.attribute_share * targets.attributes[1]);
  EXPECT_LE(proxy->surface.triangles.size(), noisy.surface.triangles.size() / 2);
  EXPECT_FALSE(AttributedProxy(noisy, meter, {1e-3, {kAny, degrees / 1.2}}, options).value().has_value());
}

TEST_F(AttributedProxyTest, SaysWhereNearlyAllTrianglesAreNeeded) {
  AttributedProxyOptions options;
  options.fewest_triangles = 500;
  EXPECT_TRUE(AttributedProxy(mesh_, meter_, {1e-3, {0.01, kAny}}, options).ok());
  EXPECT_EQ(AttributedProxy(mesh_, meter_, {1e-3, {1e-4, kAny}}, options).status().code(), StatusCode::kUnsupported);
}

TEST_F(AttributedProxyTest, IsMadeOfPartsWhereThereAreTooManyForOneRun) {
  AttributedProxyOptions options;
  options.fewest_triangles = 500;
  options.most_at_once = 5000;
  options.part_triangles = 5000;
  for (const double texels : {0.5, 0.05}) {
    const ErrorTargets targets{kAny, {texels, kAny}};
    const std::optional<AttributedMesh> proxy = ProxyFor(targets, options);
    ASSERT_TRUE(proxy.has_value()) << texels;
    const double error = meter_.Measure(*proxy, 100'000).value().attributes[0].rms_99;
    EXPECT_LE(error, 0.95 * texels);
    EXPECT_GE(error, 0.05 * texels);
    EXPECT_LE(proxy->surface.triangles.size(), 5200u);
  }
  const StatusOr<std::optional<AttributedMesh>> fine = AttributedProxy(mesh_, meter_, {kAny, {0.01, kAny}}, options);
  ASSERT_EQ(fine.status().code(), StatusCode::kUnsupported);
  EXPECT_NE(fine.status().message().find("it needs more than "), std::string::npos) << fine.status().message();
}

// Of a small reduction first, of a larger one where that is not near enough, and of the whole where that may not be reduced so far.
TEST_F(AttributedProxyTest, IsMadeOfTheFirstReductionThatIsNearEnough) {
  AttributedProxyOptions options;
  options.fewest_triangles = 500;
  options.most_at_once = 20'000;
  options.part_triangles = 5000;
  AttributedProxyOptions in_parts = options;
  in_parts.first_at_once = 2000;
  for (const double texels : {2.0, 0.1}) {
    const ErrorTargets targets{kAny, {texels, kAny}};
    const std::optional<AttributedMesh> proxy = ProxyFor(targets, in_parts), of_whole = ProxyFor(targets, options);
    ASSERT_TRUE(proxy.has_value() && of_whole.has_value()) << texels;
    EXPECT_LE(meter_.Measure(*proxy, 100'000).value().attributes[0].rms_99, 1.5 * options.attribute_share * texels);
    EXPECT_EQ(proxy->surface.positions != of_whole->surface.positions, proxy->surface.triangles.size() <= 2000) << texels;
    EXPECT_EQ(proxy->surface.triangles.size() <= 2000, texels > 1);
  }
}

TEST_F(AttributedProxyTest, IsReducedInPartsWhereThatHalvesIt) {
  AttributedProxyOptions options;
  options.fewest_triangles = 500;
  options.part_triangles = 5000;
  const ErrorTargets targets{kAny, {2.0, kAny}};
  const std::vector<Vec3f> of_whole = ProxyFor(targets, options)->surface.positions;
  const auto half = static_cast<uint32_t>(mesh_.surface.triangles.size() / 2);
  // As the first size, as the last, as both, and as a first one that is larger than the last.
  for (const auto& [first, most, in_parts] : std::vector<std::tuple<uint32_t, uint32_t, bool>>{
           {half, 4 * half, true}, {half + 1, 4 * half, false}, {4 * half, half, true}, {4 * half, half + 1, false}, {half, half, true}}) {
    options.first_at_once = first;
    options.most_at_once = most;
    const std::optional<AttributedMesh> proxy = ProxyFor(targets, options);
    ASSERT_TRUE(proxy.has_value());
    EXPECT_EQ(proxy->surface.positions != of_whole, in_parts) << first << " " << most;
  }
}

TEST(AttributedProxy, IsNotThereWhereSeamsLeaveMoreThanHalf) {
  const AttributedMesh mesh = WeldSoups({shapes::Unwelded(shapes::TexturedGrid(20, 20), 0.2f)}).value();  // every edge is a seam
  const SurfaceErrorMeter meter = SurfaceErrorMeter::Create(mesh).value();
  AttributedProxyOptions options;
  options.fewest_triangles = 100;
  EXPECT_EQ(AttributedProxy(mesh, meter, {kAny, {kAny, kAny}}, options).status().code(), StatusCode::kUnsupported);
}

}  // namespace
}  // namespace lacerta
