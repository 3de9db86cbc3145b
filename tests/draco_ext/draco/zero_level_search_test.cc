// Stock Draco streams at a target.
#include "draco/zero_level_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "draco/bounded_simplification.h"
#include "draco/zero_level.h"
#include "lacerta/clean.h"
#include "lacerta/codec.h"
#include "shapes/real_meshes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

class ZeroLevelSearchTest : public ::testing::Test {
 protected:
  ZeroLevelSearchTest() : mesh_(shapes::BumpySphere(4, 0.2f)), meter_(SurfaceDistanceMeter::Create(mesh_).value()) {}

  double PsnrOf(const TriangleMesh& mesh) const { return Psnr(meter_.Measure(mesh).value().Rms(), meter_.diagonal()); }

  void ExpectIsWhatItSays(const ZeroLevelStream& stream) const {
    EXPECT_DOUBLE_EQ(stream.psnr, PsnrOf(stream.mesh));
    EXPECT_DOUBLE_EQ(stream.psnr, Psnr(stream.distance, meter_.diagonal()));
    const DecodedMesh decoded = DecodeMesh(stream.stream, DecodeOptions()).value();
    EXPECT_EQ(decoded.num_levels, 0);
    EXPECT_EQ(decoded.mesh.triangles, stream.mesh.triangles);
  }

  TriangleMesh mesh_;  // 5120 triangles
  SurfaceDistanceMeter meter_;
};

TEST_F(ZeroLevelSearchTest, MeetsAPsnrClosely) {
  for (const double target : {45.0, 60.0}) {
    const ZeroLevelStream stream = CodeZeroLevel(mesh_, meter_, {false, 0, target}).value();
    EXPECT_TRUE(stream.meets_target);
    EXPECT_GE(stream.psnr, target);
    EXPECT_LT(stream.psnr, target + 0.5);
    ExpectIsWhatItSays(stream);
    EXPECT_LT(stream.mesh.triangles.size(), mesh_.triangles.size() / 2);
  }
}

// What is nothing in the mean, simplified, fitted and rounded.
TEST(ZeroLevelSearch, GoesNoFartherAnywhereThanItsSimplificationAllows) {
  const TriangleMesh mesh = shapes::WithStick(shapes::BumpySphere(4, 0.2f), 0.001f, 0.5f);
  const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(mesh).value();
  const auto farthest_at = [&](const SimplificationSequence& sequence, double psnr) {
    const ResolvedTarget target{false, 0, psnr};
    const ZeroLevelStream stream = CodeZeroLevel(mesh, sequence, meter, target, SearchEffort()).value();
    EXPECT_TRUE(stream.meets_target);
    return meter.Measure(stream.mesh).value().Hausdorff() / DistanceOfPsnr(target.psnr, meter.diagonal());
  };
  double unbounded = 0, bounded = 0;  // an unbounded simplification loses the stick at some PSNR, by chance
  for (const double psnr : {46.0, 54.0, 64.0}) {
    unbounded = std::max(unbounded, farthest_at(SimplificationSequence(mesh), psnr));
    bounded = std::max(bounded, farthest_at(BoundedSimplification(mesh, meter, {false, 0, psnr}), psnr));
  }
  EXPECT_GT(unbounded, 1.5 * kFarthestOverMean);
  EXPECT_LT(bounded, 1.3 * kFarthestOverMean);
  EXPECT_GT(bounded, 0.3 * kFarthestOverMean);
}

// A rate may be too low for it.
TEST(ZeroLevelSearch, SimplificationIsBoundedAtAPsnr) {
  const TriangleMesh mesh = shapes::BumpySphere(3, 0.2f);
  const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(mesh).value();
  const SimplificationSequence at_psnr = BoundedSimplification(mesh, meter, {false, 0, 60}), at_rate = BoundedSimplification(mesh, meter, {true, 1000, 0});
  ASSERT_NE(at_psnr.original(), nullptr);
  EXPECT_DOUBLE_EQ(at_psnr.original()->farthest(), kFarthestOverMean * DistanceOfPsnr(60, meter.diagonal()));
  EXPECT_EQ(at_rate.original(), nullptr);
  EXPECT_GT(at_psnr.fewest_triangles(), at_rate.fewest_triangles());
}

// Which is hard where the whole mesh is as regular as this one.
TEST_F(ZeroLevelSearchTest, IsSmallerThanTheWholeMesh) {
  for (const int bits : {7, 10}) {
    const CodedZeroLevel whole = EncodeZeroLevel(mesh_, bits).value();
    const ZeroLevelStream stream = CodeZeroLevel(mesh_, meter_, {false, 0, PsnrOf(whole.mesh)}).value();
    EXPECT_TRUE(stream.meets_target);
    EXPECT_LT(stream.stream.size(), whole.stream.size());
  }
}

TEST_F(ZeroLevelSearchTest, FillsANumberOfBytes) {
  double last_psnr = 0;
  for (const double bytes : {400.0, 2000.0}) {
    const ZeroLevelStream stream = CodeZeroLevel(mesh_, meter_, {true, bytes, 0}).value();
    EXPECT_TRUE(stream.meets_target);
    EXPECT_LE(static_cast<double>(stream.stream.size()), bytes);
    EXPECT_GT(static_cast<double>(stream.stream.size()), 0.9 * bytes);
    EXPECT_GT(stream.psnr, last_psnr + 6);
    last_psnr = stream.psnr;
    ExpectIsWhatItSays(stream);
  }
}

TEST_F(ZeroLevelSearchTest, SaysWhenNothingMeetsTheTarget) {
  const StatusOr<ZeroLevelStream> coded = CodeZeroLevel(mesh_, meter_, {true, 50, 0});
  ASSERT_TRUE(coded.ok()) << coded.status().message();
  EXPECT_FALSE(coded.value().meets_target);
  EXPECT_GT(coded.value().stream.size(), 50u);
  EXPECT_LT(coded.value().stream.size(), 300u);
  const StatusOr<ZeroLevelStream> finest = CodeZeroLevel(mesh_, meter_, {false, 0, 199});
  ASSERT_TRUE(finest.ok()) << finest.status().message();
  EXPECT_FALSE(finest.value().meets_target);
  EXPECT_LT(finest.value().psnr, 199);
  EXPECT_GT(finest.value().psnr, 100);
}

TEST_F(ZeroLevelSearchTest, ReachesWhatOnlyTheWholeMeshReaches) {
  const ZeroLevelStream stream = CodeZeroLevel(mesh_, meter_, {false, 0, 100}).value();
  EXPECT_TRUE(stream.meets_target);
  EXPECT_EQ(stream.mesh.triangles.size(), mesh_.triangles.size());
  EXPECT_LT(stream.psnr, 103);
}

// Samples spread over the area alone would hardly meet the spheres; the last case is only met by a larger mesh than the search found.
TEST_F(ZeroLevelSearchTest, MeetsThePsnrWhereMostFacesAreOnSmallParts) {
  struct Case {
    int num_spheres;
    float radius;
    double target;
  };
  for (const Case& c : {Case{40, 0.004f, 80}, {30, 0.006f, 85}, {60, 0.004f, 95}}) {
    SCOPED_TRACE(c.num_spheres);
    const TriangleMesh mesh = shapes::SpheresOverAPlate(c.num_spheres, c.radius);
    const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(mesh).value();
    const ZeroLevelStream stream = CodeZeroLevel(mesh, meter, {false, 0, c.target}).value();
    EXPECT_TRUE(stream.meets_target) << stream.psnr;
    EXPECT_LT(stream.psnr, c.target + 2);
    EXPECT_LT(stream.mesh.triangles.size(), mesh.triangles.size() / 2);
  }
}

// The target allows far more than the size of all that there is: the coarsest lattices leave no area, which is no reason to try every size.
TEST_F(ZeroLevelSearchTest, EndsSoonWhereATriangleIsFarAway) {
  constexpr float kAway = 30'000;
  TriangleMesh mesh = mesh_;
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (const Vec3f& corner : {Vec3f{kAway, 0, 0}, Vec3f{kAway, 0.02f, 0}, Vec3f{kAway, 0, 0.02f}}) mesh.positions.push_back(corner);
  mesh.triangles.push_back({{first, first + 1, first + 2}});
  const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(mesh).value();
  const ZeroLevelStream stream = CodeZeroLevel(mesh, meter, {false, 0, 70.0}).value();
  EXPECT_TRUE(stream.meets_target) << stream.psnr;
  EXPECT_LE(stream.mesh.triangles.size(), 10);
}

TEST_F(ZeroLevelSearchTest, CodesEveryShape) {
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    SCOPED_TRACE(shape.name);
    const TriangleMesh mesh = Clean(shape.mesh).value().mesh;
    const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(mesh).value();
    const StatusOr<ZeroLevelStream> stream = CodeZeroLevel(mesh, meter, {false, 0, 45});
    ASSERT_TRUE(stream.ok()) << stream.status().message();
    EXPECT_TRUE(stream.value().meets_target);
    EXPECT_LE(stream.value().mesh.triangles.size(), mesh.triangles.size());
  }
}

TEST_F(ZeroLevelSearchTest, SimplerOnlyWhereItBeatsWhatThereIs) {
  const ResolvedTarget target{false, 0, 50};
  MeasuredStream coded;
  coded.meets_target = true;
  coded.psnr = 50.1;
  coded.stream.base = Bytes(6000);
  const SimplificationSequence sequence(mesh_);
  SimplerStream simpler(mesh_, sequence, meter_, target);
  ASSERT_TRUE(simpler.IsBetterThan(coded).value());
  EXPECT_TRUE(simpler.stream().meets_target);
  EXPECT_LT(simpler.stream().stream.size(), coded.stream.size());
  for (const double part : {0.5, 0.95}) {
    coded.stream.base = Bytes(static_cast<size_t>(part * static_cast<double>(simpler.stream().stream.size())));
    EXPECT_FALSE(SimplerStream(mesh_, sequence, meter_, target).IsBetterThan(coded).value());
  }
  coded.stream.base = Bytes(coded.stream.base.size() / 2);
  coded.meets_target = false;
  EXPECT_TRUE(SimplerStream(mesh_, sequence, meter_, target).IsBetterThan(coded).value());
}

TEST_F(ZeroLevelSearchTest, TellsBeforeThereIsAStreamWhetherItTakesFewerBytes) {
  const ResolvedTarget target{false, 0, 50}, rate{true, 2000, 0};
  const ZeroLevelStream least = CodeZeroLevel(mesh_, meter_, target).value();
  const auto bytes = static_cast<double>(least.stream.size());
  const SimplificationSequence sequence(mesh_);
  SimplerStream simpler(mesh_, sequence, meter_, target);
  EXPECT_FALSE(simpler.MayTakeFewerThan(1e9)) << "nothing was looked at";
  EXPECT_FALSE(simpler.TakesFewerThan(0.7 * bytes).value());
  EXPECT_TRUE(simpler.MayTakeFewerThan(1.5 * bytes));
  EXPECT_FALSE(simpler.MayTakeFewerThan(0.5 * bytes));
  ASSERT_TRUE(simpler.TakesFewerThan(1.5 * bytes).value());
  EXPECT_EQ(simpler.stream().stream, least.stream);
  EXPECT_FALSE(simpler.TakesFewerThan(0.7 * bytes).value());
  MeasuredStream coded;
  coded.meets_target = true;
  coded.psnr = 50.1;
  coded.stream.base = Bytes(2 * least.stream.size());
  EXPECT_TRUE(simpler.IsBetterThan(coded).value());
  EXPECT_EQ(simpler.stream().stream, least.stream);
  EXPECT_FALSE(SimplerStream(mesh_, sequence, meter_, rate).TakesFewerThan(1e9).value());
}

TEST_F(ZeroLevelSearchTest, WhatWasPreparedBesideAStreamIsWhatIsFoundWithoutThat) {
  for (const ResolvedTarget& target : {ResolvedTarget{false, 0, 50}, ResolvedTarget{true, 2000, 0}}) {
    MeasuredStream coded;
    coded.meets_target = true;
    coded.psnr = target.is_rate ? 30 : 50.1;
    coded.stream.base = Bytes(target.is_rate ? 2000 : 6000);
    const SimplificationSequence sequence(mesh_);
    SimplerStream late(mesh_, sequence, meter_, target), early(mesh_, sequence, meter_, target), hopeless(mesh_, sequence, meter_, target);
    ASSERT_TRUE(late.IsBetterThan(coded).value());
    early.PrepareBeside(5000);
    const Bytes prepared = early.stream().stream;
    ASSERT_TRUE(early.IsBetterThan(coded).value());
    EXPECT_EQ(early.stream().stream, prepared);
    EXPECT_EQ(late.stream().stream, prepared);
    if (target.is_rate) continue;
    hopeless.PrepareBeside(10);
    ASSERT_TRUE(hopeless.IsBetterThan(coded).value());
    EXPECT_EQ(hopeless.stream().stream, prepared);
  }
}

// Of large meshes one look tells whether a simplified one is worth trying: not at a fifth of the bytes it takes, never where it is better.
TEST_F(ZeroLevelSearchTest, LargeMeshesAreNotDismissedWhereASimplerOneIsBetter) {
  for (const TriangleMesh& mesh : {shapes::BumpySphere(5, 0.2f), shapes::Torus(160, 64)}) {
    const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(mesh).value();
    const ResolvedTarget target{false, 0, 55};
    const SimplificationSequence sequence = BoundedSimplification(mesh, meter, target);
    const ZeroLevelStream least = CodeZeroLevel(mesh, meter, target).value();
    ASSERT_TRUE(least.meets_target);
    ASSERT_LT(8 * least.stream.size(), mesh.triangles.size()) << "too fine to be judged by one look";
    MeasuredStream coded;
    coded.meets_target = true;
    coded.psnr = 55.1;
    SimplerStream simpler(mesh, sequence, meter, target);
    const auto is_better_than = [&](double share) {
      coded.stream.base = Bytes(static_cast<size_t>(share * static_cast<double>(least.stream.size())));
      return simpler.IsBetterThan(coded).value();
    };
    EXPECT_FALSE(is_better_than(0.2));
    ASSERT_TRUE(is_better_than(1.3));
    EXPECT_EQ(simpler.stream().stream, least.stream);
  }
}

TEST_F(ZeroLevelSearchTest, BeatsTheBestKnownOnRealMeshes) {
  struct Case {
    const char* name;
    double psnr;
    size_t known;  // fewest bytes of any simplifier followed by Draco that we measured
  };
  int tried = 0;
  for (const Case& c : {Case{"fandisk.ply", 65, 781}, Case{"fandisk.ply", 75, 1340}, Case{"camelhead.ply", 60, 1557}, Case{"beetle.ply", 70, 2767}}) {
    const auto mesh = testing::RealMesh(c.name);
    if (!mesh.has_value()) continue;
    SCOPED_TRACE(c.name);
    ++tried;
    const TriangleMesh cleaned = Clean(*mesh).value().mesh;
    const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(cleaned).value();
    const ZeroLevelStream stream = CodeZeroLevel(cleaned, meter, {false, 0, c.psnr}).value();
    EXPECT_TRUE(stream.meets_target);
    EXPECT_LT(static_cast<double>(stream.stream.size()), 0.75 * static_cast<double>(c.known));
    EXPECT_GT(static_cast<double>(stream.stream.size()), 0.3 * static_cast<double>(c.known));
  }
  if (tried == 0) GTEST_SKIP() << "no real mesh in " LACERTA_TEST_DATA_DIR;
}

}  // namespace
}  // namespace lacerta
