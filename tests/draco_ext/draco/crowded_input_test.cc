#include "draco/crowded_input.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "geometry/triangle_tree.h"

namespace lacerta {
namespace {

TriangleMesh Soup(uint32_t num_triangles) {
  std::mt19937 random(num_triangles);
  const auto coordinate = [&] { return static_cast<float>(random() % 10001) / 5000 - 1; };
  TriangleMesh mesh;
  for (uint32_t v = 0; v < num_triangles / 2; ++v) mesh.positions.push_back({coordinate(), coordinate(), coordinate()});
  while (mesh.triangles.size() < num_triangles) {
    const auto vertex = [&] { return static_cast<uint32_t>(random() % mesh.positions.size()); };
    const Triangle t = {vertex(), vertex(), vertex()};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.triangles.push_back(t);
  }
  return mesh;
}

class CrowdedInputTest : public ::testing::Test {
 protected:
  const TriangleMesh mesh_ = Soup(600);
  const SurfaceDistanceMeter meter_ = SurfaceDistanceMeter::Create(mesh_).value();
  const double crowding_ = TriangleTree(mesh_).Crowding();
};

TEST_F(CrowdedInputTest, MeetsAPsnrWithAllTriangles) {
  ASSERT_GT(crowding_, kMostCrowding);
  for (const double psnr : {40.0, 60.0, 80.0}) {
    ResolvedTarget target;
    target.psnr = psnr;
    const ZeroLevelStream stream = CodeCrowdedInput(mesh_, crowding_, meter_, target).value();
    EXPECT_TRUE(stream.meets_target);
    EXPECT_GE(stream.psnr, psnr);
    EXPECT_LE(stream.psnr, psnr + 0.5);
    EXPECT_NEAR(Psnr(meter_.Measure(stream.mesh, SurfaceDistanceOptions::RmsOnly(40'000)).value().Rms(), meter_.diagonal()), stream.psnr, 0.3);
    EXPECT_EQ(stream.mesh.triangles.size(), mesh_.triangles.size());
  }
}

TEST_F(CrowdedInputTest, FewerSamplesTakeNoLonger) {
  for (const uint64_t most : {100'000u, 200'000u}) {
    EXPECT_EQ(SamplesInCrowd(20.0, most), most);
    EXPECT_EQ(SamplesInCrowd(200.0, most), most / 10);
    EXPECT_EQ(SamplesInCrowd(1e6, most), 2'000u);
  }
}

TEST_F(CrowdedInputTest, MeetsARate) {
  for (const double bytes : {1200.0, 1600.0}) {
    ResolvedTarget target;
    target.is_rate = true;
    target.bytes = bytes;
    const ZeroLevelStream stream = CodeCrowdedInput(mesh_, crowding_, meter_, target).value();
    EXPECT_TRUE(stream.meets_target);
    EXPECT_LE(static_cast<double>(stream.stream.size()), bytes);
    EXPECT_GE(static_cast<double>(stream.stream.size()), 0.9 * bytes);
  }
}

TEST_F(CrowdedInputTest, ComesAsNearAsItCan) {
  ResolvedTarget target;
  target.psnr = 190;
  const ZeroLevelStream finest = CodeCrowdedInput(mesh_, crowding_, meter_, target).value();
  EXPECT_FALSE(finest.meets_target);
  EXPECT_GT(finest.psnr, 110.0);
  target.is_rate = true;
  target.bytes = 20;
  const ZeroLevelStream coarsest = CodeCrowdedInput(mesh_, crowding_, meter_, target).value();
  EXPECT_FALSE(coarsest.meets_target);
  EXPECT_LT(coarsest.stream.size(), finest.stream.size() / 3);
}

}  // namespace
}  // namespace lacerta
