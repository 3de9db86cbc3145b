#include "remesh/base_optimization.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "draco_ext/remesh/decimated_input.h"
#include "draco_ext/remesh/remeshing.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using lacerta::testing::BasePositions;

struct Optimized : testing::DecimatedInput {
  Optimized(const TriangleMesh& input, uint32_t num_vertices)
      : DecimatedInput(input, num_vertices), domain(Domain()), first_triangles(domain.triangles()), start(BasePositions(domain, mesh)), positions(start) {
    OptimizeBase(surface, &domain, &positions);
  }

  BaseDomain domain;
  const std::vector<Triangle> first_triangles;
  const std::vector<Vec3f> start;
  std::vector<Vec3f> positions;
};

TEST(OptimizeBase, VerticesMoveAndEdgesTurn) {
  for (const TriangleMesh& input : {shapes::BumpySphere(5), shapes::Torus(96, 48)}) {
    const Optimized base(input, 100);
    EXPECT_NE(base.positions, base.start);
    EXPECT_NE(base.domain.triangles(), base.first_triangles);
  }
}

// Also where vertices slid, edges turned, and vertices slid again.
TEST(OptimizeBase, WhatIsPiercedStandsWhereTheDomainSays) {
  for (const TriangleMesh& input : {shapes::BumpySphere(4), shapes::Torus(64, 32), shapes::GridWithBorder(40, 40, 0.3f)}) {
    const Optimized base(input, 60);
    testing::ExpectPiercedWhereTheDomainSays(base.surface, base.domain, base.positions);
  }
}

TEST(OptimizeBase, LargeBasesStay) {
  const Optimized base(shapes::BumpySphere(6), 12'000);
  EXPECT_EQ(base.positions, base.start);
  EXPECT_EQ(base.domain.triangles(), base.first_triangles);
}

}  // namespace
}  // namespace lacerta
