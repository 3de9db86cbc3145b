#include "encoder/coefficient_descent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "draco_ext/encoder/coded_surfaces.h"
#include "draco_ext/encoder/tagged_meshes.h"
#include "draco_ext/remesh/remeshing.h"
#include "encoder/quantizer.h"
#include "encoder/step_law.h"

namespace lacerta {
namespace {

using lacerta::testing::BitsOf;
using lacerta::testing::ClosedRealMeshes;
using lacerta::testing::ExpectDecodesAsSynthesized;
using lacerta::testing::Remesh;

SurfaceTarget Bumps() { return MakeSurfaceTarget(Remesh(shapes::BumpySphere(4, 0.1f, 0.003f), 60, 3)); }

CodedSurface ClosedLoopAt(const SurfaceTarget& target, double lambda) {
  const std::vector<Vec3f> base(target.points.begin(), target.points.begin() + target.topologies[0].num_vertices);
  const BaseMesh lattice = RoundToLattice({base, target.topologies[0].triangles}, static_cast<float>(BaseStepForSlope(lambda, target.topologies[0].num_vertices)));
  return QuantizeClosedLoop(target, lattice, StepsForSlope(target, DetailScales(target), lambda));
}

CodedSurface DescendAt(const SurfaceTarget& target, double lambda) {
  return Descend(target, ClosedLoopAt(target, lambda), {lambda, 2, true});
}

double Distortion(const SurfaceTarget& target, const CodedSurface& coded) { return PlaneDistortion(target, Synthesize(target, coded)); }

TEST(PlaneDistortion, CountsOnlyWhatLeavesThePlane) {
  const SurfaceTarget target = Bumps();
  EXPECT_EQ(PlaneDistortion(target, target.points), 0);
  std::vector<Vec3f> off = target.points, along = target.points;
  for (size_t v = 0; v < off.size(); ++v) {
    off[v] += target.normals[v] * 0.01f;
    along[v] += Normalized(Cross(target.normals[v], {1, 2, 3})) * 0.01f;
  }
  EXPECT_NEAR(PlaneDistortion(target, off), 1e-4, 1e-8);
  EXPECT_LT(PlaneDistortion(target, along), 1e-12);
}

TEST(QuantizeClosedLoop, ErrorsDoNotAddUpOverLevels) {
  const SurfaceTarget target = Bumps();
  const std::vector<Vec3f> base(target.points.begin(), target.points.begin() + 60);
  for (const float step : {1e-3f, 1e-2f}) {
    const float rounded = RoundStep(step);
    const std::vector<LevelSteps> steps(3, LevelSteps{rounded, rounded, 0, 0});
    const CodedSurface coded = QuantizeClosedLoop(target, RoundToLattice({base, target.topologies[0].triangles}, step), steps);
    ExpectDecodesAsSynthesized(target, coded);
    const double rms = std::sqrt(Distortion(target, coded));
    EXPECT_LT(rms, 0.5 * step) << "uniform error: 0.29 steps";
    EXPECT_GT(rms, 0.1 * step);
  }
}

TEST(QuantizeClosedLoop, PiercedVerticesHaveNoTangentialPart) {
  const SurfaceTarget target = Bumps();
  const CodedSurface coded = ClosedLoopAt(target, 1e-10);
  size_t tangential = 0, normal = 0;
  for (const QuantizedLevel& level : coded.levels) {
    tangential += level.tangential.size() - std::count(level.tangential.begin(), level.tangential.end(), 0);
    normal += level.normal.size() - std::count(level.normal.begin(), level.normal.end(), 0);
  }
  EXPECT_GT(normal, 500u);
  EXPECT_LT(tangential, normal / 10);
}

TEST(Descend, TinyStepsReachTheSurface) {
  const SurfaceTarget target = Bumps();
  const CodedSurface coded = DescendAt(target, 1e-16);  // steps of about 1e-6
  EXPECT_LT(std::sqrt(Distortion(target, coded)), 1e-6);
  ExpectDecodesAsSynthesized(target, coded);
}

TEST(Descend, LowersDistortionAndRateTogether) {
  const SurfaceTarget target = Bumps();
  for (const double lambda : {1e-13, 1e-11, 1e-10, 1e-9, 1e-8, 1e-6}) {
    SCOPED_TRACE(lambda);
    const CodedSurface before = ClosedLoopAt(target, lambda);
    const CodedSurface after = Descend(target, before, {lambda, 2, true});
    const double cost_before = Distortion(target, before) + lambda * BitsOf(before);
    const double cost_after = Distortion(target, after) + lambda * BitsOf(after);
    EXPECT_LT(cost_after, 1.01 * cost_before);
    EXPECT_GT(cost_after, 0.05 * cost_before);
  }
}

TEST(Descend, BitsFallAndDistortionGrowsWithTheSlope) {
  const SurfaceTarget target = Bumps();
  double last_bits = 1e18, last_distortion = 0;
  for (const double lambda : {1e-14, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7}) {
    SCOPED_TRACE(lambda);
    const CodedSurface coded = DescendAt(target, lambda);
    ExpectDecodesAsSynthesized(target, coded);
    const double bits = BitsOf(coded), distortion = Distortion(target, coded);
    EXPECT_LT(bits, last_bits);
    EXPECT_GT(distortion, last_distortion);
    last_bits = bits;
    last_distortion = distortion;
  }
}

TEST(Descend, DropsSetsThatDoNothing) {
  const SurfaceTarget target = Bumps();
  const CodedSurface coded = DescendAt(target, 1e-6);
  const LevelSteps& finest = coded.steps.back();
  EXPECT_EQ(finest.normal_step, 0);
  EXPECT_EQ(finest.tangential_step, 0);
  for (const int32_t q : coded.levels.back().normal) EXPECT_EQ(q, 0);
  const CodedSurface fine = DescendAt(target, 1e-13);
  EXPECT_GT(fine.steps.back().normal_step, 0);
}

TEST(Descend, PositionsAreThoseThatDecodersGet) {
  const SurfaceTarget target = Bumps();
  for (const double lambda : {1e-12, 1e-9, 1e-7}) {
    const std::vector<Vec3f> base(target.points.begin(), target.points.begin() + target.topologies[0].num_vertices);
    const BaseMesh lattice = RoundToLattice({base, target.topologies[0].triangles}, static_cast<float>(BaseStepForSlope(lambda, target.topologies[0].num_vertices)));
    std::vector<Vec3f> positions;
    CodedSurface coded = QuantizeClosedLoop(target, lattice, StepsForSlope(target, DetailScales(target), lambda), &positions);
    EXPECT_EQ(positions, Synthesize(target, coded));
    const CodedSurface expected = Descend(target, coded, {lambda, 2, true});
    coded = Descend(target, coded, {lambda, 2, true}, &positions);
    EXPECT_EQ(positions, Synthesize(target, coded));
    EXPECT_EQ(coded.base.lattice, expected.base.lattice);
    for (size_t i = 0; i < coded.levels.size(); ++i) EXPECT_EQ(coded.levels[i].normal, expected.levels[i].normal);
  }
}

TEST(Descend, MovesTheBaseUnlessToldNotTo) {
  const SurfaceTarget target = Bumps();
  CodedSurface before = ClosedLoopAt(target, 1e-8);
  for (auto& point : before.base.lattice) point[0] += 4;
  const CodedSurface still = Descend(target, before, {1e-8, 2, false}), moved = Descend(target, before, {1e-8, 2, true});
  EXPECT_EQ(still.base.lattice, before.base.lattice);
  EXPECT_NE(moved.base.lattice, before.base.lattice);
  for (size_t v = 0; v < before.base.lattice.size(); ++v) {
    for (size_t c = 0; c < 3; ++c) EXPECT_LE(std::abs(moved.base.lattice[v][c] - before.base.lattice[v][c]), 2) << "one step per pass";
  }
  EXPECT_LT(Distortion(target, moved), 0.9 * Distortion(target, still));
}

// Coarse steps on hard surfaces: descent along tangent planes must not send a vertex away.
TEST(Descend, NoVertexFliesAway) {
  auto inputs = ClosedRealMeshes({{"dragon_50k.ply", 1}, {"fertility.ply", 4}, {"fandisk.ply", 0}});
  inputs.push_back({"spikes", shapes::SpikySphere(4)});
  inputs.push_back({"thin plate", shapes::ThinPlate(12)});
  for (const shapes::NamedShape& input : inputs) {
    const SurfaceTarget target = MakeSurfaceTarget(Remesh(input.mesh, 200, 3));
    const Topology& base = target.topologies[0];
    double sum = 0;
    for (const auto& [a, b] : base.edges) sum += Norm(target.points[a] - target.points[b]);
    const double edge = sum / base.num_edges(), diagonal = BoundingBoxDiagonal(input.mesh);
    for (const double share : {1e-3, 1e-5, 1e-7, 1e-9, 1e-12}) {
      SCOPED_TRACE(input.name + ", lambda of " + std::to_string(std::log10(share)));
      const CodedSurface coded = DescendAt(target, share * diagonal * diagonal);
      ExpectDecodesAsSynthesized(target, coded);
      const std::vector<Vec3f> positions = Synthesize(target, coded);
      double farthest = 0;
      for (size_t v = 0; v < positions.size(); ++v) farthest = std::max(farthest, double{Norm(positions[v] - target.points[v])});
      EXPECT_LT(farthest, 3 * edge + 2.0 * coded.base.step);
    }
  }
}

TEST(Descend, TaggedBasesDecodeAsSynthesized) {
  for (const lacerta::testing::TaggedBase& tagged : lacerta::testing::TaggedBases()) {
    const NormalMesh mesh = lacerta::testing::Bent(tagged, 3);
    const SurfaceTarget target = MakeSurfaceTarget(mesh);
    constexpr double kLambda = 1e-8;
    CodedSurface start = ClosedLoopAt(target, kLambda);
    start.base.triangles = tagged.base.triangles;
    if (!tagged.tags.joined.empty()) {
      for (const size_t v : {1, 5, 9}) start.base.lattice[v][2] += 3;  // off, together
    }
    ExpectDecodesAsSynthesized(target, start, tagged.tags);
    const CodedSurface after = Descend(target, start, {kLambda, 2, true});
    ExpectDecodesAsSynthesized(target, after, tagged.tags);
    const auto cost = [&](const CodedSurface& coded) {
      return Distortion(target, coded) + kLambda * 8 * static_cast<double>(lacerta::testing::RefinementOf(coded, tagged.tags).size());
    };
    EXPECT_LT(cost(after), cost(start));
    EXPECT_LT(std::sqrt(Distortion(target, after)), 0.01);
    if (!tagged.tags.joined.empty()) {
      EXPECT_EQ(FirstAtSamePoint(after.base.lattice), tagged.tags.joined);
      EXPECT_LT(after.base.lattice[9][2], start.base.lattice[9][2]);  // back, together
    }
  }
}

}  // namespace
}  // namespace lacerta
