#include "encoder/quantizer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "shapes/shapes.h"

namespace lacerta {
namespace {

TEST(RoundToStep, TakesTheNearestBin) {
  EXPECT_EQ(RoundToStep(0.0f, 0.5f), 0);
  EXPECT_EQ(RoundToStep(0.26f, 0.5f), 1);
  EXPECT_EQ(RoundToStep(0.24f, 0.5f), 0);
  EXPECT_EQ(RoundToStep(-0.74f, 0.5f), -1);
  EXPECT_EQ(RoundToStep(-0.76f, 0.5f), -2);
  EXPECT_EQ(RoundToStep(1234.0f, 1.0f), 1234);
}

TEST(RoundToStep, StaysWithinWhatAStreamHolds) {
  EXPECT_EQ(RoundToStep(1e30f, 1e-3f), kMaxMagnitude);
  EXPECT_EQ(RoundToStep(-1e30f, 1e-3f), -kMaxMagnitude);
  EXPECT_EQ(RoundToStep(std::numeric_limits<float>::infinity(), 1.0f), kMaxMagnitude);
  EXPECT_EQ(RoundToStep(5.0f, 0.0f), 0);
  EXPECT_EQ(RoundToStep(5.0f, -1.0f), 0);
  EXPECT_EQ(RoundToStep(std::numeric_limits<float>::quiet_NaN(), 1.0f), 0);
}

float LargestCoordinate(const TriangleMesh& mesh) {
  float largest = 0;
  for (const Vec3f& p : mesh.positions) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  return largest;
}

void ExpectNearestPoints(const TriangleMesh& mesh, const BaseMesh& base) {
  const TriangleMesh rounded = base.ToMesh();
  ASSERT_EQ(rounded.positions.size(), mesh.positions.size());
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_LE(std::fabs(rounded.positions[v][c] - mesh.positions[v][c]), base.step * 0.50001f);
      const double exact = static_cast<double>(base.step) * base.lattice[v][static_cast<size_t>(c)];
      EXPECT_EQ(static_cast<double>(rounded.positions[v][c]), exact) << "floats hold lattice points exactly";
    }
  }
}

TEST(RoundToLattice, RoundsToTheNearestPointOfTheStep) {
  const TriangleMesh mesh = shapes::BumpySphere(2);
  for (const float step : {1e-4f, 0.0123f, 0.25f, 0.9f}) {
    const BaseMesh base = RoundToLattice(mesh, step);
    EXPECT_LE(base.step, step);
    EXPECT_GT(base.step, step * (1 - 1.0f / 128));
    EXPECT_EQ(base.triangles, mesh.triangles);
    ASSERT_EQ(base.lattice.size(), mesh.positions.size());
    ExpectNearestPoints(mesh, base);
  }
}

TEST(RoundToLattice, RaisesStepsThatFloatsCouldNotHold) {
  for (const float scale : {1e-30f, 1e-3f, 1.0f, 1e6f, 1e30f}) {
    TriangleMesh mesh = shapes::Icosphere(1);
    for (Vec3f& p : mesh.positions) p *= scale;
    for (const float step : {0.0f, 1e-9f * scale, -1.0f}) {
      const BaseMesh base = RoundToLattice(mesh, step);
      const float extent = LargestCoordinate(mesh);
      EXPECT_LE(extent / base.step, 1 << 22);
      EXPECT_GT(extent / base.step, 1 << 20);
      const TriangleMesh rounded = base.ToMesh();
      for (size_t v = 0; v < mesh.positions.size(); ++v) EXPECT_LE(Norm(rounded.positions[v] * (1 / scale) - mesh.positions[v] * (1 / scale)), 2e-5f);
    }
  }
}

TEST(RoundToLattice, ShortensTheStepFarFromZero) {
  for (const float distance : {1e3f, 1e4f, 1e5f}) {
    TriangleMesh mesh = shapes::Icosphere(2);
    for (Vec3f& p : mesh.positions) p += Vec3f{distance, -0.3f * distance, 0};
    constexpr float kStep = 0.11f;
    const BaseMesh base = RoundToLattice(mesh, kStep);
    EXPECT_LE(base.step, kStep);
    EXPECT_GT(base.step, 0.6f * kStep);
    ExpectNearestPoints(mesh, base);
  }
}

TEST(RoundToLattice, OddStepsAndMeshes) {
  const TriangleMesh point{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {{0, 1, 2}}};
  EXPECT_TRUE(std::isnormal(RoundToLattice(point, 0.0f).step));
  for (const float step : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(), 3e38f}) {
    const BaseMesh base = RoundToLattice(shapes::Icosphere(1), step);
    EXPECT_TRUE(std::isnormal(base.step)) << step;
    EXPECT_GT(base.step, 0);
    EXPECT_TRUE(std::isfinite(base.ToMesh().positions[0].x));
  }
}

}  // namespace
}  // namespace lacerta
