#include "remesh/surface_fit.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "draco_ext/remesh/remeshing.h"
#include "lacerta/decoder.h"

namespace lacerta {
namespace {

using lacerta::testing::Remesh;
using lacerta::testing::Scaled;
using lacerta::testing::TopologyOf;

NormalMesh Fitted(const TriangleMesh& input, NormalMesh mesh) {
  FitToInput(InputSurface(input, TopologyOf(input)), SurfaceFitOptions(), &mesh);
  return mesh;
}

double Rms(const TriangleMesh& input, const NormalMesh& mesh) {
  const TriangleMesh finest = MeshAtLevel(mesh.mesh, mesh.mesh.num_levels).value();
  return MeasureSurfaceDistance(input, finest, SurfaceDistanceOptions::RmsOnly(100'000)).value().Rms();
}

TEST(FitToInput, IsCloserThanInterpolation) {
  struct Case {
    const char* name;
    TriangleMesh input;
    double least, most;  // of the error that stays
  };
  const Case cases[] = {{"sphere", shapes::Icosphere(5), 0.3, 0.6},
                        {"bumps", shapes::BumpySphere(5), 0.4, 0.75},
                        {"noise", shapes::BumpySphere(5, 0.1f, 0.01f), 0.5, 0.95},
                        {"torus", shapes::Torus(96, 48), 0.3, 0.7}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const NormalMesh pierced = Remesh(c.input, 80, 3);
    const double share = Rms(c.input, Fitted(c.input, pierced)) / Rms(c.input, pierced);
    EXPECT_GT(share, c.least);
    EXPECT_LT(share, c.most);
  }
}

TEST(FitToInput, MovesVerticesAlongTheNormalsOnly) {
  const TriangleMesh input = shapes::BumpySphere(4);
  const NormalMesh before = Remesh(input, 60, 3), after = Fitted(input, before);
  EXPECT_EQ(after.mesh.base_triangles, before.mesh.base_triangles);
  EXPECT_EQ(after.surface_normals, before.surface_normals);
  EXPECT_EQ(after.piercing, before.piercing);
  size_t moved = 0;
  for (size_t v = 0; v < before.mesh.positions.size(); ++v) {
    const Vec3f move = after.mesh.positions[v] - before.mesh.positions[v];
    EXPECT_LT(Norm(Cross(move, before.surface_normals[v])), 1e-6f);
    moved += Norm(move) > 1e-5f;
  }
  EXPECT_GT(moved, before.mesh.positions.size() / 2);
}

TEST(FitToInput, LeavesAloneWhatFitsAlready) {
  const SemiRegularMesh flat = Remesh(shapes::GridWithBorder(20, 20), 30, 3).mesh;
  const NormalMesh fitted = Fitted(shapes::GridWithBorder(20, 20), Remesh(shapes::GridWithBorder(20, 20), 30, 3));
  for (size_t v = 0; v < flat.positions.size(); ++v) EXPECT_LT(Norm(fitted.mesh.positions[v] - flat.positions[v]), 1e-6f);
}

TEST(FitToInput, KeepsTheCopiesAtACutInPlace) {
  const TriangleMesh input = shapes::BumpySphere(4);
  NormalMesh before = Remesh(input, 60, 2);
  std::vector<uint32_t>& joined = before.mesh.tags.joined;
  for (uint32_t v = 0; v < 60; ++v) joined.push_back(v == 40 ? 11 : v == 59 ? 30 : v);
  const NormalMesh after = Fitted(input, before);
  size_t moved = 0;
  for (uint32_t v = 0; v < 60; ++v) {
    moved += !(after.mesh.positions[v] == before.mesh.positions[v]);
  }
  EXPECT_GT(moved, 50u);
  for (const uint32_t v : {11, 40, 30, 59}) EXPECT_EQ(after.mesh.positions[v], before.mesh.positions[v]) << v;
}

TEST(FitToInput, TurnsNoTriangleOver) {
  const auto turned_area = [](const NormalMesh& mesh) {
    double area = 0;
    const TriangleMesh fine = MeshAtLevel(mesh.mesh, mesh.mesh.num_levels).value();
    for (const Triangle& t : fine.triangles) {
      const Vec3f normal = mesh.surface_normals[t[0]] + mesh.surface_normals[t[1]] + mesh.surface_normals[t[2]];
      const Vec3f &a = fine.positions[t[0]], &b = fine.positions[t[1]], &c = fine.positions[t[2]];
      area += std::max(0.0f, -Dot(Cross(b - a, c - a), Normalized(normal)));
    }
    return area;
  };
  for (const TriangleMesh& input : {shapes::SpikySphere(5, 40, 0.8f), shapes::BumpySphere(5, 0.2f, 0.03f)}) {
    const NormalMesh pierced = Remesh(input, 100, 3), fitted = Fitted(input, pierced);
    EXPECT_LE(turned_area(fitted), turned_area(pierced) * 1.5);  // what is turned over already may grow
    EXPECT_LT(Rms(input, fitted), Rms(input, pierced));
  }
}

TEST(FitToInput, DoesNotDependOnTheNumberOfThreads) {
  const TriangleMesh input = shapes::BumpySphere(4, 0.2f, 0.01f);
  const NormalMesh pierced = Remesh(input, 60, 3);
  std::vector<NormalMesh> fitted;
  for (const size_t threads : {1, 3}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    fitted.push_back(Fitted(input, pierced));
  }
  EXPECT_EQ(fitted[0].mesh.positions, fitted[1].mesh.positions);
}

TEST(FitToInput, DoesNotDependOnScale) {
  const TriangleMesh input = shapes::BumpySphere(3);
  const NormalMesh expected = Fitted(input, Remesh(input, 40, 2));
  for (const int exponent : {-20, 20}) {
    const TriangleMesh scaled = Scaled(input, std::ldexp(1.0f, exponent));
    const NormalMesh mesh = Fitted(scaled, Remesh(scaled, 40, 2));
    for (size_t v = 0; v < mesh.mesh.positions.size(); ++v) {
      EXPECT_LT(Norm(mesh.mesh.positions[v] * std::ldexp(1.0f, -exponent) - expected.mesh.positions[v]), 1e-4f);
    }
  }
}

TEST(FitToInput, SurvivesDegenerateInput) {
  TriangleMesh flat = shapes::Icosphere(3), collapsed = shapes::Icosphere(3);
  for (Vec3f& p : flat.positions) p.z = 0;
  for (size_t t = 0; t < collapsed.triangles.size(); t += 5) {
    collapsed.positions[collapsed.triangles[t][0]] = collapsed.positions[collapsed.triangles[t][1]];
  }
  for (const TriangleMesh& input : {flat, collapsed, shapes::SpikySphere(4), shapes::ThinPlate(8)}) {
    const NormalMesh mesh = Fitted(input, Remesh(input, 30, 3));
    for (const Vec3f& p : mesh.mesh.positions) {
      EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
      EXPECT_LT(Norm(p), 4.0f);
    }
  }
}

}  // namespace
}  // namespace lacerta
