// Remeshes with levels enough for a PSNR.
#include "draco/fitted_remesh.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <utility>

#include "draco_ext/draco/simplified_input.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

constexpr uint32_t kBase = 40;

class FittedRemeshTest : public ::testing::Test {
 protected:
  FittedRemesh At(double psnr, std::unique_ptr<PiercedBase> begun = nullptr) const {
    return RemeshForPsnr(input_.Refinable(), kBase, psnr, BaseCoding::kStock, input_.meter, std::move(begun)).value();
  }

  const testing::SimplifiedInput input_{shapes::BumpySphere(5, 0.0f, 0.02f)};
};

TEST_F(FittedRemeshTest, HasTheLevelsThatThePsnrNeeds) {
  const FittedRemesh coarse = At(45), fine = At(60);
  EXPECT_GT(coarse.psnr, 45);
  EXPECT_LT(coarse.psnr, 60);
  EXPECT_GT(fine.psnr, 60);
  EXPECT_GT(fine.mesh.mesh.num_levels, coarse.mesh.mesh.num_levels);
  ASSERT_NE(coarse.pierced, nullptr);
  EXPECT_EQ(coarse.pierced->num_levels(), coarse.mesh.mesh.num_levels);
}

TEST_F(FittedRemeshTest, GoesOnFromFewerLevelsAsIfFromTheBase) {
  FittedRemesh coarse = At(45);
  const FittedRemesh at_once = At(60), later = At(60, std::move(coarse.pierced));
  EXPECT_EQ(later.mesh.mesh.num_levels, at_once.mesh.mesh.num_levels);
  EXPECT_EQ(later.mesh.mesh.positions, at_once.mesh.mesh.positions);
  EXPECT_EQ(later.mesh.mesh.base_triangles, at_once.mesh.mesh.base_triangles);
  EXPECT_EQ(later.psnr, at_once.psnr);
}

TEST_F(FittedRemeshTest, EndsWhereThereAreManyTimesTheVerticesOfTheInput) {
  const FittedRemesh best = At(200);
  EXPECT_EQ(best.pierced, nullptr);
  EXPECT_LT(best.psnr, 200);
  const double vertices = static_cast<double>(best.mesh.mesh.positions.size()), input = static_cast<double>(input_.mesh.positions.size());
  EXPECT_GT(vertices, 4 * input);
  EXPECT_LE(vertices, 24 * input);
}

}  // namespace
}  // namespace lacerta
