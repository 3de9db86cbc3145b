#include "draco/zero_level_candidate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "draco/component_order.h"
#include "lacerta/surface_distance.h"
#include "remesh/simplify.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using Source = ZeroLevelCandidate::Source;

class ZeroLevelCandidateTest : public ::testing::Test {
 protected:
  ZeroLevelCandidateTest() : mesh_(shapes::BumpySphere(5, 0.2f)), target_(mesh_, 8000) {}

  double SquaredDistance(const TriangleMesh& mesh) const {
    const double distance = MeasureSurfaceDistance(mesh_, mesh, SurfaceDistanceOptions::RmsOnly(30000)).value().Rms();
    return distance * distance;
  }

  TriangleMesh mesh_;
  FitTarget target_;
};

TEST_F(ZeroLevelCandidateTest, FitsASimplifiedMesh) {
  const TriangleMesh simplified = SimplificationSequence(mesh_).MeshWith(500);
  const ZeroLevelCandidate candidate(target_, simplified, Source::kSimplified);
  EXPECT_LT(candidate.fit_distortion(), 0.7 * SquaredDistance(simplified));
  EXPECT_GT(candidate.fit_distortion(), 0.2 * SquaredDistance(simplified));
  EXPECT_EQ(candidate.num_triangles(), simplified.triangles.size());
}

TEST_F(ZeroLevelCandidateTest, KnowsWhatACodingIs) {
  ZeroLevelCandidate candidate(target_, SimplificationSequence(mesh_).MeshWith(500), Source::kSimplified);
  const double added = candidate.fit_distortion();
  candidate.FitForRate(added, 1);
  for (const CodingEffort effort : {CodingEffort::kQuick, CodingEffort::kFull}) {
    const ZeroLevelCandidate::Coding coding = candidate.Code(RateModel::StepFor(added), 2, effort).value();
    EXPECT_EQ(coding.bytes, coding.coded.stream.size());
    EXPECT_EQ(coding.coded.mesh.triangles.size(), candidate.num_triangles());
    const double measured = SquaredDistance(coding.coded.mesh);
    EXPECT_NEAR(coding.distortion, measured, 0.15 * measured);
    EXPECT_NEAR(measured, 2 * added, 0.6 * added);
  }
}

TEST_F(ZeroLevelCandidateTest, FinerStepsAreCloserAndLarger) {
  ZeroLevelCandidate candidate(target_, SimplificationSequence(mesh_).MeshWith(500), Source::kSimplified);
  const double step = RateModel::StepFor(candidate.fit_distortion());
  double last_distortion = 1;
  size_t last_bytes = 0;
  for (const double factor : {4.0, 2.0, 1.0, 0.5}) {
    const ZeroLevelCandidate::Coding coding = candidate.Code(factor * step, 1, CodingEffort::kQuick).value();
    EXPECT_LT(coding.distortion, last_distortion);
    EXPECT_GT(coding.bytes, last_bytes);
    last_distortion = coding.distortion;
    last_bytes = coding.bytes;
  }
  EXPECT_GT(last_distortion, candidate.fit_distortion());
}

// Tetrahedra anywhere in a box, in the order in which they were made or with neighbors after each other.
TEST(ZeroLevelCandidate, ManyComponentsAreCodedFromNeighborToNeighbor) {
  std::mt19937 random(3);
  const auto below = [&](float most) { return most * static_cast<float>(random() % 4096) / 4096; };
  TriangleMesh mesh;
  for (uint32_t i = 0; i < 300; ++i) {
    const Vec3f place{below(10), below(10), below(10)};
    for (const Vec3f& p : {Vec3f{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, {0, 0, 0.1f}}) mesh.positions.push_back(place + p);
    const uint32_t v = 4 * i;
    mesh.triangles.insert(mesh.triangles.end(), {{v, v + 2, v + 1}, {v, v + 1, v + 3}, {v, v + 3, v + 2}, {v + 1, v + 2, v + 3}});
  }
  const FitTarget target(mesh, 8000);
  const auto coded = [&](const TriangleMesh& m) { return ZeroLevelCandidate(target, m, Source::kInput).Code(0.01, 1, CodingEffort::kQuick).value(); };
  TriangleMesh ordered = mesh;
  ordered.triangles = ByNearestComponents(mesh, 2);
  ASSERT_NE(ordered.triangles, mesh.triangles);
  EXPECT_EQ(coded(mesh).coded.stream, coded(ordered).coded.stream);
  EXPECT_EQ(coded(mesh).coded.mesh.triangles.size(), mesh.triangles.size());
}

TEST_F(ZeroLevelCandidateTest, TheInputNeedsNoFit) {
  const ZeroLevelCandidate candidate(target_, mesh_, Source::kInput);
  EXPECT_EQ(candidate.fit_distortion(), 0);
  const double step = 1e-3;
  const ZeroLevelCandidate::Coding coding = candidate.Code(step, 1, CodingEffort::kQuick).value();
  EXPECT_EQ(coding.coded.mesh.triangles.size(), mesh_.triangles.size());
  EXPECT_LT(coding.distortion, step * step / 12);
  EXPECT_GT(coding.distortion, step * step / 1200);
}

// The order of the stream, and what predicts what in it, is worth some percent at the same distance.
TEST_F(ZeroLevelCandidateTest, FitsForTheStreamTakeFewerBytes) {
  const TriangleMesh simplified = SimplificationSequence(mesh_).MeshWith(500);
  ZeroLevelCandidate candidate(target_, simplified, Source::kSimplified);
  const double added = candidate.fit_distortion(), step = RateModel::StepFor(added);
  candidate.FitForRate(added, 2);
  const ZeroLevelCandidate::Coding usual = candidate.Code(step, 3, CodingEffort::kFull).value();
  candidate.FitForStream(step);
  for (const CodingEffort effort : {CodingEffort::kQuick, CodingEffort::kFull}) {
    const ZeroLevelCandidate::Coding known = candidate.Code(step, 3, effort).value();
    EXPECT_LT(known.bytes, 0.985 * static_cast<double>(usual.bytes));
    EXPECT_GT(known.bytes, 0.8 * static_cast<double>(usual.bytes));
    EXPECT_LT(known.distortion, 1.1 * usual.distortion);
    const double measured = SquaredDistance(known.coded.mesh);
    EXPECT_NEAR(known.distortion, measured, 0.15 * measured);
    EXPECT_EQ(known.coded.mesh.triangles.size(), candidate.num_triangles());
  }
}

// What is cut, or coded triangle by triangle, is as whole as it was.
TEST_F(ZeroLevelCandidateTest, FitsForTheStreamLeaveNoTriangleOut) {
  for (const TriangleMesh& mesh : {shapes::Pinched(), shapes::NonManifoldEdge(), shapes::MoebiusBand(12), shapes::Scattered(shapes::Icosphere(0), 20)}) {
    const FitTarget target(mesh, 2000);
    ZeroLevelCandidate candidate(target, mesh, Source::kInput);
    candidate.FitForStream(0.01);
    const ZeroLevelCandidate::Coding coding = candidate.Code(0.01, 2, CodingEffort::kFull).value();
    EXPECT_EQ(coding.coded.mesh.triangles.size(), mesh.triangles.size());
    EXPECT_LT(coding.distortion, 0.01 * 0.01);
  }
}

// More triangles than are fitted are put onto the lattice as they are.
TEST_F(ZeroLevelCandidateTest, LargeMeshesAreRounded) {
  const TriangleMesh large = shapes::BumpySphere(6, 0.2f);
  ASSERT_GT(large.triangles.size(), 60'000u);
  const double off = SquaredDistance(large);
  ZeroLevelCandidate candidate(target_, large, Source::kSimplified);
  EXPECT_NEAR(candidate.fit_distortion(), off, 0.1 * off);
  candidate.FitForRate(off, 2);
  EXPECT_NEAR(candidate.fit_distortion(), off, 0.1 * off);
  const double step = 4e-3;
  const ZeroLevelCandidate::Coding coding = candidate.Code(step, 2, CodingEffort::kQuick).value();
  EXPECT_EQ(coding.coded.mesh.triangles.size(), large.triangles.size());
  const double measured = SquaredDistance(coding.coded.mesh);
  EXPECT_NEAR(coding.distortion, measured, 0.1 * measured);
  EXPECT_GT(measured, step * step / 1200);
  EXPECT_LT(measured, off + step * step / 12);
}

}  // namespace
}  // namespace lacerta
