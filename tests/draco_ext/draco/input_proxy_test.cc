#include "draco/input_proxy.h"

#include <gtest/gtest.h>

#include "shapes/shapes.h"

namespace lacerta {
namespace {

ResolvedTarget AtPsnr(double psnr) {
  ResolvedTarget target;
  target.psnr = psnr;
  return target;
}

class InputProxyTest : public ::testing::Test {
 protected:
  double DistanceOf(const TriangleMesh& mesh) const { return meter_.Measure(mesh, SurfaceDistanceOptions::RmsOnly()).value().Rms(); }

  const TriangleMesh mesh_ = shapes::BumpySphere(6);  // 81,920 triangles
  const SurfaceDistanceMeter meter_ = SurfaceDistanceMeter::Create(mesh_).value();
};

TEST_F(InputProxyTest, HasAsFewTrianglesAsItsShareOfTheErrorAllows) {
  InputProxyOptions options;
  options.fewest_triangles = 1000;
  uint64_t before = 0;
  for (const double psnr : {40.0, 60.0, 75.0}) {
    const std::optional<TriangleMesh> proxy = InputProxy(mesh_, meter_, AtPsnr(psnr), options);
    ASSERT_TRUE(proxy.has_value()) << psnr;
    EXPECT_LE(DistanceOf(*proxy), 1.05 * options.share * DistanceOfPsnr(psnr, meter_.diagonal()));
    EXPECT_GE(proxy->triangles.size(), std::max<uint64_t>(before, 990));
    EXPECT_LE(proxy->triangles.size(), mesh_.triangles.size() / 2);
    before = proxy->triangles.size();
  }
  EXPECT_GT(before, 2000u);
}

TEST_F(InputProxyTest, IsNotThereForSmallInputsAndFineTargets) {
  EXPECT_FALSE(InputProxy(mesh_, meter_, AtPsnr(40)).has_value());
  InputProxyOptions options;
  options.fewest_triangles = 1000;
  EXPECT_FALSE(InputProxy(mesh_, meter_, AtPsnr(120), options).has_value());
}

// By parts where so few triangles are near enough, as a whole beyond. What the first reduction lost counts as noise: at four fifths of its size, which
// is the most that is taken of it, errors may be half as large again for that.
TEST_F(InputProxyTest, IsMadeOfPartsWhereThoseAreNearEnough) {
  InputProxyOptions whole;
  whole.fewest_triangles = 1000;
  InputProxyOptions parts = whole;
  parts.most_at_once = 5000;
  parts.part_triangles = 5000;
  for (const double psnr : {45.0, 60.0, 75.0}) {
    const std::optional<TriangleMesh> by_parts = InputProxy(mesh_, meter_, AtPsnr(psnr), parts), at_once = InputProxy(mesh_, meter_, AtPsnr(psnr), whole);
    ASSERT_TRUE(by_parts.has_value() && at_once.has_value()) << psnr;
    EXPECT_LE(DistanceOf(*by_parts), 1.5 * parts.share * DistanceOfPsnr(psnr, meter_.diagonal()));
    EXPECT_LE(by_parts->triangles.size(), 2 * at_once->triangles.size());
    EXPECT_GE(by_parts->triangles.size(), at_once->triangles.size() / 2);
    EXPECT_EQ(by_parts->triangles != at_once->triangles, by_parts->triangles.size() <= 5000) << psnr;
  }
}

// Each keeps a triangle: sizes below their number need not be tried, nor those above it that are no halves.
TEST_F(InputProxyTest, IsNotLookedForAmongFewerTrianglesThanComponents) {
  InputProxyOptions options;
  options.fewest_triangles = 64;
  const TriangleMesh soup = shapes::TriangleSoup(3);
  const SurfaceDistanceMeter of_soup = SurfaceDistanceMeter::Create(soup).value();
  EXPECT_FALSE(InputProxy(soup, of_soup, AtPsnr(10), options).has_value());
  const TriangleMesh pieces = shapes::Scattered(shapes::Icosphere(1), 300);
  const SurfaceDistanceMeter of_pieces = SurfaceDistanceMeter::Create(pieces).value();
  const std::optional<TriangleMesh> proxy = InputProxy(pieces, of_pieces, AtPsnr(20), options);
  ASSERT_TRUE(proxy.has_value());
  EXPECT_GE(proxy->triangles.size(), 300u);
  EXPECT_LE(proxy->triangles.size(), 1200u);
}

TEST_F(InputProxyTest, SequenceIsThatOfTheMesh) {
  const ResolvedTarget target = AtPsnr(40);
  ProxiedInput input(mesh_, meter_, target);
  EXPECT_EQ(&input.Mesh(), &mesh_);
  EXPECT_EQ(&input.Sequence(), &input.Sequence());
  EXPECT_EQ(input.Sequence().num_input_triangles(), mesh_.triangles.size());
}

TEST_F(InputProxyTest, BytesAskForWhatTheyUsuallyBring) {
  InputProxyOptions options;
  options.fewest_triangles = 20'000;
  ResolvedTarget target;
  target.is_rate = true;
  target.bytes = 300;
  const std::optional<TriangleMesh> proxy = InputProxy(mesh_, meter_, target, options);
  ASSERT_TRUE(proxy.has_value());
  EXPECT_LT(proxy->triangles.size(), 21'000u);
  target.bytes = 100'000;
  EXPECT_FALSE(InputProxy(mesh_, meter_, target, options).has_value());
}

}  // namespace
}  // namespace lacerta
