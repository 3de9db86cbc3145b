#include "remesh/simplify_in_parts.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "common/subdivision.h"
#include "lacerta/surface_distance.h"
#include "remesh/simplify.h"
#include "remesh/surface_errors.h"
#include "remesh/wedge_mesh.h"
#include "shapes/attributed_shapes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

const std::vector<double> kWeights{1e-3, 1e-3};

size_t NumOpenEdges(const AttributedMesh& mesh) {
  const WedgeMesh wedges = MakeWedgeMesh(mesh);
  size_t count = 0;
  for (const uint8_t edges : wedges.curve_edges) count += (edges & 1) + (edges >> 1 & 1) + (edges >> 2 & 1);
  return count;
}

class SimplifyInPartsTest : public ::testing::Test {
 protected:
  const AttributedMesh mesh_ = WeldSoups({shapes::TexturedGrid(100, 100, 0.3f)}).value();  // 20,000 triangles
};

TEST_F(SimplifyInPartsTest, LeavesTheShareAndWhatCutsHold) {
  for (const uint32_t part_triangles : {20'000u, 5000u, 1300u}) {
    const AttributedMesh simplified = SimplifyInParts(mesh_, kWeights, 4000, part_triangles);
    EXPECT_TRUE(CheckAttributedMesh(simplified).ok());
    EXPECT_GE(simplified.surface.triangles.size(), 3900u) << part_triangles;
    EXPECT_LE(simplified.surface.triangles.size(), 4100u) << part_triangles;
  }
}

// No crack and no seam comes of a cut: open borders and seams are those of the input, with fewer edges.
TEST_F(SimplifyInPartsTest, CutsCloseAgain) {
  const AttributedMesh simplified = SimplifyInParts(mesh_, kWeights, 4000, 1300);
  const WedgeMesh wedges = MakeWedgeMesh(simplified);
  EXPECT_EQ(wedges.components.size(), MakeWedgeMesh(mesh_).components.size());
  EXPECT_EQ(wedges.components[0].borders, MakeWedgeMesh(mesh_).components[0].borders);
  EXPECT_LE(NumOpenEdges(simplified), NumOpenEdges(mesh_));
  EXPECT_GE(NumOpenEdges(simplified), NumOpenEdges(mesh_) / 8);
  EXPECT_EQ(wedges.num_vertices(), simplified.surface.positions.size());  // nothing was cut to be a manifold
}

TEST_F(SimplifyInPartsTest, IsNotMuchFartherThanOneRunOverAll) {
  const SurfaceErrorMeter meter = SurfaceErrorMeter::Create(mesh_).value();
  const SurfaceErrors whole = meter.Measure(SimplifyInParts(mesh_, kWeights, 4000, 20'000), 100'000).value();
  const SurfaceErrors parts = meter.Measure(SimplifyInParts(mesh_, kWeights, 4000, 5000), 100'000).value();
  EXPECT_LE(parts.distance, 1.6 * whole.distance);
  EXPECT_GE(parts.distance, 0.9 * whole.distance);
  for (size_t a = 0; a < 2; ++a) EXPECT_LE(parts.attributes[a].rms_99, 1.8 * whole.attributes[a].rms_99);
}

TEST_F(SimplifyInPartsTest, DoesNotDependOnTheNumberOfThreads) {
  const AttributedMesh many = SimplifyInParts(mesh_, kWeights, 4000, 1300);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const AttributedMesh one = SimplifyInParts(mesh_, kWeights, 4000, 1300);
  EXPECT_EQ(one.surface.triangles, many.surface.triangles);
  EXPECT_TRUE(one.surface.positions == many.surface.positions);
  for (size_t a = 0; a < 2; ++a) EXPECT_EQ(one.attributes[a].values, many.attributes[a].values);
}

// Each round cuts anew: what cuts hold is not more than a few of so few triangles.
TEST_F(SimplifyInPartsTest, TakesSeveralRoundsToAFewTriangles) {
  const AttributedMesh simplified = SimplifyInParts(mesh_, kWeights, 400, 1300);
  EXPECT_TRUE(CheckAttributedMesh(simplified).ok());
  EXPECT_GE(simplified.surface.triangles.size(), 390u);
  EXPECT_LE(simplified.surface.triangles.size(), 600u);
}

class SimplifyShapeInPartsTest : public ::testing::Test {
 protected:
  double DistanceOf(const TriangleMesh& mesh) const { return meter_.Measure(mesh, SurfaceDistanceOptions::RmsOnly()).value().Rms(); }

  const TriangleMesh mesh_ = shapes::BumpySphere(5);  // 20,480 triangles
  const SurfaceDistanceMeter meter_ = SurfaceDistanceMeter::Create(mesh_).value();
};

TEST_F(SimplifyShapeInPartsTest, ClosedSurfacesStayClosed) {
  for (const uint32_t part_triangles : {20'480u, 5200u, 1300u}) {
    const TriangleMesh simplified = SimplifyInParts(mesh_, 5000, part_triangles);
    EXPECT_GE(simplified.triangles.size(), 4900u) << part_triangles;
    EXPECT_LE(simplified.triangles.size(), 5150u) << part_triangles;
    const StatusOr<Topology> topology = BuildTopology(static_cast<uint32_t>(simplified.positions.size()), simplified.triangles);
    ASSERT_TRUE(topology.ok()) << part_triangles << ": " << topology.status().message();
    EXPECT_EQ(simplified.positions.size(), simplified.triangles.size() / 2 + 2);  // a sphere
    for (uint32_t e = 0; e < topology.value().num_edges(); ++e) ASSERT_FALSE(topology.value().is_border(e));
  }
}

TEST_F(SimplifyShapeInPartsTest, IsNotMuchFartherThanOneRunOverAll) {
  const double whole = DistanceOf(SimplifyInParts(mesh_, 5000, 20'480)), parts = DistanceOf(SimplifyInParts(mesh_, 5000, 1300));
  EXPECT_EQ(SimplifyInParts(mesh_, 5000, 20'480).triangles.size(), SimplificationSequence(mesh_).MeshWith(5000).triangles.size());
  EXPECT_LE(parts, 1.4 * whole);
  EXPECT_GE(parts, 0.9 * whole);
}

TEST_F(SimplifyShapeInPartsTest, DoesNotDependOnTheNumberOfThreads) {
  const TriangleMesh many = SimplifyInParts(mesh_, 1000, 1300);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const TriangleMesh one = SimplifyInParts(mesh_, 1000, 1300);
  EXPECT_EQ(one.triangles, many.triangles);
  EXPECT_TRUE(one.positions == many.positions);
}

}  // namespace
}  // namespace lacerta
