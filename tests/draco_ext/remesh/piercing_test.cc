#include "remesh/piercing.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "common/butterfly.h"
#include "common/local_frame.h"
#include "common/subdivision.h"
#include "draco_ext/remesh/remeshing.h"
#include "remesh/base_parts.h"
#include "lacerta/decoder.h"

namespace lacerta {
namespace {

using lacerta::testing::BasePositions;
using lacerta::testing::ClosedRealMeshes;
using lacerta::testing::ClosedShapes;
using lacerta::testing::DoublePyramid;
using lacerta::testing::Moved;
using lacerta::testing::RealMesh;
using lacerta::testing::Remesh;
using lacerta::testing::Scaled;
using lacerta::testing::TimeOf;

TriangleMesh Finest(const NormalMesh& mesh) {
  StatusOr<TriangleMesh> finest = MeshAtLevel(mesh.mesh, mesh.mesh.num_levels);
  EXPECT_TRUE(finest.ok()) << finest.status().message();
  return finest.ok() ? std::move(finest).value() : TriangleMesh();
}

double PsnrOf(const TriangleMesh& input, const NormalMesh& mesh) {
  SurfaceDistanceOptions options;
  options.num_samples = 50'000;
  options.max_at_vertices = false;
  const StatusOr<SurfaceDistance> distance = MeasureSurfaceDistance(input, Finest(mesh), options);
  EXPECT_TRUE(distance.ok()) << distance.status().message();
  return distance.ok() ? Psnr(distance.value().Rms(), BoundingBoxDiagonal(input)) : 0;
}

// What holds of every normal mesh, however hard the input.
void ExpectSound(const TriangleMesh& input, const NormalMesh& mesh) {
  const size_t num_vertices = mesh.mesh.positions.size();
  ASSERT_EQ(mesh.surface_normals.size(), num_vertices);
  ASSERT_EQ(mesh.piercing.size(), num_vertices - mesh.mesh.num_base_vertices);
  ASSERT_EQ(Finest(mesh).positions.size(), num_vertices) << "the subdivision's count";
  const TriangleTree tree(input);
  const double diagonal = BoundingBoxDiagonal(input);
  double farthest = 0;
  for (size_t v = 0; v < num_vertices; ++v) {
    const Vec3f& n = mesh.surface_normals[v];
    EXPECT_TRUE(n == Vec3f{} || std::fabs(Norm(n) - 1) < 1e-5) << v;
    if (v < mesh.mesh.num_base_vertices) continue;  // these may be off the surface
    const ClosestPointResult closest = tree.ClosestPoint(mesh.mesh.positions[v]);
    ASSERT_NE(closest.point.face, kNone) << v;
    farthest = std::max(farthest, std::sqrt(double{closest.squared_distance}));
  }
  EXPECT_LT(farthest, 1e-5 * diagonal) << "vertices lie on the input";
}

// Triangles of the finest level that look away from the mean normal of the input at their corners. Only the last resort, the
// parametric point, may leave such a one behind.
size_t NumTurnedOver(const NormalMesh& mesh) {
  const TriangleMesh fine = Finest(mesh);
  size_t count = 0;
  for (const Triangle& t : fine.triangles) {
    const Vec3f &a = fine.positions[t[0]], &b = fine.positions[t[1]], &c = fine.positions[t[2]];
    const Vec3f normal = mesh.surface_normals[t[0]] + mesh.surface_normals[t[1]] + mesh.surface_normals[t[2]];
    if (Dot(Cross(b - a, c - a), normal) > 0) continue;
    ++count;
    EXPECT_TRUE(std::any_of(t.begin(), t.end(), [&](uint32_t v) {
      return v >= mesh.mesh.num_base_vertices && mesh.piercing[v - mesh.mesh.num_base_vertices] == PiercingKind::kParametric;
    }));
  }
  return count;
}

struct SmoothCase {
  const char* name;
  TriangleMesh mesh;
  uint32_t base;
  int levels;
  double min_psnr, max_psnr;
  double min_normal_share;
};

TEST(Pierce, SmoothShapesLieOnNormalLinesAndKeepTheirSurface) {
  const SmoothCase cases[] = {{"sphere", shapes::Icosphere(5), 50, 4, 80, 110, 0.97},
                              {"torus", shapes::Torus(96, 48), 100, 4, 75, 110, 0.97},
                              {"bumps", shapes::BumpySphere(5), 150, 4, 70, 110, 0.95}};
  for (const SmoothCase& c : cases) {
    SCOPED_TRACE(c.name);
    const NormalMesh mesh = Remesh(c.mesh, c.base, c.levels);
    ASSERT_EQ(mesh.mesh.num_base_vertices, c.base);
    ExpectSound(c.mesh, mesh);
    const double psnr = PsnrOf(c.mesh, mesh);
    EXPECT_GT(psnr, c.min_psnr);
    EXPECT_LT(psnr, c.max_psnr) << "too good to be true";
    EXPECT_GT(NormalShare(mesh), c.min_normal_share);
    EXPECT_LE(static_cast<double>(NumTurnedOver(mesh)), 1e-4 * static_cast<double>(Finest(mesh).triangles.size()));
  }
}

TEST(Pierce, SpheresHaveNoTriangleTurnedOver) {
  const TriangleMesh input = shapes::Icosphere(4);
  for (const uint32_t base : {12u, 30u, 100u, 300u}) {
    const NormalMesh mesh = Remesh(input, base, 3);
    EXPECT_EQ(NumTurnedOver(mesh), 0u) << base;
    EXPECT_GT(NormalShare(mesh), 0.97) << base;
  }
}

// A base too coarse for its spikes: no fallback alone keeps all triangles facing out.
TEST(Pierce, TurnsBackWhatTheLastResortLeaves) {
  const TriangleMesh input = shapes::SpikySphere(5, 40, 0.8f);
  const CollapseHistory history = testing::Decimated(input, {60, 12, 0.2});
  const InputSurface surface(input, testing::TopologyOf(input));
  const BaseDomain domain(history, history.num_collapses());
  const auto num_turned = [&](int rounds) {
    PiercingOptions options;
    options.num_levels = 4;
    options.turning_rounds = rounds;
    const NormalMesh mesh = Pierce(surface, domain, BasePositions(domain, input), options);
    ExpectSound(input, mesh);
    return NumTurnedOver(mesh);
  };
  const size_t before = num_turned(0), after = num_turned(4);
  EXPECT_GT(before, 100u);
  EXPECT_LT(after, before / 3);
}

TEST(Pierce, MoreLevelsAreCloser) {
  const TriangleMesh input = shapes::BumpySphere(5);
  double last = 0;
  for (int levels = 1; levels <= 4; ++levels) {
    const double psnr = PsnrOf(input, Remesh(input, 100, levels));
    EXPECT_GT(psnr, last + 3);
    last = psnr;
  }
}

TEST(Pierce, CoarserLevelsArePrefixes) {
  const TriangleMesh input = shapes::BumpySphere(4);
  const NormalMesh fine = Remesh(input, 60, 4);
  for (int levels = 0; levels < 4; ++levels) {
    const NormalMesh coarse = Remesh(input, 60, levels);
    EXPECT_EQ(coarse.mesh.num_levels, levels);
    ASSERT_LT(coarse.mesh.positions.size(), fine.mesh.positions.size());
    EXPECT_TRUE(std::equal(coarse.mesh.positions.begin(), coarse.mesh.positions.end(), fine.mesh.positions.begin()));
    EXPECT_TRUE(std::equal(coarse.surface_normals.begin(), coarse.surface_normals.end(), fine.surface_normals.begin()));
    EXPECT_TRUE(std::equal(coarse.piercing.begin(), coarse.piercing.end(), fine.piercing.begin()));
  }
}

TEST(Pierce, NormalVerticesLieOnTheirNormalLine) {
  const TriangleMesh input = shapes::BumpySphere(4);
  const NormalMesh mesh = Remesh(input, 60, 2);
  std::vector<Topology> topologies = {BuildTopology(60, mesh.mesh.base_triangles).value()};
  topologies.push_back(Refine(topologies[0]));
  const StencilTable stencils(topologies[0]);
  for (const Topology& coarse : topologies) {
    const std::vector<Vec3f> positions(mesh.mesh.positions.begin(), mesh.mesh.positions.begin() + coarse.num_vertices);
    const std::vector<Vec3f> predicted = PredictMidpoints(coarse, stencils, positions);
    const std::vector<LocalFrame> frames = ComputeLocalFrames(coarse, positions, predicted);
    for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
      const Vec3f offset = mesh.mesh.positions[coarse.num_vertices + e] - predicted[e];
      const float off_line = Norm(offset - frames[e].normal * Dot(offset, frames[e].normal));
      const PiercingKind kind = mesh.piercing[coarse.num_vertices - 60 + e];
      EXPECT_TRUE(kind != PiercingKind::kNormal || off_line < 1e-6f) << off_line;
    }
  }
}

TEST(Pierce, DoesNotDependOnTheNumberOfThreads) {
  const TriangleMesh input = shapes::BumpySphere(4, 0.2f, 0.01f);
  std::vector<NormalMesh> meshes;
  for (const size_t threads : {1, 2, 4}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    meshes.push_back(Remesh(input, 80, 4));
  }
  for (size_t i = 1; i < meshes.size(); ++i) {
    ASSERT_EQ(meshes[i].mesh.positions.size(), meshes[0].mesh.positions.size());
    EXPECT_EQ(std::memcmp(meshes[i].mesh.positions.data(), meshes[0].mesh.positions.data(),
                          meshes[0].mesh.positions.size() * sizeof(Vec3f)),
              0);
    EXPECT_EQ(meshes[i].piercing, meshes[0].piercing);
  }
}

TEST(Pierce, TheBaseNeedNotLieOnTheInput) {
  const TriangleMesh input = shapes::BumpySphere(4);
  const CollapseHistory history = testing::Decimated(input, {80, 12, 0.2});
  const InputSurface surface(input, testing::TopologyOf(input));
  const BaseDomain domain(history, history.num_collapses());
  for (const float step : {0.01f, 0.05f}) {
    std::vector<Vec3f> base = BasePositions(domain, input);
    for (Vec3f& p : base) {
      for (int c = 0; c < 3; ++c) p[c] = std::nearbyint(p[c] / step) * step;
    }
    const NormalMesh mesh = Pierce(surface, domain, base, PiercingOptions());
    ExpectSound(input, mesh);
    EXPECT_TRUE(std::equal(base.begin(), base.end(), mesh.mesh.positions.begin())) << "as the decoder will have it";
    EXPECT_GT(NormalShare(mesh), 0.95);
    EXPECT_GT(PsnrOf(input, mesh), 45);
  }
}

TEST(Pierce, DoesNotDependOnScale) {
  const TriangleMesh input = shapes::BumpySphere(3);
  const NormalMesh expected = Remesh(input, 40, 3);
  for (const int exponent : {-20, 20}) {  // about 1e-6 and 1e6
    const NormalMesh mesh = Remesh(Scaled(input, std::ldexp(1.0f, exponent)), 40, 3);
    ASSERT_EQ(mesh.mesh.positions.size(), expected.mesh.positions.size());
    for (size_t v = 0; v < mesh.mesh.positions.size(); ++v) {
      EXPECT_LT(Norm(mesh.mesh.positions[v] * std::ldexp(1.0f, -exponent) - expected.mesh.positions[v]), 1e-5f);
    }
  }
}

// As many bases as there is time for, on every shape and with every tolerance: no vertex may leave the charts in which the
// next level looks for it.
TEST(Pierce, EveryBaseOfEveryShapeIsSound) {
  std::mt19937 random(11);
  std::vector<shapes::NamedShape> inputs = ClosedShapes();
  for (shapes::NamedShape& mesh : ClosedRealMeshes({{"fertility.ply", 4}, {"fandisk.ply", 0}})) inputs.push_back(std::move(mesh));
  for (const shapes::NamedShape& input : inputs) {
    const CollapseHistory history = testing::Decimated(input.mesh, {4, 12, 0.2});
    const InputSurface surface(input.mesh, testing::TopologyOf(input.mesh));
    for (int i = 0; i < 6; ++i) {
      const double share = i == 0 ? 1.0 : i == 1 ? 0.0 : 1 - std::pow(std::uniform_real_distribution<double>(0, 1)(random), 3);
      const BaseDomain domain(history, static_cast<uint32_t>(share * history.num_collapses()));
      SCOPED_TRACE(input.name + ", base of " + std::to_string(domain.num_vertices()));
      PiercingOptions options;
      options.num_levels = domain.num_vertices() > 1000 ? 1 : domain.num_vertices() > 200 ? 2 : 4;
      if (i % 2 == 1) {
        options.max_parameter_distance = 5;
        options.min_normal_cosine = -1;
        options.max_distance = 5;
      }
      ExpectSound(input.mesh, Pierce(surface, domain, BasePositions(domain, input.mesh), options));
    }
  }
}

TEST(Pierce, RealMeshes) {
  const auto meshes = ClosedRealMeshes({{"dragon_50k.ply", 1}, {"armadillo.ply", 0}, {"human_skull.ply", 2}});
  if (meshes.empty()) GTEST_SKIP() << "no real mesh in " LACERTA_TEST_DATA_DIR;
  for (const shapes::NamedShape& input : meshes) {
    const CollapseHistory history = testing::Decimated(input.mesh, {100, 12, 0.2});
    const InputSurface surface(input.mesh, testing::TopologyOf(input.mesh));
    for (const uint32_t size : {100u, 900u}) {
      SCOPED_TRACE(input.name + ", base of " + std::to_string(size));
      const BaseDomain domain(history, TimeOf(history, input.mesh, size));
      PiercingOptions options;
      options.num_levels = size == 100 ? 4 : 3;
      const NormalMesh mesh = Pierce(surface, domain, BasePositions(domain, input.mesh), options);
      ExpectSound(input.mesh, mesh);
      EXPECT_GT(NormalShare(mesh), size == 100 ? 0.87 : 0.94);
      EXPECT_LT(NormalShare(mesh), 1.0);
      const double psnr = PsnrOf(input.mesh, mesh);
      EXPECT_GT(psnr, size == 100 ? 60 : 70);
      EXPECT_LT(psnr, size == 100 ? 80 : 100);
    }
  }
}

TEST(Pierce, SurvivesDegenerateInput) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> tiny(-1e-7f, 1e-7f);
  std::vector<TriangleMesh> inputs;
  inputs.push_back(shapes::Icosphere(3));  // triangles without area
  for (const Triangle& t : inputs.back().triangles) {
    if (random() % 5 == 0) inputs.back().positions[t[0]] = (inputs.back().positions[t[1]] + inputs.back().positions[t[2]]) * 0.5f;
  }
  inputs.push_back(shapes::Icosphere(3));  // vertices on top of each other
  for (const Triangle& t : inputs.back().triangles) {
    if (random() % 5 == 0) inputs.back().positions[t[0]] = inputs.back().positions[t[1]];
  }
  inputs.push_back(shapes::Icosphere(3));  // slivers
  for (const Triangle& t : inputs.back().triangles) {
    if (random() % 5 != 0) continue;
    inputs.back().positions[t[0]] = inputs.back().positions[t[1]] + Vec3f{tiny(random), tiny(random), tiny(random)};
  }
  inputs.push_back(shapes::Icosphere(3));  // two vertices far apart on the surface at the same place
  inputs.back().positions[100] = inputs.back().positions[500];
  inputs.push_back(shapes::Icosphere(3));  // all in one plane
  for (Vec3f& p : inputs.back().positions) p.z = 0;
  inputs.push_back(DoublePyramid(3000));
  inputs.push_back(shapes::ThinPlate(8, 0.0f));
  for (size_t i = 0; i < inputs.size(); ++i) {
    const CollapseHistory history = testing::Decimated(inputs[i], {4, 12, 0.2});
    const InputSurface surface(inputs[i], testing::TopologyOf(inputs[i]));
    for (const uint32_t size : {4u, 50u, 300u}) {
      SCOPED_TRACE("input " + std::to_string(i) + ", base of " + std::to_string(size));
      const BaseDomain domain(history, TimeOf(history, inputs[i], size));
      PiercingOptions options;
      options.num_levels = 3;
      ExpectSound(inputs[i], Pierce(surface, domain, BasePositions(domain, inputs[i]), options));
    }
  }
}

TEST(Pierce, SeveralComponentsAlsoTouchingAndTiny) {
  TriangleMesh input = Together(shapes::Icosphere(3), Moved(shapes::Icosphere(3), {2, 0, 0}));  // touching at (1, 0, 0)
  input = Together(input, Moved(shapes::Torus(24, 12), {0, 4, 0}));
  input = Together(input, Moved(Scaled(lacerta::testing::Tetrahedron(), 1e-3f), {1, 1, 1}));
  for (const uint32_t size : {1u, 100u, 500u}) {
    const NormalMesh mesh = Remesh(input, size, 3);
    EXPECT_LE(mesh.mesh.num_base_vertices, std::max(size, 30u));
    ExpectSound(input, mesh);
    EXPECT_GT(NormalShare(mesh), 0.7);
    EXPECT_GT(PsnrOf(input, mesh), size == 1 ? 25 : size == 100 ? 50 : 55);
  }
}

TEST(NormalShare, CountsKinds) {
  NormalMesh mesh;
  EXPECT_EQ(NormalShare(mesh), 1);
  mesh.piercing = {PiercingKind::kNormal, PiercingKind::kClosest, PiercingKind::kNormal, PiercingKind::kParametric};
  EXPECT_EQ(NormalShare(mesh), 0.5);
}

}  // namespace
}  // namespace lacerta
