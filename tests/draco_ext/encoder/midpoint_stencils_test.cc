#include "encoder/midpoint_stencils.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "draco_ext/encoder/tagged_meshes.h"
#include "encoder/surface_target.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

// Three levels from `base` on; its positions: #V0.
void ExpectSamePredictions(Topology topology, std::vector<Vec3f> positions) {
  const StencilTable table(topology);
  for (int level = 0; level < 3; ++level, topology = Refine(topology)) {
    const std::vector<Vec3f> expected = PredictMidpoints(topology, table, positions);
    const MidpointStencils stencils(topology, table);
    EXPECT_EQ(stencils.Predict(positions), expected);  // to the last bit
    positions.resize(positions.size() + expected.size());
    stencils.Predict(positions.data(), positions.data() + topology.num_vertices);
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), positions.begin() + topology.num_vertices)) << "in one array";
  }
}

TEST(MidpointStencils, PredictAsPredictMidpointsDoes) {
  for (const TriangleMesh& mesh : {shapes::Pillow(), shapes::Bipyramid(4), shapes::Bipyramid(300), shapes::Icosahedron(), shapes::Torus(5, 4),
                                   shapes::SingleTriangle(), shapes::Fan(6), shapes::Grid(4), shapes::BumpySphere(2)}) {
    ExpectSamePredictions(shapes::TopologyOf(mesh), mesh.positions);
  }
}

TEST(MidpointStencils, KnowCurvesAndJoinedBorders) {
  for (const lacerta::testing::TaggedBase& tagged : lacerta::testing::TaggedBases()) {
    const NormalMesh mesh = lacerta::testing::Bent(tagged, 1);
    const Topology topology = BuildTopology(mesh.mesh.num_base_vertices, mesh.mesh.base_triangles, mesh.mesh.tags).value();
    ExpectSamePredictions(topology, {mesh.mesh.positions.begin(), mesh.mesh.positions.begin() + mesh.mesh.num_base_vertices});
  }
}

}  // namespace
}  // namespace lacerta
