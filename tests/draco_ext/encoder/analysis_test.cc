#include "encoder/analysis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "draco_ext/encoder/tagged_meshes.h"
#include "shapes/base_meshes.h"
#include "shapes/open_loop_synthesis.h"

namespace lacerta {
namespace {

using ::testing::HasSubstr;

SemiRegularMesh BumpyMesh(const TriangleMesh& base, int num_levels) {
  return shapes::Subdivided(base, num_levels, shapes::Bumpy);
}

TEST(AnalyzeTest, SynthesisReturnsTheMeshToFloatAccuracy) {
  for (const TriangleMesh& base :
       {shapes::Pillow(), shapes::Tetrahedron(), shapes::Bipyramid(4), shapes::Bipyramid(17), shapes::Icosahedron(),
        shapes::Torus(4, 5), shapes::Grid(3), shapes::Fan(5), shapes::SingleTriangle()}) {
    const SemiRegularMesh mesh = BumpyMesh(base, 3);
    const StatusOr<std::vector<LevelCoefficients>> levels = Analyze(mesh);
    ASSERT_TRUE(levels.ok()) << levels.status().message();
    ASSERT_EQ(levels.value().size(), 3u);
    const std::vector<Vec3f> base_positions(mesh.positions.begin(), mesh.positions.begin() + mesh.num_base_vertices);
    const std::vector<Vec3f> back = shapes::Synthesize(shapes::TopologyOf(base), base_positions, levels.value());
    ASSERT_EQ(back.size(), mesh.positions.size());
    double detail = 0.0;
    for (const LevelCoefficients& level : levels.value()) {
      for (const Vec3f& d : level.detail) detail = std::max(detail, static_cast<double>(Norm(d)));
    }
    EXPECT_GT(detail, 1e-3);  // there was something to restore
    for (size_t v = 0; v < back.size(); ++v) EXPECT_LT(Norm(back[v] - mesh.positions[v]), 5e-6f) << v;
  }
}

TEST(AnalyzeTest, ButterflySurfaceHasNoDetails) {
  const SemiRegularMesh mesh = shapes::Subdivided(shapes::Icosahedron(), 3, [](const Vec3f& p) { return p; });
  const StatusOr<std::vector<LevelCoefficients>> levels = Analyze(mesh);
  ASSERT_TRUE(levels.ok());
  for (const LevelCoefficients& level : levels.value()) {
    for (const Vec3f& d : level.detail) EXPECT_LT(Norm(d), 1e-6f);
  }
}

TEST(AnalyzeTest, DetailIsExpressedInTheFrameOfItsEdge) {
  SemiRegularMesh mesh = shapes::Subdivided(shapes::Grid(4), 1, [](const Vec3f& p) { return p; });
  const Topology base = shapes::TopologyOf(shapes::Grid(4));
  const uint32_t e = base.face_edges[12][1];  // in the plane z = 0, away from the border
  const Vec3f along = Normalized(mesh.positions[base.edges[e][1]] - mesh.positions[base.edges[e][0]]);
  const Vec3f across = Cross(Vec3f{0, 0, 1}, along);
  mesh.positions[base.num_vertices + e] += along * 0.1f + across * 0.2f + Vec3f{0, 0, 0.3f};
  const StatusOr<std::vector<LevelCoefficients>> levels = Analyze(mesh);
  ASSERT_TRUE(levels.ok());
  const std::vector<Vec3f>& detail = levels.value()[0].detail;
  for (uint32_t i = 0; i < detail.size(); ++i) {
    const Vec3f expected = i == e ? Vec3f{0.1f, 0.2f, 0.3f} : Vec3f{};
    EXPECT_NEAR(Norm(detail[i] - expected), 0, 1e-6) << i;
  }
  // 16 cells of side 1: 40 sides and 16 diagonals.
  EXPECT_NEAR(levels.value()[0].mean_edge_length, (40 + 16 * std::sqrt(2.0)) / 56, 1e-6);
}

TEST(AnalyzeTest, DetailsShrinkOnASmoothSurface) {
  const StatusOr<std::vector<LevelCoefficients>> levels = Analyze(BumpyMesh(shapes::Icosahedron(), 5));
  ASSERT_TRUE(levels.ok());
  std::vector<double> rms;
  for (const LevelCoefficients& level : levels.value()) {
    double sum = 0.0;
    for (const Vec3f& d : level.detail) sum += SquaredNorm(d);
    rms.push_back(std::sqrt(sum / static_cast<double>(level.detail.size())));
  }
  for (size_t i = 2; i < rms.size(); ++i) EXPECT_LT(rms[i], rms[i - 1] / 3) << i;
}

TEST(AnalyzeTest, ZeroLevelsHaveNoDetails) {
  const TriangleMesh base = shapes::Tetrahedron();
  const StatusOr<std::vector<LevelCoefficients>> levels = Analyze({base.triangles, 4, 0, base.positions});
  ASSERT_TRUE(levels.ok());
  EXPECT_TRUE(levels.value().empty());
}

TEST(AnalyzeTest, RefusesWhatDoesNotFit) {
  const SemiRegularMesh good = BumpyMesh(shapes::Tetrahedron(), 2);
  const auto expect = [](const SemiRegularMesh& mesh, StatusCode code, const char* message) {
    const StatusOr<std::vector<LevelCoefficients>> levels = Analyze(mesh);
    ASSERT_FALSE(levels.ok());
    EXPECT_EQ(levels.status().code(), code);
    EXPECT_THAT(levels.status().message(), HasSubstr(message));
  };
  SemiRegularMesh mesh = good;
  mesh.positions.pop_back();
  expect(mesh, StatusCode::kInvalidArgument, "has 34 vertices, but 33 positions were given");
  mesh = good;
  mesh.num_levels = -1;
  expect(mesh, StatusCode::kInvalidArgument, "-1 levels");
  for (const int levels : {31, 32, 1000000000}) {
    mesh = good;
    mesh.num_levels = levels;
    expect(mesh, StatusCode::kInvalidArgument, "positions were given");
  }
  mesh = good;
  mesh.positions[7].y = std::numeric_limits<float>::quiet_NaN();
  expect(mesh, StatusCode::kInvalidArgument, "vertex 7 is not finite");
  mesh = good;
  mesh.base_triangles[0] = {0, 1, 9};
  expect(mesh, StatusCode::kInvalidData, "refers to vertex 9 of 4");
}

TEST(NormalDetailShareTest, CountsBothTolerances) {
  LevelCoefficients level;
  level.mean_edge_length = 1.0;
  level.detail = {{0, 0, 1},       {0.04f, 0, 1},   {0.03f, 0.03f, 1}, {0.06f, 0, -1},    // 3 normal, 1 not
                  {0.9e-4f, 0, 0}, {0, 1.2e-4f, 0}, {0, 0, 0},         {0.5f, 0, 0.1f}};  // 2 normal, 2 not
  EXPECT_DOUBLE_EQ(NormalDetailShare({level}), 5.0 / 8);
  EXPECT_DOUBLE_EQ(NormalDetailShare({level}, {0.0, 0.0}), 2.0 / 8);
  EXPECT_DOUBLE_EQ(NormalDetailShare({level}, {10.0, 1.0}), 1.0);
  EXPECT_DOUBLE_EQ(NormalDetailShare({}), 1.0);
}

TEST(AnalyzeTest, IsInvertedBySynthesisOnTaggedBases) {
  for (const testing::TaggedBase& tagged : testing::TaggedBases()) {
    const SemiRegularMesh mesh = testing::Bent(tagged, 3).mesh;
    const std::vector<LevelCoefficients> levels = Analyze(mesh).value();
    Topology t = BuildTopology(mesh.num_base_vertices, mesh.base_triangles, mesh.tags).value();
    std::vector<Vec3f> positions(mesh.positions.begin(), mesh.positions.begin() + mesh.num_base_vertices);
    float largest = 0;
    for (size_t i = 0; i < levels.size(); ++i, t = Refine(t)) {
      std::vector<LevelCoefficients> one = {levels[i]};
      positions = shapes::Synthesize(t, std::move(positions), one);
      for (uint32_t e = 0; e < t.num_edges(); ++e) {
        if (t.is_copy(e)) {
          EXPECT_EQ(levels[i].detail[e], Vec3f());
          positions[t.num_vertices + e] = positions[t.num_vertices + t.master[e]];
        }
        largest = std::max(largest, Norm(levels[i].detail[e]));
      }
    }
    ASSERT_EQ(positions.size(), mesh.positions.size());
    for (size_t v = 0; v < positions.size(); ++v) EXPECT_LT(Norm(positions[v] - mesh.positions[v]), 1e-4f);
    EXPECT_GT(largest, 0.01f);
  }
}

}  // namespace
}  // namespace lacerta
