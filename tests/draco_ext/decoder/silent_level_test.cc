#include "decoder/silent_level.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "shapes/base_meshes.h"

namespace lacerta {
namespace {

struct Case {
  std::string name;
  Topology topology;
  std::vector<Vec3f> positions;  // #V
};

// Closed shapes of all valences, shapes with borders, and the same with creases and corners at random.
std::vector<Case> Cases() {
  const std::vector<std::pair<std::string, TriangleMesh>> shapes = {
      {"Pillow", shapes::Pillow()},         {"Tetrahedron", shapes::Tetrahedron()},       {"Octahedron", shapes::Bipyramid(4)}, {"Icosahedron", shapes::Icosahedron()},
      {"Bipyramid40", shapes::Bipyramid(40)}, {"Bipyramid300", shapes::Bipyramid(300)}, {"Torus", shapes::Torus(5, 7)},         {"SingleTriangle", shapes::SingleTriangle()},
      {"Fan7", shapes::Fan(7)},             {"Grid", shapes::Grid(5)}};
  std::mt19937 random(1);
  std::vector<Case> cases;
  for (const auto& [name, mesh] : shapes) {
    const Topology plain = shapes::TopologyOf(mesh);
    cases.push_back({name, plain, mesh.positions});
    for (const uint32_t one_in : {2u, 8u}) {
      BaseTags tags;
      for (uint32_t e = 0; e < plain.num_edges(); ++e) tags.crease.push_back(!plain.is_border(e) && random() % one_in == 0);
      for (uint32_t v = 0; v < plain.num_vertices; ++v) tags.corner.push_back(random() % 4 == 0);
      const StatusOr<Topology> tagged = BuildTopology(plain.num_vertices, mesh.triangles, tags);
      if (!tagged.ok()) {  // not every corner lies on a curve
        ADD_FAILURE() << name << ": " << tagged.status().message();
        continue;
      }
      cases.push_back({name + ", one edge in " + std::to_string(one_in) + " a crease", tagged.value(), mesh.positions});
    }
  }
  return cases;
}

TEST(PredictRefinedMidpointsTest, IsThePredictionOnRefinedTablesBitByBit) {
  std::mt19937 random(2);
  std::normal_distribution<float> noise(0.0f, 0.1f);
  for (Case& c : Cases()) {
    for (int level = 0; level < 3; ++level) {
      SCOPED_TRACE(c.name + ", level " + std::to_string(level));
      const StencilTable table(c.topology);
      PredictMidpoints(c.topology, table, &c.positions);
      for (Vec3f& p : c.positions) p += Vec3f{noise(random), noise(random), noise(random)};
      const Topology finer = Refine(c.topology);
      std::vector<Vec3f> expected = c.positions, found = c.positions;
      PredictMidpoints(finer, table, &expected);
      PredictRefinedMidpoints(c.topology, table, &found);
      ASSERT_EQ(found.size(), expected.size());
      size_t num_different = 0;
      for (size_t v = 0; v < found.size(); ++v) num_different += std::memcmp(&found[v], &expected[v], sizeof(Vec3f)) != 0;
      EXPECT_EQ(num_different, 0u) << "of " << found.size();
      c.topology = finer;
    }
  }
}

TEST(RefineTrianglesTwiceTest, AreThoseOfTheLevelAfterTheNext) {
  for (const Case& c : Cases()) EXPECT_EQ(RefineTrianglesTwice(c.topology), Refine(Refine(c.topology)).triangles) << c.name;
}

}  // namespace
}  // namespace lacerta
