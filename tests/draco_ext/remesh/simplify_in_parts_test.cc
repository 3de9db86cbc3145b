#include "remesh/simplify_in_parts.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "remesh/surface_errors.h"
#include "remesh/wedge_mesh.h"
#include "shapes/attributed_shapes.h"

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
    const AttributedMesh simplified = SimplifyInParts(mesh_, kWeights, 0.2, part_triangles);
    EXPECT_TRUE(CheckAttributedMesh(simplified).ok());
    EXPECT_GE(simplified.surface.triangles.size(), 3900u) << part_triangles;
    EXPECT_LE(simplified.surface.triangles.size(), 4100u) << part_triangles;
  }
}

// No crack and no seam comes of a cut: open borders and seams are those of the input, with fewer edges.
TEST_F(SimplifyInPartsTest, CutsCloseAgain) {
  const AttributedMesh simplified = SimplifyInParts(mesh_, kWeights, 0.2, 1300);
  const WedgeMesh wedges = MakeWedgeMesh(simplified);
  EXPECT_EQ(wedges.components.size(), MakeWedgeMesh(mesh_).components.size());
  EXPECT_EQ(wedges.components[0].borders, MakeWedgeMesh(mesh_).components[0].borders);
  EXPECT_LE(NumOpenEdges(simplified), NumOpenEdges(mesh_));
  EXPECT_GE(NumOpenEdges(simplified), NumOpenEdges(mesh_) / 8);
  EXPECT_EQ(wedges.num_vertices(), simplified.surface.positions.size());  // nothing was cut to be a manifold
}

TEST_F(SimplifyInPartsTest, IsNotMuchFartherThanOneRunOverAll) {
  const SurfaceErrorMeter meter = SurfaceErrorMeter::Create(mesh_).value();
  const SurfaceErrors whole = meter.Measure(SimplifyInParts(mesh_, kWeights, 0.2, 20'000), 100'000).value();
  const SurfaceErrors parts = meter.Measure(SimplifyInParts(mesh_, kWeights, 0.2, 5000), 100'000).value();
  EXPECT_LE(parts.distance, 1.6 * whole.distance);
  EXPECT_GE(parts.distance, 0.9 * whole.distance);
  for (size_t a = 0; a < 2; ++a) EXPECT_LE(parts.attributes[a].rms_99, 1.8 * whole.attributes[a].rms_99);
}

TEST_F(SimplifyInPartsTest, DoesNotDependOnTheNumberOfThreads) {
  const AttributedMesh many = SimplifyInParts(mesh_, kWeights, 0.2, 1300);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const AttributedMesh one = SimplifyInParts(mesh_, kWeights, 0.2, 1300);
  EXPECT_EQ(one.surface.triangles, many.surface.triangles);
  EXPECT_TRUE(one.surface.positions == many.surface.positions);
  for (size_t a = 0; a < 2; ++a) EXPECT_EQ(one.attributes[a].values, many.attributes[a].values);
}

}  // namespace
}  // namespace lacerta
