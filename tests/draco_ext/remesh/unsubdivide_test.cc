// Recognition of subdivided meshes: what comes out has the triangles of the input, whatever their order.
#include "remesh/unsubdivide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "common/subdivision.h"
#include "draco_ext/remesh/remeshing.h"
#include "remesh/base_parts.h"
#include "shapes/base_meshes.h"

namespace lacerta {
namespace {

TriangleMesh Split(const TriangleMesh& base, int num_levels) {
  TriangleMesh mesh = base;
  for (int level = 0; level < num_levels; ++level) mesh = shapes::Split(mesh);
  return mesh;
}

// The same surface with vertices, triangles and corners in random order.
TriangleMesh Shuffled(const TriangleMesh& mesh, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<uint32_t> number(mesh.positions.size());
  std::iota(number.begin(), number.end(), 0u);
  std::shuffle(number.begin(), number.end(), random);
  TriangleMesh result = mesh;
  for (size_t v = 0; v < number.size(); ++v) result.positions[number[v]] = mesh.positions[v];
  for (Triangle& t : result.triangles) {
    for (uint32_t& v : t) v = number[v];
    std::rotate(t.begin(), t.begin() + random() % 3, t.end());
  }
  std::shuffle(result.triangles.begin(), result.triangles.end(), random);
  return result;
}

std::vector<Triangle> AsSet(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// Splitting the base gives the input: every vertex once, every triangle with its orientation.
void ExpectSplitsTo(const Unsubdivided& found, const TriangleMesh& mesh) {
  ASSERT_EQ(found.input_vertex.size(), mesh.positions.size());
  std::vector<uint32_t> sorted = found.input_vertex;
  std::sort(sorted.begin(), sorted.end());
  for (uint32_t v = 0; v < sorted.size(); ++v) ASSERT_EQ(sorted[v], v);
  Topology t = BuildTopology(found.num_base_vertices, found.base_triangles).value();
  for (int level = 0; level < found.num_levels; ++level) t = Refine(t);
  for (Triangle& triangle : t.triangles) {
    for (uint32_t& v : triangle) v = found.input_vertex[v];
  }
  EXPECT_EQ(AsSet(t.triangles), AsSet(mesh.triangles));
}

void ExpectFound(const TriangleMesh& mesh, int num_levels, size_t num_base_triangles) {
  for (const TriangleMesh& input : {mesh, Shuffled(mesh, 1), Shuffled(mesh, 2)}) {
    const std::optional<Unsubdivided> found = UndoSubdivision(input);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->num_levels, num_levels);
    EXPECT_EQ(found->base_triangles.size(), num_base_triangles);
    ExpectSplitsTo(*found, input);
  }
}

TEST(UndoSubdivisionTest, FindsTheBaseOfSplitMeshes) {
  for (int levels = 1; levels <= 5; ++levels) {
    SCOPED_TRACE(levels);
    ExpectFound(Split(shapes::Icosahedron(), levels), levels, 20);
    ExpectFound(Split(shapes::Bipyramid(7), levels), levels, 14);
    ExpectFound(Split(shapes::Bipyramid(3), levels), levels, 6);
    ExpectFound(Split(shapes::SingleTriangle(), levels), levels, 1);
    ExpectFound(Split(shapes::Fan(5), levels), levels, 5);
    ExpectFound(Split(shapes::Grid(3), levels), levels, 18);
  }
}

// Three faces around a vertex look the same from each of them, as around a midpoint: the valence tells them apart.
TEST(UndoSubdivisionTest, VerticesOfValenceThreeAreNoMidpoints) {
  ExpectFound(Split(shapes::Tetrahedron(), 3), 3, 4);
  ExpectFound(Split(shapes::Bipyramid(4), 2), 2, 8);
}

TEST(UndoSubdivisionTest, KeepsToTheLevelsAllowed) {
  const TriangleMesh mesh = Split(shapes::Icosahedron(), 4);
  const std::optional<Unsubdivided> two = UndoSubdivision(mesh, 2);
  ASSERT_TRUE(two.has_value());
  EXPECT_EQ(two->num_levels, 2);
  EXPECT_EQ(two->base_triangles.size(), 20u * 16);
  ExpectSplitsTo(*two, mesh);
}

TEST(UndoSubdivisionTest, RegularGridsAreSplitAsOftenAsTheirSidesDivide) {
  ExpectFound(shapes::GridWithBorder(240, 48), 4, 2 * 15 * 3);
  ExpectFound(shapes::GridWithBorder(10, 4), 1, 2 * 5 * 2);
  ExpectFound(shapes::Grid(32), 5, 2);
  EXPECT_FALSE(UndoSubdivision(shapes::GridWithBorder(9, 8)).has_value());
}

// All vertices regular: any of them could be the even ones. Around, three triangles are the fewest.
TEST(UndoSubdivisionTest, ToriWithoutAnyIrregularVertex) {
  ExpectFound(shapes::Torus(48, 24), 3, 2 * 6 * 3);
  ExpectFound(shapes::Torus(20, 12), 2, 2 * 5 * 3);
  EXPECT_FALSE(UndoSubdivision(shapes::Torus(4, 4)).has_value());
  EXPECT_FALSE(UndoSubdivision(shapes::Torus(9, 8)).has_value());
}

// The real base of an irregular surface: all kinds of valences.
TEST(UndoSubdivisionTest, IrregularBases) {
  for (const shapes::NamedShape& shape : lacerta::testing::ClosedShapes()) {
    SCOPED_TRACE(shape.name);
    DecimateOptions options;
    options.target_vertices = 60;
    const CollapseHistory history = lacerta::testing::Decimated(shape.mesh, options);
    const BaseDomain domain(history, history.num_collapses());
    const TriangleMesh base = {lacerta::testing::BasePositions(domain, shape.mesh), domain.triangles()};
    if (UndoSubdivision(base).has_value()) continue;  // a square plate can end up as a split one
    for (int levels = 1; levels <= 3; ++levels) ExpectFound(Split(base, levels), levels, base.triangles.size());
  }
}

TEST(UndoSubdivisionTest, ComponentsAgreeOnTheLevelsOfTheLeastDivisible) {
  const TriangleMesh three = Together(Split(shapes::Icosahedron(), 3), Together(shapes::Torus(24, 24), Split(shapes::Fan(6), 2)));
  ExpectFound(three, 2, 20 * 4 + 2 * 6 * 6 + 6);
  EXPECT_FALSE(UndoSubdivision(Together(Split(shapes::Icosahedron(), 3), shapes::Tetrahedron())).has_value());
}

TEST(UndoSubdivisionTest, OneChangeAnywhereIsEnoughToRefuse) {
  for (const TriangleMesh& mesh : {Split(shapes::Icosahedron(), 4), shapes::Torus(48, 24), shapes::GridWithBorder(48, 32)}) {
    ASSERT_TRUE(UndoSubdivision(mesh).has_value());
    const Topology t = shapes::TopologyOf(mesh);
    for (uint32_t edge = 5; edge < t.num_edges(); edge += t.num_edges() / 7) {
      if (t.is_border(edge)) continue;
      const TriangleMesh flipped = shapes::WithEdgeFlipped(mesh, edge);
      ASSERT_TRUE(BuildTopology(t.num_vertices, flipped.triangles).ok());
      EXPECT_FALSE(UndoSubdivision(flipped).has_value()) << edge;
    }
    for (size_t f = 0; f < mesh.triangles.size(); f += mesh.triangles.size() / 7) {
      TriangleMesh missing = mesh;
      missing.triangles.erase(missing.triangles.begin() + static_cast<std::ptrdiff_t>(f));
      EXPECT_FALSE(UndoSubdivision(missing).has_value()) << f;
      const Triangle whole = mesh.triangles[f];
      const auto center = static_cast<uint32_t>(mesh.positions.size());
      TriangleMesh with_vertex = mesh;
      with_vertex.positions.push_back(mesh.positions[whole[0]]);
      with_vertex.triangles[f][2] = center;
      with_vertex.triangles.push_back({whole[1], whole[2], center});
      with_vertex.triangles.push_back({whole[2], whole[0], center});
      EXPECT_FALSE(UndoSubdivision(with_vertex).has_value()) << f;
    }
  }
}

TEST(UndoSubdivisionTest, RefusesFourHolesWhereTheNumberOfFacesStillDivides) {
  TriangleMesh mesh = shapes::GridWithBorder(48, 32);
  for (const std::ptrdiff_t f : {2000, 1500, 1000, 500}) mesh.triangles.erase(mesh.triangles.begin() + f);
  EXPECT_FALSE(UndoSubdivision(mesh).has_value());
}

TEST(UndoSubdivisionTest, RefusesWhatIsNoManifoldOrHasIsolatedVertices) {
  TriangleMesh isolated = Split(shapes::Icosahedron(), 2);
  isolated.positions.push_back({0, 0, 0});
  EXPECT_FALSE(UndoSubdivision(isolated).has_value());
  TriangleMesh misoriented = Split(shapes::Icosahedron(), 2);
  std::swap(misoriented.triangles[7][0], misoriented.triangles[7][1]);
  EXPECT_FALSE(UndoSubdivision(misoriented).has_value());
  TriangleMesh doubled = Split(shapes::Icosahedron(), 2);
  doubled.triangles.insert(doubled.triangles.end(), doubled.triangles.begin(), doubled.triangles.begin() + 4);
  EXPECT_FALSE(UndoSubdivision(doubled).has_value());
  TriangleMesh out_of_range = Split(shapes::Icosahedron(), 1);
  out_of_range.triangles[3][1] = 4'000'000;
  EXPECT_FALSE(UndoSubdivision(out_of_range).has_value());
  EXPECT_FALSE(UndoSubdivision(TriangleMesh()).has_value());
}

TEST(UndoSubdivisionTest, RefusesScans) {
  int present = 0;
  for (const char* name : {"horse.ply", "skull.ply", "bunny_closed.ply", "camelhead.ply"}) {
    const std::optional<TriangleMesh> mesh = lacerta::testing::RealMesh(name);
    if (!mesh) continue;
    ++present;
    EXPECT_FALSE(UndoSubdivision(*mesh).has_value()) << name;
  }
  if (present == 0) GTEST_SKIP() << "no real meshes";
}

TEST(ReorderTest, VerticesOfAllLevelsFollowTheBase) {
  for (const TriangleMesh& mesh : {Split(shapes::Bipyramid(5), 3), shapes::GridWithBorder(24, 16), shapes::Torus(24, 12)}) {
    const Unsubdivided found = UndoSubdivision(mesh).value();
    std::mt19937 random(5);
    std::vector<uint32_t> vertex_map(found.num_base_vertices), new_number(found.num_base_vertices);
    std::iota(vertex_map.begin(), vertex_map.end(), 0u);
    std::shuffle(vertex_map.begin(), vertex_map.end(), random);
    for (uint32_t v = 0; v < vertex_map.size(); ++v) new_number[vertex_map[v]] = v;
    std::vector<Triangle> triangles = found.base_triangles;
    for (Triangle& t : triangles) {
      for (uint32_t& v : t) v = new_number[v];
      std::rotate(t.begin(), t.begin() + random() % 3, t.end());
    }
    std::shuffle(triangles.begin(), triangles.end(), random);
    const Unsubdivided reordered = Reorder(found, vertex_map, triangles);
    EXPECT_EQ(reordered.base_triangles, triangles);
    EXPECT_EQ(reordered.num_levels, found.num_levels);
    for (uint32_t v = 0; v < vertex_map.size(); ++v) EXPECT_EQ(reordered.input_vertex[v], found.input_vertex[vertex_map[v]]);
    EXPECT_NE(reordered.input_vertex, found.input_vertex);
    ExpectSplitsTo(reordered, mesh);
  }
}

}  // namespace
}  // namespace lacerta
