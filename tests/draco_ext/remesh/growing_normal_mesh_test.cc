#include "remesh/growing_normal_mesh.h"

#include <gtest/gtest.h>

#include <vector>

#include "draco_ext/remesh/remeshing.h"
#include "remesh/piercing.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

TEST(GrowingNormalMesh, IsWhatPiercingMakesOfAsManyLevels) {
  for (const TriangleMesh& input : {shapes::BumpySphere(4), shapes::TwoHoledPlate(6)}) {
    const CollapseHistory history = testing::Decimated(input, {40, 12, 0.2});
    const InputSurface surface(input, testing::TopologyOf(input));
    const BaseDomain domain(history, history.num_collapses());
    const std::vector<Vec3f> base = testing::BasePositions(domain, input);
    GrowingNormalMesh growing(surface, domain, base, PiercingOptions());
    for (int level = 0; level <= 3; ++level) {
      SCOPED_TRACE(level);
      PiercingOptions options;
      options.num_levels = level;
      std::vector<DomainPoint> parameters;
      const NormalMesh expected = Pierce(surface, domain, base, options, &parameters);
      EXPECT_EQ(growing.num_levels(), level);
      EXPECT_EQ(growing.mesh().mesh.num_levels, level);
      EXPECT_EQ(growing.mesh().mesh.positions, expected.mesh.positions);
      EXPECT_EQ(growing.mesh().surface_normals, expected.surface_normals);
      EXPECT_EQ(growing.mesh().piercing, expected.piercing);
      ASSERT_EQ(growing.Parameters().size(), expected.mesh.positions.size());
      for (size_t v = 0; v < parameters.size(); ++v) EXPECT_EQ(growing.Parameters()[v].face, parameters[v].face);
      growing.AddLevel();
    }
    // Every level has as many vertices more as the one before has edges.
    const Topology topology = domain.topology();
    const LevelCounts counts = SubdividedCounts({topology.num_vertices, topology.num_edges(), topology.num_faces()}, 4);
    EXPECT_EQ(growing.mesh().mesh.positions.size(), counts.vertices);
  }
}

}  // namespace
}  // namespace lacerta
