// Stock Draco streams at a target.
#include "draco/zero_level_search.h"

#include <gtest/gtest.h>

#include <optional>

#include "draco/zero_level.h"
#include "lacerta/codec.h"
#include "draco_ext/remesh/remeshing.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

class ZeroLevelSearchTest : public ::testing::Test {
 protected:
  ZeroLevelSearchTest() : mesh_(shapes::BumpySphere(4, 0.2f)), meter_(SurfaceDistanceMeter::Create(mesh_).value()) {}

  double PsnrOf(const TriangleMesh& mesh) const { return Psnr(meter_.Measure(mesh).value().Rms(), meter_.diagonal()); }
  double PsnrAtBits(int bits) const { return PsnrOf(EncodeZeroLevel(mesh_, bits).value().mesh); }

  TriangleMesh mesh_;
  SurfaceDistanceMeter meter_;
};

TEST_F(ZeroLevelSearchTest, TakesTheFewestBitsThatReachThePsnr) {
  for (int bits = 7; bits <= 13; bits += 2) {
    const double target = (PsnrAtBits(bits - 1) + PsnrAtBits(bits)) / 2;
    const ZeroLevelStream stream = CodeZeroLevel(mesh_, meter_, {false, 0, target}).value();
    EXPECT_TRUE(stream.meets_target);
    EXPECT_EQ(stream.stream, EncodeZeroLevel(mesh_, bits).value().stream);
    EXPECT_DOUBLE_EQ(stream.psnr, PsnrOf(stream.mesh));
    EXPECT_DOUBLE_EQ(stream.psnr, Psnr(stream.distance, meter_.diagonal()));
  }
}

TEST_F(ZeroLevelSearchTest, TakesTheMostBitsThatKeepToTheBytes) {
  for (const int bits : {8, 12}) {
    const Bytes wanted = EncodeZeroLevel(mesh_, bits).value().stream;
    const ZeroLevelStream stream = CodeZeroLevel(mesh_, meter_, {true, static_cast<double>(wanted.size()), 0}).value();
    EXPECT_TRUE(stream.meets_target);
    EXPECT_EQ(stream.stream, wanted);
  }
}

TEST_F(ZeroLevelSearchTest, SaysWhenNothingMeetsTheTarget) {
  const StatusOr<ZeroLevelStream> coded = CodeZeroLevel(mesh_, meter_, {true, 100, 0});
  ASSERT_TRUE(coded.ok()) << coded.status().message();
  const ZeroLevelStream& small = coded.value();
  EXPECT_FALSE(small.meets_target);
  EXPECT_GT(small.stream.size(), 100u);
  const StatusOr<ZeroLevelStream> finest = CodeZeroLevel(mesh_, meter_, {false, 0, 199});
  ASSERT_TRUE(finest.ok()) << finest.status().message();
  const ZeroLevelStream& fine = finest.value();
  EXPECT_FALSE(fine.meets_target);
  EXPECT_LT(fine.psnr, 199);
  EXPECT_GT(fine.psnr, 100);
}

TEST_F(ZeroLevelSearchTest, SimplerOnlyWhereItBeatsWhatThereIs) {
  const CollapseHistory history = testing::Decimated(mesh_);
  const ResolvedTarget target{false, 0, 50};
  MeasuredStream coded;
  coded.meets_target = true;
  coded.psnr = 50.1;
  coded.stream.base = Bytes(6000);
  const std::optional<ZeroLevelStream> simpler = SimplerIfBetter(mesh_, history, meter_, target, coded).value();
  ASSERT_TRUE(simpler.has_value());
  EXPECT_TRUE(simpler->meets_target);
  EXPECT_GE(simpler->psnr, 50.0);
  EXPECT_LT(simpler->stream.size(), coded.stream.size());
  EXPECT_LE(simpler->mesh.triangles.size(), mesh_.triangles.size());
  EXPECT_TRUE(DecodeMesh(simpler->stream, DecodeOptions()).ok());

  coded.stream.base = Bytes(simpler->stream.size() / 2);
  EXPECT_FALSE(SimplerIfBetter(mesh_, history, meter_, target, coded).value().has_value());
}

TEST_F(ZeroLevelSearchTest, SimplerWhereTheTargetWasMissed) {
  const CollapseHistory history = testing::Decimated(mesh_);
  MeasuredStream coded;
  coded.psnr = 60;
  coded.stream.base = Bytes(2000);
  const std::optional<ZeroLevelStream> simpler = SimplerIfBetter(mesh_, history, meter_, {false, 0, 90}, coded).value();
  ASSERT_TRUE(simpler.has_value());
  EXPECT_TRUE(simpler->meets_target);
  EXPECT_EQ(simpler->mesh.triangles.size(), mesh_.triangles.size());  // nothing simpler is that good
}

}  // namespace
}  // namespace lacerta
