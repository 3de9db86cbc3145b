#include "encoder/paper_mode.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "draco_ext/encoder/coded_surfaces.h"
#include "draco_ext/remesh/remeshing.h"

namespace lacerta {
namespace {

using lacerta::testing::BitsOf;
using lacerta::testing::ExpectDecodesAsSynthesized;
using lacerta::testing::Remesh;

double MeanSquaredError(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  double sum = 0;
  for (size_t v = 0; v < a.size(); ++v) sum += SquaredNorm(Vec3Cast<double>(a[v] - b[v]));
  return sum / static_cast<double>(a.size());
}

TEST(CodeByModel, SizesFallAndErrorsGrowWithTheSlope) {
  const NormalMesh mesh = Remesh(shapes::BumpySphere(4, 0.1f, 0.003f), 60, 3);
  const SurfaceTarget target = MakeSurfaceTarget(mesh);
  double last_bits = 1e18, last_error = 0;
  for (const double lambda : {1e-15, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8}) {
    SCOPED_TRACE(lambda);
    const StatusOr<CodedSurface> coded = CodeByModel(mesh.mesh, lambda);
    ASSERT_TRUE(coded.ok()) << coded.status().message();
    ExpectDecodesAsSynthesized(target, coded.value());
    const double bits = BitsOf(coded.value());
    const double error = MeanSquaredError(Synthesize(target, coded.value()), mesh.mesh.positions);
    EXPECT_LT(bits, last_bits);
    EXPECT_GT(error, last_error);
    last_bits = bits;
    last_error = error;
  }
}

// At high rate the slope is what the definition says: d error / d bits = -lambda.
TEST(CodeByModel, TheSlopeIsInTheUnitsPromised) {
  const NormalMesh mesh = Remesh(shapes::BumpySphere(4, 0.1f, 0.003f), 60, 3);
  const SurfaceTarget target = MakeSurfaceTarget(mesh);
  const double lambda = 1e-13;
  const CodedSurface fine = CodeByModel(mesh.mesh, lambda / 2).value(), coarse = CodeByModel(mesh.mesh, 2 * lambda).value();
  const double rise = MeanSquaredError(Synthesize(target, coarse), mesh.mesh.positions) -
                      MeanSquaredError(Synthesize(target, fine), mesh.mesh.positions);
  const double slope = rise / (BitsOf(fine) - BitsOf(coarse));
  EXPECT_GT(slope, lambda / 4);
  EXPECT_LT(slope, lambda * 4);
}

TEST(CodeByModel, TheBaseKeepsALattice) {
  const NormalMesh mesh = Remesh(shapes::BumpySphere(4), 60, 3);
  const StatusOr<CodedSurface> coded = CodeByModel(mesh.mesh, 1.0);  // nothing is worth a bit
  ASSERT_TRUE(coded.ok());
  EXPECT_GT(coded.value().base.step, 0);
  EXPECT_LT(coded.value().base.step, 0.5);
  for (const LevelSteps& steps : coded.value().steps) {
    EXPECT_EQ(steps.normal_step, 0);
    EXPECT_EQ(steps.tangential_step, 0);
  }
}

TEST(CodeByModel, RefusesMeshesItCannotAnalyze) {
  SemiRegularMesh mesh = Remesh(shapes::BumpySphere(3), 40, 2).mesh;
  EXPECT_TRUE(CodeByModel(mesh, 1e-9).ok());
  mesh.positions[50].x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(CodeByModel(mesh, 1e-9).status().code(), StatusCode::kInvalidArgument);
  mesh.positions.pop_back();
  EXPECT_FALSE(CodeByModel(mesh, 1e-9).ok());
}

}  // namespace
}  // namespace lacerta
