// Bases that are made finer where the normal mesh over them is reversed, and borders that share their ends.
#include "draco/normal_mesh_candidate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "common/base_tags.h"
#include "draco_ext/draco/candidates.h"
#include "draco_ext/remesh/remeshing.h"
#include "encoder/step_law.h"
#include "lacerta/clean.h"
#include "lacerta/surface_distance.h"
#include "remesh/reversal.h"
#include "remesh/surface_parts.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

struct Made {
  uint32_t num_base_vertices;
  double reversed;
};

Made Create(const TriangleMesh& input, uint32_t num_base_vertices) {
  const CollapseHistory history = testing::Decimated(input, {8, 12, 0.2});
  const InputSurface surface(input, testing::TopologyOf(input));
  const NormalMeshCandidate candidate = testing::MakeCandidate({surface, history, {}}, num_base_vertices, 3);
  return {candidate.num_base_vertices(), FindReversed(surface, candidate.normal_mesh()).share};
}

TEST(NormalMeshCandidate, HasTheBaseThatIsAskedForOnASmoothSurface) {
  for (const uint32_t size : {40u, 100u}) {
    const Made made = Create(shapes::BumpySphere(4, 0.1f), size);
    EXPECT_EQ(made.num_base_vertices, size);
    EXPECT_LE(made.reversed, kMostReversed);
  }
}

TEST(NormalMeshCandidate, SplitsBaseFacesThatFoldOverWhatTheyStandFor) {
  struct Case {
    TriangleMesh input;
    uint32_t asked;
  };
  for (const auto& [input, asked] : {Case{shapes::SpikySphere(4, 12, 1.0f), 16}, Case{shapes::TwoHoledPlate(8), 16}, Case{shapes::BumpySphere(4, 0.4f, 0.03f), 10}}) {
    const Made made = Create(input, asked);
    EXPECT_LT(made.reversed, 5e-4);
    EXPECT_GT(made.num_base_vertices, asked) << "nothing was reversed";
    EXPECT_LE(made.num_base_vertices, asked + 8);
  }
}

TEST(NormalMeshCandidate, WithMoreLevelsGoesOnFromTheOneWithFewer) {
  for (const TriangleMesh& input : {shapes::BumpySphere(4, 0.1f), shapes::SpikySphere(4, 12, 1.0f)}) {
    const CollapseHistory history = testing::Decimated(input, {8, 12, 0.2});
    const InputSurface surface(input, testing::TopologyOf(input));
    const TriangleMesh still;
    const RefinableSurface refinable{surface, history, still};
    std::unique_ptr<PiercedBase> pierced = PierceUnreversed(refinable, 16, 2).value();
    const uint32_t num_vertices_before = pierced->num_vertices();
    const bool is_held = !pierced->held().empty();
    pierced = PierceUnreversed(refinable, 16, 3, BaseCoding::kStock, std::move(pierced)).value();
    EXPECT_GE(pierced->num_vertices(), num_vertices_before);
    EXPECT_LE(pierced->num_vertices(), 16u + 8);
    const NormalMeshCandidate more = testing::FittedCandidate(*pierced, surface);
    const NormalMeshCandidate anew = testing::MakeCandidate(refinable, 16, 3);
    EXPECT_EQ(more.num_levels(), 3);
    EXPECT_LT(FindReversed(surface, more.normal_mesh()).share, 1e-3);
    EXPECT_TRUE(is_held || more.RemeshedSurface().positions == anew.RemeshedSurface().positions);
  }
}

TEST(NormalMeshCandidate, ADescentGoesOnFromAStreamToACoarserOne) {
  const TriangleMesh input = shapes::BumpySphere(5, 0.1f, 0.003f);
  const CollapseHistory history = testing::Decimated(input);
  const InputSurface surface(input, testing::TopologyOf(input));
  const NormalMeshCandidate candidate = testing::MakeCandidate({surface, history, {}}, 60, 3);
  for (const double lambda : {1e-10, 1e-9, 1e-8}) {
    SCOPED_TRACE(lambda);
    const auto code = [&](double slope, int passes, const CodedSurface* from) {
      return candidate.Code({slope, slope, slope, candidate.LastDetailed(slope), passes, 1}, EncodeMode::kDefault, from).value();
    };
    const auto cost = [&](const CodedStream& s) { return s.plane_distortion + lambda * 8 * static_cast<double>(s.size()); };
    const CodedStream first = code(lambda, 5, nullptr);
    const CodedStream same = code(lambda, 2, &first.coded), coarser = code(1.1 * lambda, 2, &first.coded);
    EXPECT_LT(cost(same), 1.001 * cost(first));
    EXPECT_GT(cost(same), 0.97 * cost(first)) << "there was little left to gain";
    EXPECT_LT(coarser.size(), first.size());
    EXPECT_GT(coarser.size(), 0.93 * static_cast<double>(first.size()));
    EXPECT_LT(cost(coarser), 1.005 * cost(first)) << "off the curve";
    EXPECT_EQ(coarser.coded.base.step, first.coded.base.step);
  }
}

// Two sheets `gap` apart that bend away from each other: at no gap they touch at two points, with a hole like an eye between.
TriangleMesh Eye(float gap) {
  const TriangleMesh grid = shapes::GridWithBorder(20, 20);
  TriangleMesh eye;
  for (const float side : {1.0f, -1.0f}) {
    const auto first = static_cast<uint32_t>(eye.positions.size());
    for (const Vec3f& p : grid.positions) {
      const float lid = 0.25f * std::sin(3.14159265f * p.x) * (p.x > 0 && p.x < 1);
      eye.positions.push_back({p.x, side * (p.y + lid * (1 - p.y) + gap / 2), 0.2f * p.y * p.y});
    }
    for (Triangle t : grid.triangles) {
      if (side < 0) std::swap(t[1], t[2]);
      eye.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  return Clean(eye).value().mesh;
}

// Both lids run between the same two points, but are not one curve, also not where a base has a single edge for each.
TEST(NormalMeshCandidate, BordersThatShareOnlyTheirEndsAreNotJoined) {
  double psnr[2] = {};
  for (const bool touches : {false, true}) {
    const TriangleMesh mesh = Eye(touches ? 0.0f : 0.01f);
    const SurfaceParts parts = SplitSurface(mesh);
    EXPECT_EQ(parts.report.split_vertices, touches ? 2u : 0u);
    const CollapseHistory history = Decimate(parts.refined, parts.topology, {8, 12, 0.2});
    const InputSurface surface(parts.refined, parts.topology);
    const NormalMeshCandidate candidate = testing::MakeCandidate({surface, history, {}}, 8, 4);
    EXPECT_LE(candidate.num_base_vertices(), 12u);
    const SemiRegularMesh& base = candidate.normal_mesh().mesh;
    const Topology topology = BuildTopology(base.num_base_vertices, base.base_triangles, base.tags).value();
    EXPECT_EQ(base.tags.joined.empty(), !touches);
    for (uint32_t e = 0; e < topology.num_edges(); ++e) EXPECT_FALSE(topology.is_copy(e)) << "edge " << e;
    const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(mesh).value();
    constexpr double kLambda = 1e-10;  // of a stream near 83 dB
    const CodedStream coded = candidate.Code(kLambda, EncodeMode::kDefault).value();
    psnr[touches] = Psnr(meter.Measure(coded.FinestMesh()).value().Rms(), meter.diagonal());
  }
  EXPECT_NEAR(psnr[1], psnr[0], 3.0);
  EXPECT_NEAR(psnr[0], 83.0, 5.0);
}

// Decoders join what lies at one point of the lattice. A coarse one puts vertices together that have nothing to do with each other, which
// does no harm, and would close the eye, which does: then it is finer than the slope asks for.
TEST(NormalMeshCandidate, TheLatticeJoinsTheCutsAndNoOtherBorders) {
  const TriangleMesh mesh = Eye(0);
  const SurfaceParts parts = SplitSurface(mesh);
  const CollapseHistory history = Decimate(parts.refined, parts.topology, {8, 12, 0.2});
  const InputSurface surface(parts.refined, parts.topology);
  const NormalMeshCandidate candidate = testing::MakeCandidate({surface, history, {}}, 40, 2);
  const SemiRegularMesh& remesh = candidate.normal_mesh().mesh;
  ASSERT_FALSE(remesh.tags.joined.empty());
  const Topology wanted = BuildTopology(remesh.num_base_vertices, remesh.base_triangles, remesh.tags).value();
  int sharing = 0, finer = 0;
  for (double lambda = 1e-10; lambda < 1e-4; lambda *= 4) {
    SCOPED_TRACE(lambda);
    const CodedStream stream = candidate.Code(lambda, EncodeMode::kDefault).value();
    BaseTags tags = remesh.tags;
    tags.joined = FirstAtSamePoint(stream.coded.base.lattice);
    sharing += tags.joined != remesh.tags.joined;
    Topology decoded = wanted;
    ASSERT_TRUE(SetTags(tags, &decoded).ok());
    EXPECT_EQ(decoded.edges, wanted.edges);
    EXPECT_EQ(decoded.master, wanted.master);
    finer += static_cast<double>(stream.coded.base.step) < 0.6 * BaseStepForSlope(lambda, remesh.num_base_vertices);
  }
  EXPECT_GT(sharing, 0);
  EXPECT_GT(finer, 0);
}

}  // namespace
}  // namespace lacerta
