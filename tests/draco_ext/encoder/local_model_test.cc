#include "encoder/local_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "draco_ext/remesh/remeshing.h"
#include "encoder/coefficient_descent.h"

namespace lacerta {
namespace {

using lacerta::testing::Remesh;

// What moving a vertex of `level` along its normal by 1 does to the distortion of a surface that lies on the target, all finer levels being predicted.
double TrueCurvature(const SurfaceTarget& target, int level, uint32_t v) {
  std::vector<Vec3f> moves(target.topologies[level].num_vertices);
  moves[v] = target.normals[v];
  for (int finer = level; finer < target.num_levels(); ++finer) {
    const std::vector<Vec3f> midpoints = target.midpoints[finer].Predict(moves);
    moves.insert(moves.end(), midpoints.begin(), midpoints.end());
  }
  constexpr float kLength = 1e-2f;
  std::vector<Vec3f> moved = target.points;
  for (size_t u = 0; u < moved.size(); ++u) moved[u] += moves[u] * kLength;
  return PlaneDistortion(target, moved) / (double{kLength} * kLength);
}

// The mean of what Curvatures says over what is true.
double MeanRatio(const SurfaceTarget& target, int level) {
  const std::vector<SymmetricMatrix> curvatures = Curvatures(target, level);
  const auto num_vertices = static_cast<uint32_t>(curvatures.size()), num_tried = std::min(num_vertices, 50u);
  double sum = 0;
  for (uint32_t v = num_vertices - num_tried; v < num_vertices; ++v) {
    sum += curvatures[v].Along(target.normals[v]) / TrueCurvature(target, level, v);
  }
  return sum / num_tried;
}

TEST(Curvatures, AreThoseOfTheDistortionButOnTheLastLevels) {
  const SurfaceTarget target = MakeSurfaceTarget(Remesh(shapes::BumpySphere(5, 0.1f, 0.0f), 60, 4));
  for (const int level : {0, 1, 2}) {
    EXPECT_GT(MeanRatio(target, level), 0.99) << level;
    EXPECT_LT(MeanRatio(target, level), 1.07) << level << ": looked at one level finer alone, 1.10";
  }
  EXPECT_NEAR(MeanRatio(target, 3), 1.2, 0.1) << "masses lumped at the vertices overstate";
  EXPECT_NEAR(MeanRatio(target, 4), 2.0, 0.1);
}

}  // namespace
}  // namespace lacerta
