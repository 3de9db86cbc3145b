// One base size made to meet a target.
#include "draco/candidate_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "draco_ext/draco/candidates.h"
#include "draco_ext/remesh/remeshing.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

// A bumpy sphere remeshed over 60 vertices.
class CandidateSearchTest : public ::testing::Test {
 protected:
  CandidateSearchTest()
      : mesh_(shapes::BumpySphere(4, 0.2f)),
        surface_(mesh_, testing::TopologyOf(mesh_)),
        history_(testing::Decimated(mesh_)),
        meter_(SurfaceDistanceMeter::Create(mesh_).value()),
        candidate_(testing::MakeCandidate({surface_, history_, {}}, 60, 3)),
        remesh_psnr_(PsnrOf(candidate_.RemeshedSurface())) {}

  double PsnrOf(const TriangleMesh& mesh) const { return Psnr(meter_.Measure(mesh).value().Rms(), meter_.diagonal()); }
  CandidateSearch Search(const ResolvedTarget& target) const {
    return CandidateSearch(candidate_, remesh_psnr_, meter_, target, EncodeMode::kDefault);
  }

  TriangleMesh mesh_;
  InputSurface surface_;
  CollapseHistory history_;
  SurfaceDistanceMeter meter_;
  NormalMeshCandidate candidate_;
  double remesh_psnr_;
};

TEST_F(CandidateSearchTest, MeetsPsnrFromBothSides) {
  for (const double psnr : {50.0, 55.0, 60.0}) {
    ASSERT_GT(remesh_psnr_, psnr + 1);
    CandidateSearch search = Search({false, 0, psnr});
    const MeasuredStream stream = search.Meet().value();
    EXPECT_TRUE(stream.meets_target);
    EXPECT_GE(stream.psnr, psnr);
    EXPECT_LT(stream.psnr, psnr + 0.45);  // a coefficient of so small a mesh is worth 0.5 dB
    EXPECT_DOUBLE_EQ(stream.psnr, PsnrOf(stream.stream.FinestMesh()));
    EXPECT_GE(stream.measurements, 2);  // a rough one, and the one that shows that the target is met
    EXPECT_LE(stream.measurements, 12);  // 6 but for jumps of 1 dB, of which so small a mesh has many
  }
}

TEST_F(CandidateSearchTest, MeetsBytesFromBothSides) {
  for (const double bytes : {500.0, 900.0, 2000.0}) {
    CandidateSearch search = Search({true, bytes, 0});
    const MeasuredStream stream = search.Meet().value();
    EXPECT_TRUE(stream.meets_target);
    EXPECT_LE(static_cast<double>(stream.stream.size()), bytes);
    EXPECT_GE(static_cast<double>(stream.stream.size()), 0.94 * bytes);  // a coefficient more or less is 2 % of the smallest
  }
}

TEST_F(CandidateSearchTest, ScoreForesees) {
  CandidateSearch by_psnr = Search({false, 0, 58});
  const double log_bytes = by_psnr.Score().value();
  EXPECT_NEAR(log_bytes, std::log(static_cast<double>(by_psnr.Meet().value().stream.size())), 0.15);
  CandidateSearch by_bytes = Search({true, 900, 0});
  const double minus_psnr = by_bytes.Score().value();
  EXPECT_NEAR(-minus_psnr, PsnrOf(by_bytes.Meet().value().stream.FinestMesh()), 1.5);
}

// Where noise has to be coded a dB costs twice as much as usual: steps with which few bytes reach little must not look good.
TEST(CandidateSearchOfNoiseTest, KeepsWhatItsScoreForesees) {
  const TriangleMesh mesh = shapes::BumpySphere(5, 0.2f, 0.001f);
  const InputSurface surface(mesh, testing::TopologyOf(mesh));
  const CollapseHistory history = testing::Decimated(mesh);
  const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(mesh).value();
  struct Case {
    uint32_t num_base_vertices;
    int num_levels;
    double below;  // the remesh, dB
  };
  for (const Case& c : {Case{60, 3, 7.0}, Case{250, 4, 7.0}}) {
    const NormalMeshCandidate candidate = testing::MakeCandidate({surface, history, {}}, c.num_base_vertices, c.num_levels);
    const double remesh_psnr = Psnr(meter.Measure(candidate.RemeshedSurface()).value().Rms(), meter.diagonal());
    CandidateSearch search(candidate, remesh_psnr, meter, {false, 0, remesh_psnr - c.below}, EncodeMode::kDefault);
    const double log_bytes = search.Score().value();
    const MeasuredStream met = search.Meet().value();
    EXPECT_TRUE(met.meets_target);
    EXPECT_NEAR(std::log(static_cast<double>(met.stream.size())), log_bytes, 0.15);
  }
}

// Steps and levels are chosen by codings near the target; without the finest level it may be out of reach, though hardly.
TEST(CandidateSearchOfNoiseTest, TakesTheFinestLevelWhereNothingElseReachesTheTarget) {
  const TriangleMesh mesh = shapes::BumpySphere(5, 0.2f, 0.001f);
  const InputSurface surface(mesh, testing::TopologyOf(mesh));
  const CollapseHistory history = testing::Decimated(mesh);
  const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(mesh).value();
  const NormalMeshCandidate candidate = testing::MakeCandidate({surface, history, {}}, 250, 4);
  const double remesh_psnr = Psnr(meter.Measure(candidate.RemeshedSurface()).value().Rms(), meter.diagonal());
  for (const double below : {5.0, 7.0, 8.0, 9.0}) {
    CandidateSearch search(candidate, remesh_psnr, meter, {false, 0, remesh_psnr - below}, EncodeMode::kDefault);
    ASSERT_TRUE(search.Score().ok());
    const MeasuredStream met = search.Meet().value();
    EXPECT_TRUE(met.meets_target) << below;
    EXPECT_LT(met.psnr, remesh_psnr - below + 0.3) << below;
  }
}

TEST_F(CandidateSearchTest, SaysWhereTheRemeshIsTheLimit) {
  CandidateSearch search = Search({false, 0, remesh_psnr_ + 5});
  const MeasuredStream stream = search.Meet().value();
  EXPECT_FALSE(stream.meets_target);
  EXPECT_LT(stream.psnr, remesh_psnr_ + 5);
  EXPECT_GT(stream.psnr, remesh_psnr_ - 3);
  EXPECT_GE(stream.measurements, 1);
  EXPECT_LE(stream.measurements, 6);
}

TEST_F(CandidateSearchTest, SaysWhereTheBaseAloneIsOverTheBytes) {
  CandidateSearch search = Search({true, 100, 0});
  const MeasuredStream stream = search.Meet().value();
  EXPECT_FALSE(stream.meets_target);
  EXPECT_GT(stream.stream.size(), 100u);
  EXPECT_LT(stream.stream.size(), 400u);
}

}  // namespace
}  // namespace lacerta
