// Subdivided input comes back vertex for vertex.
#include "draco/subdivided_input.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "encoder/step_law.h"
#include "shapes/base_meshes.h"
#include "shapes/real_meshes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

struct Input {
  std::string name;
  TriangleMesh mesh;
};

TriangleMesh Cloth() {
  TriangleMesh mesh = shapes::GridWithBorder(64, 48, 0.2f);
  for (Vec3f& p : mesh.positions) p.z += 0.02f * std::sin(20 * p.x + 3 * p.y) * std::cos(9 * p.y);
  return mesh;
}

TriangleMesh TwoComponents() {
  TriangleMesh mesh = shapes::BumpySphere(4, 0.1f);
  const TriangleMesh other = Cloth();
  const auto count = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& t : other.triangles) mesh.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  return mesh;
}

std::vector<Input> Inputs() {
  return {{"bumps", shapes::BumpySphere(4, 0.1f, 0.001f)}, {"cloth", Cloth()}, {"two components", TwoComponents()}};
}

TEST(SubdividedCandidateTest, KeepsVerticesWithinTheSteps) {
  for (const Input& input : Inputs()) {
    SCOPED_TRACE(input.name);
    const NormalMeshCandidate candidate = SubdividedCandidate(input.mesh, UndoSubdivision(input.mesh).value()).value();
    const SurfaceTarget target = MakeSurfaceTarget(candidate.normal_mesh());
    const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(input.mesh).value();
    double lowest = 200, highest = 0;
    for (const double psnr : {60.0, 70.0, 80.0, 90.0}) {
      const double distance = DistanceOfPsnr(psnr, meter.diagonal()), lambda = 1.2e-4 * distance * distance;
      const CodedStream stream = candidate.Code(lambda, EncodeMode::kDefault).value();
      double step = BaseStepForSlope(lambda, target.topologies[0].num_vertices);
      for (const LevelSteps& s : StepsForSlope(target, DetailScales(target), lambda)) step = std::max(step, double{s.tangential_step});
      const std::vector<Vec3f> expected = candidate.RemeshedSurface().positions;
      ASSERT_EQ(stream.decoded.positions.size(), input.mesh.positions.size());
      double miss = 0;
      for (size_t v = 0; v < expected.size(); ++v) miss = std::max(miss, double{Norm(stream.decoded.positions[v] - expected[v])});
      EXPECT_LE(miss, 1.5 * step);  // a step along both tangents, and half as much along the normal
      EXPECT_GT(miss, 0.01 * step);
      const double measured = Psnr(meter.Measure(stream.FinestMesh(), SurfaceDistanceOptions::RmsOnly()).value().Rms(), meter.diagonal());
      lowest = std::min(lowest, measured);
      highest = std::max(highest, measured);
    }
    EXPECT_LT(lowest, 75);
    EXPECT_GT(highest, 85);
  }
}

TEST(SubdividedCandidateTest, IsTheInputInAnotherOrder) {
  const TriangleMesh mesh = Cloth();
  const TriangleMesh same = SubdividedCandidate(mesh, UndoSubdivision(mesh).value()).value().RemeshedSurface();
  const auto corners = [](const TriangleMesh& m) {
    std::vector<std::array<std::array<float, 3>, 3>> all;
    for (const Triangle& t : m.triangles) {
      std::array<std::array<float, 3>, 3> c{};
      for (size_t k = 0; k < 3; ++k) c[k] = {m.positions[t[k]].x, m.positions[t[k]].y, m.positions[t[k]].z};
      std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
      all.push_back(c);
    }
    std::sort(all.begin(), all.end());
    return all;
  };
  EXPECT_EQ(corners(same), corners(mesh));
}

TEST(CodeSubdividedTest, MeetsTargets) {
  for (const Input& input : Inputs()) {
    SCOPED_TRACE(input.name);
    const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(input.mesh).value();
    for (const double psnr : {60.0, 80.0}) {
      const ChosenStream chosen =
          CodeSubdivided(input.mesh, UndoSubdivision(input.mesh).value(), meter, {false, 0, psnr}, EncodeMode::kDefault).value();
      EXPECT_TRUE(chosen.measured.meets_target);
      EXPECT_GE(chosen.measured.psnr, psnr);
      EXPECT_LT(chosen.measured.psnr, psnr + 1.5);
      EXPECT_GT(chosen.measured.stream.size(), 100u);
    }
  }
}

TEST(CodeSubdividedTest, RealSculpt) {
  const std::optional<TriangleMesh> mesh = lacerta::testing::RealMesh("genus3.ply");
  if (!mesh) GTEST_SKIP() << "no genus3.ply";
  const std::optional<Unsubdivided> split = UndoSubdivision(*mesh);
  ASSERT_TRUE(split.has_value());
  EXPECT_EQ(split->num_levels, 4);
  EXPECT_EQ(split->num_base_vertices, 22u);
  const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(*mesh).value();
  const ChosenStream chosen = CodeSubdivided(*mesh, *split, meter, {false, 0, 80}, EncodeMode::kDefault).value();
  EXPECT_TRUE(chosen.measured.meets_target);
  EXPECT_LT(chosen.measured.stream.size(), 1600u);
  EXPECT_GT(chosen.measured.stream.size(), 1000u);
}

}  // namespace
}  // namespace lacerta
