#include "remesh/mesh_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lacerta/surface_distance.h"
#include "remesh/folds.h"
#include "remesh/simplify.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

double PsnrOf(const TriangleMesh& mesh, const TriangleMesh& other) {
  const double distance = MeasureSurfaceDistance(mesh, other, SurfaceDistanceOptions::RmsOnly(30000)).value().Rms();
  return Psnr(distance, BoundingBoxDiagonal(mesh));
}

double Bits(const TriangleMesh& mesh, const LinearPredictions& predictions, const RateModel& rate) {
  double sum = 0;
  for (size_t i = 0; i < predictions.size(); ++i) {
    Vec3d error;
    for (const auto& [v, factor] : predictions[i]) error += Vec3Cast<double>(mesh.positions[v]) * static_cast<double>(factor);
    sum += predictions.flaps() * rate.BitsOfFlap(SquaredNorm(error));
  }
  return sum;
}

// Where it is known what predicts what, nothing is done for the flaps that predict nothing.
TEST(MeshFitTest, KnownPredictionsGetBetterThanUnknownOnes) {
  const TriangleMesh mesh = shapes::BumpySphere(5, 0.2f);
  const FitTarget target(mesh, 10000);
  TriangleMesh simplified = SimplificationSequence(mesh).MeshWith(400);
  const MeshNeighbors neighbors(simplified);
  FitToSurface(target, neighbors, RateModel(), 3, &simplified);
  // Of each vertex one flap that it is across in, if there is any.
  LinearPredictions known(LinearPredictions::kFlapsPerVertex);
  std::vector<bool> is_predicted(simplified.positions.size(), false);
  for (const auto& [a, b, c, d] : neighbors.flaps) {
    if (is_predicted[d]) continue;
    is_predicted[d] = true;
    known.Add(d, 1);
    known.Add(a, -1);
    known.Add(b, -1);
    known.Add(c, 1);
    known.EndPrediction();
  }
  const RateModel rate = RateModel::For(1e-4, simplified.positions.size());
  TriangleMesh by_known = simplified, by_flaps = simplified;
  FitToSurface(target, neighbors, rate, known, 3, &by_known);
  FitToSurface(target, neighbors, rate, 3, &by_flaps);
  EXPECT_LT(Bits(by_flaps, known, rate), Bits(simplified, known, rate));
  EXPECT_LT(Bits(by_known, known, rate), 0.97 * Bits(by_flaps, known, rate));
  EXPECT_GT(Bits(by_known, known, rate), 0.5 * Bits(by_flaps, known, rate));
  EXPECT_EQ(LinearPredictions::OfFlaps(neighbors).size(), neighbors.flaps.size());
}

TEST(MeshFitTest, BitSlopeIsTheDerivative) {
  const RateModel rate{0.1, 1};
  EXPECT_EQ(rate.BitsOfFlap(0), 0);
  for (const double r2 : {0.0, 0.01, 0.3}) {
    const double numeric = (rate.BitsOfFlap(r2 + 1e-6) - rate.BitsOfFlap(r2)) / 1e-6;
    EXPECT_NEAR(rate.BitSlope(r2), numeric, 1e-3 * numeric);
  }
  EXPECT_NEAR(rate.BitsOfFlap(400) - rate.BitsOfFlap(100), 1, 1e-3);  // a bit and a half for the three coordinates, on three flaps
}

TEST(MeshFitTest, BringsSmoothSurfacesCloser) {
  for (const TriangleMesh& mesh : {shapes::BumpySphere(5, 0.2f), shapes::Torus(100, 50)}) {
    TriangleMesh fitted = SimplificationSequence(mesh).MeshWith(400);
    const double before = PsnrOf(mesh, fitted);
    FitToSurface(FitTarget(mesh, 10000), MeshNeighbors(fitted), RateModel(), 3, &fitted);
    EXPECT_GT(PsnrOf(mesh, fitted), before + 1.5);
    EXPECT_LT(PsnrOf(mesh, fitted), before + 6);
  }
}

TEST(MeshFitTest, LeavesTheBestAlone) {
  const TriangleMesh mesh = shapes::CreasedBox(12);
  TriangleMesh fitted = SimplificationSequence(mesh).MeshWith(12);
  FitToSurface(FitTarget(mesh, 5000), MeshNeighbors(fitted), RateModel(), 3, &fitted);
  EXPECT_GT(PsnrOf(mesh, fitted), 90);
}

TEST(MeshFitTest, FindsBordersAgain) {
  const TriangleMesh mesh = shapes::GridWithBorder(40, 40, 0.2f);
  TriangleMesh fitted = SimplificationSequence(mesh).MeshWith(100);
  const double best = PsnrOf(mesh, fitted);
  for (Vec3f& p : fitted.positions) p = p * 0.97f + Vec3f{0.015f, 0.015f, 0};
  EXPECT_LT(PsnrOf(mesh, fitted), best - 5);
  FitToSurface(FitTarget(mesh, 10000), MeshNeighbors(fitted), RateModel(), 5, &fitted);
  EXPECT_GT(PsnrOf(mesh, fitted), best - 1);
}

TEST(MeshFitTest, PaysForSmallerPredictionErrors) {
  const TriangleMesh mesh = shapes::BumpySphere(5, 0.2f);
  const FitTarget target(mesh, 10000);
  TriangleMesh plain = SimplificationSequence(mesh).MeshWith(400);
  const MeshNeighbors neighbors(plain);
  FitToSurface(target, neighbors, RateModel(), 2, &plain);
  TriangleMesh cheap = plain;
  const double distance = MeasureSurfaceDistance(mesh, plain).value().Rms();
  const RateModel rate{4 * distance, distance * distance / 200};
  FitToSurface(target, neighbors, rate, 3, &cheap);
  FitToSurface(target, neighbors, RateModel(), 3, &plain);
  const LinearPredictions flaps = LinearPredictions::OfFlaps(neighbors);
  EXPECT_LT(Bits(cheap, flaps, rate), 0.95 * Bits(plain, flaps, rate));
  EXPECT_LT(PsnrOf(mesh, cheap), PsnrOf(mesh, plain));
  EXPECT_GT(PsnrOf(mesh, cheap), PsnrOf(mesh, plain) - 2);
}

TEST(MeshFitTest, NoVertexGoesFartherThanTheTargetAllows) {
  const TriangleMesh mesh = shapes::BumpySphere(5, 0.2f);
  const RateModel dear{0.02, 1e-3};  // bits, so that the surface shrinks for them
  const auto farthest_within = [&](double farthest) {
    const FitTarget target(mesh, 10000, farthest);
    TriangleMesh fitted = SimplificationSequence(mesh).MeshWith(400);
    FitToSurface(target, MeshNeighbors(fitted), dear, 3, &fitted);
    double squared = 0;
    uint32_t hint = SurfacePoint::kNone;
    for (const Vec3f& p : fitted.positions) squared = std::max(squared, target.SquaredDistance(p, &hint));
    return std::sqrt(squared);
  };
  EXPECT_GT(farthest_within(0), 0.05);
  EXPECT_LE(farthest_within(0.05), 0.05);
  EXPECT_GT(farthest_within(0.05), 0.02);
}

TEST(MeshFitTest, TurnsNothingOver) {
  const TriangleMesh mesh = shapes::SpikySphere(4);
  TriangleMesh fitted = SimplificationSequence(mesh).MeshWith(150);
  const TriangleMesh before = fitted;
  FitToSurface(FitTarget(mesh, 5000), MeshNeighbors(fitted), RateModel(), 1, &fitted);
  for (const Triangle& t : before.triangles) {
    const auto normal = [&](const TriangleMesh& m) {
      return Cross(m.positions[t[1]] - m.positions[t[0]], m.positions[t[2]] - m.positions[t[0]]);
    };
    EXPECT_GE(Dot(normal(before), normal(fitted)), 0);
  }
}

// Neither does a little in every round.
TEST(MeshFitTest, FoldsNothing) {
  for (const TriangleMesh& mesh : {shapes::SpikySphere(4), shapes::TwoHoledPlate(12)}) {
    TriangleMesh fitted = SimplificationSequence(mesh).MeshWith(150);
    const TriangleMesh before = fitted;
    const MeshNeighbors neighbors(fitted);
    FitToSurface(FitTarget(mesh, 5000), neighbors, RateModel(), 8, &fitted);
    EXPECT_NE(fitted.positions, before.positions);
    for (const auto& flap : neighbors.flaps) {
      EXPECT_TRUE(IsFolded(flap, before.positions) || !IsFolded(flap, fitted.positions));
    }
  }
}

}  // namespace
}  // namespace lacerta
