#include "remesh/base_optimization.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "draco_ext/remesh/remeshing.h"
#include "remesh/growing_normal_mesh.h"
#include "remesh/reversal.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using lacerta::testing::BasePositions;
using lacerta::testing::Decimated;
using lacerta::testing::TopologyOf;

struct Optimized {
  Optimized(const TriangleMesh& input, uint32_t num_vertices)
      : mesh(input), topology(TopologyOf(mesh)), surface(mesh, topology), history(Decimated(mesh, {num_vertices, 12, 0.2})), domain(history, history.num_collapses()),
        first_triangles(domain.triangles()), start(BasePositions(domain, mesh)), positions(start) {
    OptimizeBase(surface, &domain, &positions);
  }

  const TriangleMesh mesh;
  const Topology topology;
  const InputSurface surface;
  const CollapseHistory history;
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
    GrowingNormalMesh growing(base.surface, base.domain, base.positions, PiercingOptions());
    for (int level = 0; level < 3; ++level) growing.AddLevel();
    const double diagonal = BoundingBoxDiagonal(input);
    const std::vector<DomainPoint> parameters = growing.Parameters();
    for (size_t v = 0; v < parameters.size(); ++v) {
      const DomainPoint on_input = base.domain.ToInput(parameters[v]);
      EXPECT_LT(Norm(base.surface.PositionAt(on_input.face, on_input.barycentric) - growing.mesh().mesh.positions[v]), 1e-5 * diagonal) << v;
    }
    EXPECT_LT(FindReversed(base.surface, growing.mesh()).share, 0.002);
  }
}

TEST(OptimizeBase, LargeBasesStay) {
  const Optimized base(shapes::BumpySphere(6), 12'000);
  EXPECT_EQ(base.positions, base.start);
  EXPECT_EQ(base.domain.triangles(), base.first_triangles);
}

}  // namespace
}  // namespace lacerta
