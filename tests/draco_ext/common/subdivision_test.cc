#include "common/subdivision.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "shapes/base_meshes.h"

namespace lacerta {
namespace {

using ::testing::HasSubstr;

struct NamedMesh {
  const char* name;
  TriangleMesh mesh;
  int euler_characteristic;
  bool closed;
};

std::vector<NamedMesh> AllShapes() {
  return {{"Pillow", shapes::Pillow(), 2, true},
          {"Tetrahedron", shapes::Tetrahedron(), 2, true},
          {"Octahedron", shapes::Bipyramid(4), 2, true},
          {"Icosahedron", shapes::Icosahedron(), 2, true},
          {"Bipyramid300", shapes::Bipyramid(300), 2, true},
          {"Torus", shapes::Torus(3, 4), 0, true},
          {"SingleTriangle", shapes::SingleTriangle(), 1, false},
          {"Fan7", shapes::Fan(7), 1, false},
          {"Grid", shapes::Grid(3), 1, false}};
}

int EulerCharacteristic(const Topology& t) {
  return static_cast<int>(t.num_vertices) - static_cast<int>(t.num_edges()) + static_cast<int>(t.num_faces());
}

uint32_t CountBorderEdges(const Topology& t) {
  return static_cast<uint32_t>(
      std::count_if(t.edge_faces.begin(), t.edge_faces.end(), [](const auto& f) { return f[1] == kNone; }));
}

// Every table agrees with every other one.
void ExpectConsistent(const Topology& t) {
  ASSERT_EQ(t.face_edges.size(), t.triangles.size());
  ASSERT_EQ(t.edge_faces.size(), t.edges.size());
  ASSERT_EQ(t.valence.size(), t.num_vertices);
  ASSERT_EQ(t.role.size(), t.num_vertices);
  std::vector<uint32_t> valence(t.num_vertices), border(t.num_vertices), uses(t.num_edges());
  for (uint32_t f = 0; f < t.num_faces(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const uint32_t e = t.face_edges[f][k];
      ASSERT_LT(e, t.num_edges());
      ++uses[e];
      const uint32_t a = t.triangles[f][(k + 1) % 3], b = t.triangles[f][(k + 2) % 3];
      EXPECT_EQ(std::minmax(a, b), std::minmax(t.edges[e][0], t.edges[e][1]));
      EXPECT_TRUE(t.edge_faces[e][0] == f || t.edge_faces[e][1] == f);
      EXPECT_EQ(EdgeCorner(t, f, e), k);
      EXPECT_EQ(OppositeVertex(t, f, e), t.triangles[f][k]);
      const uint32_t across = FaceAcross(t, f, e);
      if (across != kNone) {
        EXPECT_EQ(FaceAcross(t, across, e), f);
      }
    }
  }
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    EXPECT_NE(t.edge_faces[e][0], kNone);
    const bool on_border = t.edge_faces[e][1] == kNone;
    EXPECT_EQ(uses[e], on_border ? 1u : 2u);
    for (const uint32_t v : t.edges[e]) {
      ++valence[v];
      border[v] |= on_border ? 1 : 0;
    }
  }
  for (uint32_t v = 0; v < t.num_vertices; ++v) {
    EXPECT_EQ(t.valence[v], valence[v]);
    EXPECT_EQ(t.role[v] != CurveRole::kSmooth, border[v] != 0);
  }
}

TEST(BuildTopologyTest, NumbersEdgesByFirstAppearanceOverFacesThenCorners) {
  const Topology t = shapes::TopologyOf(shapes::Tetrahedron());  // (0,1,2) (0,3,1) (0,2,3) (1,3,2)
  const std::vector<std::array<uint32_t, 2>> edges = {{1, 2}, {2, 0}, {0, 1}, {3, 1}, {0, 3}, {2, 3}};
  EXPECT_EQ(t.edges, edges);
  const std::vector<std::array<uint32_t, 3>> face_edges = {{0, 1, 2}, {3, 2, 4}, {5, 4, 1}, {5, 0, 3}};
  EXPECT_EQ(t.face_edges, face_edges);
  const std::vector<std::array<uint32_t, 2>> edge_faces = {{0, 3}, {0, 2}, {0, 1}, {1, 3}, {1, 2}, {2, 3}};
  EXPECT_EQ(t.edge_faces, edge_faces);
  EXPECT_EQ(t.valence, (std::vector<uint16_t>{3, 3, 3, 3}));
}

TEST(BuildTopologyTest, TablesAgreeOnAllShapes) {
  for (const NamedMesh& shape : AllShapes()) {
    SCOPED_TRACE(shape.name);
    ExpectConsistent(shapes::TopologyOf(shape.mesh));
  }
}

TEST(BuildTopologyTest, EmptyMeshIsEmpty) {
  const StatusOr<Topology> t = BuildTopology(0, {});
  ASSERT_TRUE(t.ok());
  EXPECT_EQ(t.value().num_edges(), 0u);
  EXPECT_EQ(Refine(t.value()).num_faces(), 0u);
}

struct Defect {
  const char* name;
  uint32_t num_vertices;
  std::vector<Triangle> triangles;
  const char* message;
};

TEST(BuildTopologyTest, NamesEachDefect) {
  const std::vector<Defect> defects = {
      {"out of range", 3, {{0, 1, 3}}, "triangle 0 refers to vertex 3 of 3"},
      {"no vertices", 0, {{0, 1, 2}}, "triangle 0 refers to vertex 0 of 0"},
      {"degenerate", 3, {{0, 1, 1}}, "triangle 0 is degenerate"},
      {"three faces at an edge", 5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, "more than two faces meet at edge (0, 1)"},
      {"misoriented", 4, {{0, 1, 2}, {0, 1, 3}}, "opposite orientation meet at edge (0, 1)"},
      {"same face twice", 3, {{0, 1, 2}, {1, 2, 0}}, "opposite orientation meet at edge"},
      {"pinched border", 5, {{0, 1, 2}, {0, 3, 4}}, "vertex 0 joins several fans"},
      {"closed and open fan",
       6,
       {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}, {0, 4, 5}},
       "vertex 0 joins several fans"},
      {"two closed fans",
       7,
       {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}, {0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}},
       "vertex 0 joins several fans"},
  };
  for (const Defect& defect : defects) {
    SCOPED_TRACE(defect.name);
    const StatusOr<Topology> t = BuildTopology(defect.num_vertices, defect.triangles);
    ASSERT_FALSE(t.ok());
    EXPECT_EQ(t.status().code(), StatusCode::kInvalidData);
    EXPECT_THAT(t.status().message(), HasSubstr(defect.message));
  }
}

TEST(BuildTopologyTest, RefusesMoreThan65535EdgesAtAVertexAndTakesJustAsMany) {
  const StatusOr<Topology> widest = BuildTopology(65535 + 2, shapes::Bipyramid(65535).triangles);
  ASSERT_TRUE(widest.ok());
  EXPECT_EQ(widest.value().valence[65535], 65535);
  const StatusOr<Topology> too_wide = BuildTopology(65536 + 2, shapes::Bipyramid(65536).triangles);
  ASSERT_FALSE(too_wide.ok());
  EXPECT_THAT(too_wide.status().message(), HasSubstr("vertex 65536 has more than 65,535 edges"));
}

TEST(RefineTest, NumbersAsDocumented) {
  const Topology c = shapes::TopologyOf(shapes::Grid(2));
  const Topology t = Refine(c);
  const uint32_t V = c.num_vertices, E = c.num_edges(), F = c.num_faces();
  ASSERT_EQ(t.num_vertices, V + E);
  ASSERT_EQ(t.num_edges(), 2 * E + 3 * F);
  ASSERT_EQ(t.num_faces(), 4 * F);
  for (uint32_t e = 0; e < E; ++e) {
    for (uint32_t end = 0; end < 2; ++end) {
      const std::set<uint32_t> ends(t.edges[2 * e + end].begin(), t.edges[2 * e + end].end());
      EXPECT_EQ(ends, (std::set<uint32_t>{c.edges[e][end], V + e}));
    }
  }
  for (uint32_t f = 0; f < F; ++f) {
    const std::array<uint32_t, 3> mid = {V + c.face_edges[f][0], V + c.face_edges[f][1], V + c.face_edges[f][2]};
    EXPECT_EQ(t.triangles[4 * f + 3], (Triangle{mid[0], mid[1], mid[2]}));
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      EXPECT_EQ(t.triangles[4 * f + k], (Triangle{c.triangles[f][k], mid[k2], mid[k1]}));
      const std::set<uint32_t> ends(t.edges[2 * E + 3 * f + k].begin(), t.edges[2 * E + 3 * f + k].end());
      EXPECT_EQ(ends, (std::set<uint32_t>{mid[k1], mid[k2]}));
    }
  }
}

TEST(RefineTest, KeepsTablesEulerCharacteristicAndBordersOverLevels) {
  for (const NamedMesh& shape : AllShapes()) {
    SCOPED_TRACE(shape.name);
    Topology t = shapes::TopologyOf(shape.mesh);
    const LevelCounts base = {t.num_vertices, t.num_edges(), t.num_faces()};
    uint32_t border_edges = CountBorderEdges(t);
    EXPECT_EQ(border_edges == 0, shape.closed);
    for (int level = 1; level <= 3; ++level) {
      SCOPED_TRACE(level);
      t = Refine(t);
      ExpectConsistent(t);
      EXPECT_EQ(EulerCharacteristic(t), shape.euler_characteristic);
      EXPECT_EQ(CountBorderEdges(t), border_edges *= 2);
      const LevelCounts counts = SubdividedCounts(base, level);
      EXPECT_EQ(counts.vertices, t.num_vertices);
      EXPECT_EQ(counts.edges, t.num_edges());
      EXPECT_EQ(counts.faces, t.num_faces());
    }
  }
}

TEST(RefineTest, AgreesWithBuildTopologyUpToEdgeNumbers) {
  for (const NamedMesh& shape : AllShapes()) {
    if (std::string(shape.name) == "Pillow") continue;  // refined, two of its edges join the same vertices
    SCOPED_TRACE(shape.name);
    const Topology refined = Refine(shapes::TopologyOf(shape.mesh));
    const StatusOr<Topology> built = BuildTopology(refined.num_vertices, refined.triangles);
    ASSERT_TRUE(built.ok()) << built.status().message();
    EXPECT_EQ(built.value().valence, refined.valence);
    EXPECT_EQ(built.value().role, refined.role);
    ASSERT_EQ(built.value().num_edges(), refined.num_edges());
    for (uint32_t f = 0; f < refined.num_faces(); ++f) {
      for (int k = 0; k < 3; ++k) {
        const uint32_t a = refined.face_edges[f][k], b = built.value().face_edges[f][k];
        EXPECT_EQ(std::minmax(refined.edges[a][0], refined.edges[a][1]),
                  std::minmax(built.value().edges[b][0], built.value().edges[b][1]));
        EXPECT_EQ(FaceAcross(refined, f, a), FaceAcross(built.value(), f, b));
        EXPECT_EQ(refined.on_curve[a], built.value().on_curve[b]);
      }
    }
  }
}

TEST(BuildTopologyTest, NamesTagsOfTheWrongShape) {
  const std::vector<Triangle> triangles = shapes::Tetrahedron().triangles;
  const auto message = [&](const BaseTags& tags) { return BuildTopology(4, triangles, tags).status().message(); };
  EXPECT_THAT(message({{0, 0, 1}, {}, {}, {}}), HasSubstr("still triangles are not as many as the triangles"));
  EXPECT_THAT(message({{}, {1, 0, 0, 0, 0}, {}, {}}), HasSubstr("creases are not as many as the edges"));
  EXPECT_THAT(message({{0, 0, 0, 1}, {}, {0, 0, 1}, {}}), HasSubstr("corners are not as many as the vertices"));
  EXPECT_THAT(message({{}, {}, {}, {0, 1, 2, 3, 4}}), HasSubstr("joined vertices are not as many as the vertices"));
  EXPECT_TRUE(BuildTopology(4, triangles, {{0, 0, 0, 1}, {1, 0, 0, 0, 0, 0}, {0, 0, 1, 0}, {0, 1, 2, 3}}).ok());
}

TEST(BuildTopologyTest, StillTrianglesNeedIndicesInRangeAndNothingElse) {
  const auto build = [](const Triangle& still) { return BuildTopology(3, {{{0, 1, 2}}, still, still}, {{0, 1, 1}, {}, {}, {}}); };
  EXPECT_TRUE(build({{0, 1, 2}}).ok());
  EXPECT_TRUE(build({{0, 0, 0}}).ok());
  EXPECT_EQ(build({{2, 1, 0}}).value().num_faces(), 1u);
  EXPECT_THAT(build({{0, 1, 3}}).status().message(), HasSubstr("triangle 1 refers to vertex 3 of 3"));
}

TEST(RefineTest, HandsCurvesDown) {
  // The middle row of a grid is a crease; vertex (c, r) is 5 r + c. One corner of the border is kept, one point of the crease too.
  const TriangleMesh grid = shapes::Grid(4);
  BaseTags tags;
  for (const auto& [a, b] : shapes::TopologyOf(grid).edges) tags.crease.push_back(a / 5 == 2 && b / 5 == 2);
  tags.corner.assign(25, 0);
  tags.corner[0] = tags.corner[12] = tags.corner[6] = 1;  // 6 is on no curve: no corner
  Topology t = BuildTopology(25, grid.triangles, tags).value();
  const std::set<uint32_t> corners = {0, 10, 12, 14};
  for (int level = 0; level <= 3; ++level) {
    SCOPED_TRACE(level);
    std::vector<int> num_curves(t.num_vertices, 0);
    size_t on_curve = 0;
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      on_curve += t.on_curve[e];
      for (const uint32_t v : t.edges[e]) num_curves[v] += t.on_curve[e];
      if (t.is_border(e)) {
        EXPECT_EQ(t.on_curve[e], 1);
      }
    }
    EXPECT_EQ(on_curve, size_t{16 + 4} << level);
    for (uint32_t v = 0; v < t.num_vertices; ++v) {
      const CurveRole expected = corners.count(v) != 0 ? CurveRole::kCorner : num_curves[v] > 0 ? CurveRole::kCurve : CurveRole::kSmooth;
      EXPECT_EQ(t.role[v], expected) << v;
      if (expected == CurveRole::kCurve) {
        EXPECT_EQ(num_curves[v], 2) << v;
      }
    }
    t = Refine(t);
  }
}

TEST(RefineTest, CopiesFollowTheirMastersHalfByHalf) {
  // Three sheets at an edge, vertices 2 s and 2 s + 1 of sheet s there; the last sheet runs the other way.
  const std::vector<Triangle> triangles = {{{0, 1, 6}}, {{2, 3, 7}}, {{5, 4, 8}}};
  const std::vector<uint32_t> joined = {0, 1, 0, 1, 0, 1, 6, 7, 8};
  Topology t = BuildTopology(9, triangles, {{}, {}, {}, joined}).value();
  std::vector<uint32_t> place = joined;  // of every vertex: the first one at the same position
  size_t num_copies = 2;
  for (int level = 0; level <= 3; ++level, num_copies *= 2) {
    SCOPED_TRACE(level);
    ASSERT_EQ(t.master.size(), t.num_edges());
    size_t copies = 0;
    std::vector<uint32_t> finer_place = place;
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      finer_place.push_back(t.num_vertices + (t.is_copy(e) ? t.master[e] : e));
      if (!t.is_copy(e)) continue;
      ++copies;
      const uint32_t m = t.master[e];
      EXPECT_LT(m, e);
      EXPECT_FALSE(t.is_copy(m));
      EXPECT_TRUE(t.is_border(e) && t.is_border(m));
      for (const int end : {0, 1}) EXPECT_EQ(place[t.edges[e][end]], place[t.edges[m][end]]);
    }
    EXPECT_EQ(copies, num_copies);
    place = finer_place;
    t = Refine(t);
  }
}

TEST(SubdividedCountsTest, NeverOverflowsIntoASmallCount) {
  for (const int levels : {30, 31, 32, 33, 64, std::numeric_limits<int>::max()}) {
    SCOPED_TRACE(levels);
    const LevelCounts small = SubdividedCounts({4, 6, 4}, levels);
    EXPECT_GE(small.faces, uint64_t{1} << 58);
    EXPECT_GE(small.vertices, uint64_t{1} << 56);
    EXPECT_GE(small.edges, uint64_t{1} << 58);
    const uint64_t most = (uint64_t{1} << 33) - 1;
    const LevelCounts large = SubdividedCounts({most, most, most}, levels);
    EXPECT_GE(large.faces, uint64_t{1} << 58);
    EXPECT_GE(large.vertices, uint64_t{1} << 56);
    EXPECT_GE(large.edges, uint64_t{1} << 58);
  }
  const LevelCounts none = SubdividedCounts({0, 0, 0}, std::numeric_limits<int>::max());
  EXPECT_EQ(none.vertices + none.edges + none.faces, 0u);
}

TEST(SubdivisionTest, OppositePairsGiveOneVertexForTheOther) {
  for (const TriangleMesh& mesh : {shapes::Icosahedron(), shapes::Fan(6), shapes::Pillow()}) {
    const Topology t = Refine(shapes::TopologyOf(mesh));
    const std::vector<uint32_t> pairs = OppositePairs(t);
    ASSERT_EQ(pairs.size(), t.num_edges());
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      const auto& [f, g] = t.edge_faces[e];
      EXPECT_EQ(pairs[e] ^ OppositeVertex(t, f, e), g == kNone ? 0 : OppositeVertex(t, g, e));
    }
  }
}

}  // namespace
}  // namespace lacerta
