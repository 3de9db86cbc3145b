#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "lacerta/surface_distance.h"
#include "remesh/folds.h"
#include "remesh/simplify.h"
#include "remesh/lattice_fit.h"
#include "remesh/mesh_fit.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

class LatticeFitTest : public ::testing::Test {
 protected:
  LatticeFitTest() : mesh_(shapes::BumpySphere(5, 0.2f)), target_(mesh_, 10000), fitted_(SimplificationSequence(mesh_).MeshWith(600)) {
    const MeshNeighbors neighbors(fitted_);
    FitToSurface(target_, neighbors, RateModel(), 3, &fitted_);
  }

  double DistanceOf(const TriangleMesh& other) const {
    return MeasureSurfaceDistance(mesh_, other, SurfaceDistanceOptions::RmsOnly(30000)).value().Rms();
  }

  LatticeMesh Fit(const RateModel& rate) const {
    const MeshNeighbors neighbors(fitted_);
    return FitToLattice(target_, fitted_, target_.ModelAt(fitted_, neighbors), neighbors, rate);
  }

  TriangleMesh mesh_;
  FitTarget target_;
  TriangleMesh fitted_;
};

TEST_F(LatticeFitTest, BeatsRoundingByFar) {
  const double step = 8 * DistanceOf(fitted_);
  const LatticeMesh lattice = Fit({step, 0});
  TriangleMesh rounded = fitted_;
  for (Vec3f& p : rounded.positions) {
    for (int c = 0; c < 3; ++c) p[c] = static_cast<float>(step * std::round(static_cast<double>(p[c]) / step));
  }
  const double fit = DistanceOf(fitted_), descended = DistanceOf(lattice.ToMesh()), nearest = DistanceOf(rounded);
  EXPECT_LT(descended, 0.8 * nearest);
  EXPECT_GT(descended, fit);
}

TEST_F(LatticeFitTest, NearestPointsAreWithinHalfAStep) {
  const double step = 0.03;
  const LatticeMesh lattice = NearestOnLattice(mesh_, step);
  EXPECT_EQ(lattice.triangles, mesh_.triangles);
  EXPECT_FLOAT_EQ(lattice.step, static_cast<float>(step));
  const TriangleMesh result = lattice.ToMesh();
  double farthest = 0;
  for (size_t v = 0; v < result.positions.size(); ++v) {
    for (int c = 0; c < 3; ++c) farthest = std::max(farthest, static_cast<double>(std::fabs(result.positions[v][c] - mesh_.positions[v][c])));
  }
  EXPECT_LT(farthest, 0.501 * step);
  EXPECT_GT(farthest, 0.48 * step);
  const double squared = DistanceOf(result) * DistanceOf(result);  // of a coordinate step^2 / 12, of a point within a face less
  EXPECT_LT(squared, step * step / 12);
  EXPECT_GT(squared, step * step / 48);
}

TEST_F(LatticeFitTest, StaysNearAndBeginsAtZero) {
  const double step = 0.03;
  const LatticeMesh lattice = Fit({step, 0});
  const TriangleMesh result = lattice.ToMesh();
  ASSERT_EQ(lattice.triangles, fitted_.triangles);
  std::array<int32_t, 3> low = lattice.lattice[0];
  for (size_t v = 0; v < lattice.lattice.size(); ++v) {
    for (size_t c = 0; c < 3; ++c) low[c] = std::min(low[c], lattice.lattice[v][c]);
    EXPECT_LE(static_cast<double>(Norm(result.positions[v] - fitted_.positions[v])), 3.01 * step);
  }
  EXPECT_EQ(low, (std::array<int32_t, 3>{0, 0, 0}));
  EXPECT_FLOAT_EQ(lattice.step, static_cast<float>(step));
}

TEST_F(LatticeFitTest, FineLatticesKeepTheFit) {
  const double fit = DistanceOf(fitted_);
  EXPECT_NEAR(DistanceOf(Fit({0.05 * fit, 0}).ToMesh()), fit, 0.01 * fit);
}

TEST(LatticeFit, TurnsBackWhatRoundingTurnedOver) {
  TriangleMesh mesh = shapes::GridWithBorder(40, 40, 0.2f);
  std::mt19937 random(1);
  for (Vec3f& p : mesh.positions) p += Vec3f{static_cast<float>(random() % 17), static_cast<float>(random() % 17), 0} * 0.001f;  // 2/3 of a square
  const FitTarget target(mesh, 10000);
  const MeshNeighbors neighbors(mesh);
  const double step = 0.02;
  const auto num_folded = [&](const TriangleMesh& m) {
    return std::count_if(neighbors.flaps.begin(), neighbors.flaps.end(), [&](const auto& flap) { return IsFolded(flap, m.positions); });
  };
  TriangleMesh rounded = mesh;
  for (Vec3f& p : rounded.positions) {
    for (int c = 0; c < 3; ++c) p[c] = static_cast<float>(step * std::round(static_cast<double>(p[c]) / step));
  }
  EXPECT_EQ(num_folded(mesh), 0);
  EXPECT_GT(num_folded(rounded), 10);
  EXPECT_LE(num_folded(FitToLattice(target, mesh, target.ModelAt(mesh, neighbors), neighbors, {step, 1e-7}).ToMesh()), num_folded(rounded) / 5);
}

// For dear bits vertices come to parallelograms that the surface has not.
TEST_F(LatticeFitTest, NoVertexGoesFartherThanTheTargetAllows) {
  const MeshNeighbors neighbors(fitted_);
  const RateModel rate{0.02, 1e-3};
  const auto farthest_within = [&](double farthest) {
    const FitTarget target(mesh_, 10000, farthest);
    double squared = 0;
    uint32_t hint = SurfacePoint::kNone;
    for (const Vec3f& p : FitToLattice(target, fitted_, target.ModelAt(fitted_, neighbors), neighbors, rate).ToMesh().positions) {
      squared = std::max(squared, target.SquaredDistance(p, &hint));
    }
    return std::sqrt(squared);
  };
  EXPECT_GT(farthest_within(0), 0.04);
  EXPECT_LE(farthest_within(0.02), 0.02);
}

TEST_F(LatticeFitTest, BitsAreSavedWhereTheyWeigh) {
  const MeshNeighbors neighbors(fitted_);
  const auto flap_bits = [&](const LatticeMesh& mesh, const RateModel& rate) {
    const TriangleMesh m = mesh.ToMesh();
    double bits = 0;
    for (const auto& [a, b, c, d] : neighbors.flaps) {
      bits += rate.BitsOfFlap(static_cast<double>(SquaredNorm(m.positions[a] + m.positions[b] - m.positions[c] - m.positions[d])));
    }
    return bits;
  };
  const double step = 0.02;
  const RateModel free{step, 0}, paid{step, 1e-7};
  const LatticeMesh a = Fit(free), b = Fit(paid);
  EXPECT_LT(flap_bits(b, paid), 0.98 * flap_bits(a, paid));
  EXPECT_LT(DistanceOf(b.ToMesh()), 2 * DistanceOf(a.ToMesh()));
}

}  // namespace
}  // namespace lacerta
