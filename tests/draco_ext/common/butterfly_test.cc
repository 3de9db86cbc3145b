#include "common/butterfly.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <vector>

#include "shapes/base_meshes.h"

namespace lacerta {
namespace {

// Total weight of each vertex in the stencil of `edge`.
std::map<uint32_t, float> StencilOf(const Topology& t, uint32_t edge) {
  std::map<uint32_t, float> weights;
  VisitStencil(t, StencilTable(t), edge, [&](uint32_t v, float w) { weights[v] += w; });
  return weights;
}

uint32_t FindEdge(const Topology& t, uint32_t a, uint32_t b) {
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    if ((t.edges[e][0] == a && t.edges[e][1] == b) || (t.edges[e][0] == b && t.edges[e][1] == a)) return e;
  }
  ADD_FAILURE() << "no edge " << a << " " << b;
  return 0;
}

void ExpectNear(const Vec3f& a, const Vec3f& b, float tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(ExtraordinaryStencilTest, HasZorinsValues) {
  const auto expect = [](int valence, const std::vector<double>& values) {
    const std::vector<float> weights = ExtraordinaryStencil(valence);
    ASSERT_EQ(weights.size(), values.size());
    for (size_t j = 0; j < values.size(); ++j) EXPECT_NEAR(weights[j], values[j], 1e-7) << valence << " " << j;
  };
  expect(3, {5.0 / 12, -1.0 / 12, -1.0 / 12});
  expect(4, {0.375, 0.0, -0.125, 0.0});
  expect(5, {0.35, 0.03090170, -0.08090170, -0.08090170, 0.03090170});  // cos 72 = (sqrt 5 - 1) / 4
  expect(6, {7.0 / 24, 1.0 / 12, -1.0 / 12, -1.0 / 24, -1.0 / 12, 1.0 / 12});
  expect(7, {0.25, 0.10888991, -0.06042934, -0.04846057, -0.04846057, -0.06042934, 0.10888991});
}

TEST(ExtraordinaryStencilTest, RingSumsToAQuarterAndIsSymmetric) {
  for (const int valence : {2, 3, 4, 5, 6, 7, 8, 9, 12, 31, 100, kMaxStencilValence}) {
    SCOPED_TRACE(valence);
    const std::vector<float> weights = ExtraordinaryStencil(valence);
    EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 0.25, 1e-6);
    for (int j = 1; j < valence; ++j) EXPECT_NEAR(weights[j], weights[valence - j], 1e-7);
  }
}

TEST(VisitStencilTest, WeightsSumToOneOnEveryEdgeOfEveryShape) {
  for (const TriangleMesh& mesh : {shapes::Pillow(), shapes::Tetrahedron(), shapes::Bipyramid(4), shapes::Bipyramid(40),
                                   shapes::Icosahedron(), shapes::Torus(3, 3), shapes::SingleTriangle(), shapes::Fan(3),
                                   shapes::Fan(6), shapes::Fan(9), shapes::Grid(1), shapes::Grid(4)}) {
    Topology t = shapes::TopologyOf(mesh);
    for (int level = 0; level < 2; ++level) {
      const StencilTable table(t);
      for (uint32_t e = 0; e < t.num_edges(); ++e) {
        double sum = 0.0;
        VisitStencil(t, table, e, [&](uint32_t v, float w) {
          EXPECT_LT(v, t.num_vertices);
          sum += w;
        });
        EXPECT_NEAR(sum, 1.0, 1e-6) << "edge " << e << " of " << t.num_edges();
      }
      t = Refine(t);
    }
  }
}

TEST(VisitStencilTest, RegularEdgeHasTheEightPointRule) {
  // Vertex (c, r) of a 6 x 6 torus is 6 r + c; the edge from (2, 2) to (3, 2), its faces up right and down left.
  const Topology t = shapes::TopologyOf(shapes::Torus(6, 6));
  const auto id = [](uint32_t c, uint32_t r) { return 6 * r + c; };
  const std::map<uint32_t, float> expected = {{id(2, 2), 0.5f},     {id(3, 2), 0.5f},     {id(3, 3), 0.125f},
                                              {id(2, 1), 0.125f},   {id(2, 3), -0.0625f}, {id(4, 3), -0.0625f},
                                              {id(1, 1), -0.0625f}, {id(3, 1), -0.0625f}};
  EXPECT_EQ(StencilOf(t, FindEdge(t, id(2, 2), id(3, 2))), expected);
}

TEST(VisitStencilTest, TwoExtraordinaryEndsAreAveraged) {
  const Topology t = shapes::TopologyOf(shapes::Tetrahedron());
  const std::map<uint32_t, float> weights = StencilOf(t, FindEdge(t, 0, 1));
  EXPECT_NEAR(weights.at(0), 0.5 * (0.75 + 5.0 / 12), 1e-7);
  EXPECT_NEAR(weights.at(1), 0.5 * (0.75 + 5.0 / 12), 1e-7);
  EXPECT_NEAR(weights.at(2), -1.0 / 12, 1e-7);
  EXPECT_NEAR(weights.at(3), -1.0 / 12, 1e-7);
}

TEST(VisitStencilTest, OneExtraordinaryEndUsesItsRingAlone) {
  Topology t = shapes::TopologyOf(shapes::Icosahedron());
  const uint32_t num_base = t.num_vertices;
  t = Refine(t);                          // now every base vertex has five regular neighbors
  const uint32_t e = t.face_edges[0][1];  // at corner 0 of face 0, base vertex 0
  const uint32_t other = t.edges[e][0] == 0 ? t.edges[e][1] : t.edges[e][0];
  ASSERT_GE(other, num_base);
  const std::map<uint32_t, float> weights = StencilOf(t, e);
  ASSERT_EQ(weights.size(), 6u);
  EXPECT_FLOAT_EQ(weights.at(0), 0.75f);
  EXPECT_NEAR(weights.at(other), 0.35, 1e-7);
}

TEST(VisitStencilTest, BorderEdgeUsesTheBorderCurveAlone) {
  const Topology t = shapes::TopologyOf(shapes::Grid(4));  // vertex (c, r) is 5 r + c
  EXPECT_EQ(StencilOf(t, FindEdge(t, 1, 2)),
            (std::map<uint32_t, float>{{0, -0.0625f}, {1, 0.5625f}, {2, 0.5625f}, {3, -0.0625f}}));
  // At a corner the curve goes round it.
  EXPECT_EQ(StencilOf(t, FindEdge(t, 0, 1)),
            (std::map<uint32_t, float>{{5, -0.0625f}, {0, 0.5625f}, {1, 0.5625f}, {2, -0.0625f}}));
}

// Grid of 4 x 4 cells whose row r = 2 is a crease; vertex (c, r) is 5 r + c.
Topology CreasedGrid(const std::vector<uint32_t>& corners) {
  const TriangleMesh grid = shapes::Grid(4);
  BaseTags tags;
  for (const auto& [a, b] : shapes::TopologyOf(grid).edges) tags.crease.push_back(a / 5 == 2 && b / 5 == 2);
  tags.corner.assign(25, 0);
  for (const uint32_t v : corners) tags.corner[v] = 1;
  return BuildTopology(25, grid.triangles, tags).value();
}

TEST(VisitStencilTest, CreaseEdgeUsesTheCreaseAlone) {
  const Topology t = CreasedGrid({});
  EXPECT_EQ(StencilOf(t, FindEdge(t, 11, 12)), (std::map<uint32_t, float>{{10, -0.0625f}, {11, 0.5625f}, {12, 0.5625f}, {13, -0.0625f}}));
  // It ends in the border, where three curve edges meet: a corner.
  EXPECT_EQ(StencilOf(t, FindEdge(t, 10, 11)), (std::map<uint32_t, float>{{10, 0.375f}, {11, 0.75f}, {12, -0.125f}}));
}

TEST(VisitStencilTest, CurvesDoNotReachAroundCorners) {
  const Topology t = CreasedGrid({0, 12, 13});
  EXPECT_EQ(StencilOf(t, FindEdge(t, 0, 1)), (std::map<uint32_t, float>{{0, 0.375f}, {1, 0.75f}, {2, -0.125f}}));
  EXPECT_EQ(StencilOf(t, FindEdge(t, 11, 12)), (std::map<uint32_t, float>{{10, -0.125f}, {11, 0.75f}, {12, 0.375f}}));
  EXPECT_EQ(StencilOf(t, FindEdge(t, 12, 13)), (std::map<uint32_t, float>{{12, 0.5f}, {13, 0.5f}}));
}

TEST(VisitStencilTest, StencilsDoNotCrossACrease) {
  const Topology t = CreasedGrid({});
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    const auto row = [&](uint32_t v) { return static_cast<int>(v / 5) - 2; };
    const int side = t.on_curve[e] ? 0 : row(t.edges[e][0]) + row(t.edges[e][1]);
    for (const auto& [v, weight] : StencilOf(t, e)) {
      if (weight == 0) continue;
      if (side > 0) {
        EXPECT_GE(row(v), 0) << e;
      }
      if (side < 0) {
        EXPECT_LE(row(v), 0) << e;
      }
    }
  }
  // The edge from (2, 2) up to (2, 3): what the face to the left would see across the crease is reflected.
  const std::map<uint32_t, float> weights = StencilOf(t, FindEdge(t, 12, 17));
  double sum = 0;
  for (const auto& [v, weight] : weights) sum += weight;
  EXPECT_NEAR(sum, 1.0, 1e-7);
  EXPECT_GE(weights.size(), 6u);
}

TEST(PredictMidpointsTest, AddsUpStencilsInTheirOrder) {
  for (const TriangleMesh& mesh : {shapes::Pillow(), shapes::Bipyramid(4), shapes::Bipyramid(300), shapes::Icosahedron(), shapes::Torus(5, 4),
                                   shapes::SingleTriangle(), shapes::Fan(6), shapes::Grid(4)}) {
    Topology t = shapes::TopologyOf(mesh);
    std::vector<Vec3f> positions = mesh.positions;
    for (int level = 0; level < 3; ++level, t = Refine(t)) {
      const StencilTable table(t);
      const std::vector<Vec3f> midpoints = PredictMidpoints(t, table, positions);
      ASSERT_EQ(midpoints.size(), t.num_edges());
      for (uint32_t e = 0; e < t.num_edges(); ++e) {
        Vec3f sum;
        VisitStencil(t, table, e, [&](uint32_t v, float weight) { sum += positions[v] * weight; });
        ASSERT_EQ(midpoints[e], sum) << "edge " << e << " of " << t.num_edges();  // to the last bit
      }
      std::vector<Vec3f> appended = positions;  // in registers
      PredictMidpoints(t, table, &appended);
      positions.insert(positions.end(), midpoints.begin(), midpoints.end());
      ASSERT_EQ(appended, positions);
    }
  }
}

TEST(PredictMidpointsTest, RoofsKeepTheirRidge) {
  // Two planes that meet in a crease: every edge but those next to the border corners has its middle in its plane.
  const Topology t = CreasedGrid({0, 4, 20, 24});
  TriangleMesh roof = shapes::Grid(4);
  for (Vec3f& p : roof.positions) p.z = -std::fabs(p.y - 2);
  const std::vector<Vec3f> midpoints = PredictMidpoints(t, StencilTable(t), roof.positions);
  int checked = 0;
  for (const Vec3f& p : midpoints) {
    EXPECT_NEAR(p.z, -std::fabs(p.y - 2), 0.13f);  // the border bends under the ridge
    if (p.x > 0 && p.x < 4) {
      EXPECT_NEAR(p.z, -std::fabs(p.y - 2), 1e-6f);
      ++checked;
    }
  }
  EXPECT_GE(checked, 40);
}

TEST(VisitStencilTest, CopiesHaveTheStencilOfTheirMaster) {
  const std::vector<Triangle> triangles = {{{0, 1, 4}}, {{3, 2, 5}}};
  Topology t = BuildTopology(6, triangles, {{}, {}, {}, {0, 1, 0, 1, 4, 5}}).value();
  for (int level = 0; level <= 2; ++level, t = Refine(t)) {
    int copies = 0;
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      if (!t.is_copy(e)) continue;
      EXPECT_EQ(StencilOf(t, e), StencilOf(t, t.master[e]));
      ++copies;
    }
    EXPECT_EQ(copies, 1 << level);
  }
}

TEST(PredictMidpointsTest, SurfacesThatShareABorderPredictTheSamePointsOnIt) {
  // The same border curve, filled by a fan around one vertex and, turned over, by a triangle strip.
  const TriangleMesh fan = shapes::Fan(6);
  TriangleMesh strip{std::vector<Vec3f>(fan.positions.begin() + 1, fan.positions.end()),
                     {{0, 5, 1}, {1, 5, 4}, {1, 4, 2}, {2, 4, 3}}};
  const Topology a = shapes::TopologyOf(fan), b = shapes::TopologyOf(strip);
  const std::vector<Vec3f> pa = PredictMidpoints(a, StencilTable(a), fan.positions);
  const std::vector<Vec3f> pb = PredictMidpoints(b, StencilTable(b), strip.positions);
  for (uint32_t i = 0; i < 6; ++i) {
    const uint32_t j = (i + 1) % 6;
    ExpectNear(pa[FindEdge(a, 1 + i, 1 + j)], pb[FindEdge(b, i, j)], 1e-7f);
  }
}

TEST(PredictMidpointsTest, ReproducesCubicsOnTheRegularGrid) {
  // Height fields over the interior of a plane grid, where the eight-point rule is exact to third order.
  TriangleMesh mesh = shapes::Grid(8);
  const Topology t = shapes::TopologyOf(mesh);
  const auto cubic = [](double x, double y) {
    x = (x - 4) / 4, y = (y - 4) / 4;
    return 0.3 + x - 2 * y + x * x - 3 * x * y + 0.5 * y * y + x * x * x - 2 * x * x * y + 0.7 * x * y * y + y * y * y;
  };
  for (Vec3f& p : mesh.positions) p.z = static_cast<float>(cubic(p.x, p.y));
  const std::vector<Vec3f> midpoints = PredictMidpoints(t, StencilTable(t), mesh.positions);
  int checked = 0;
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    const Vec3f& a = mesh.positions[t.edges[e][0]];
    const Vec3f& b = mesh.positions[t.edges[e][1]];
    ExpectNear(midpoints[e], {(a.x + b.x) / 2, (a.y + b.y) / 2, midpoints[e].z},
               t.role[t.edges[e][0]] != CurveRole::kSmooth ? 8.0f : 1e-6f);
    if (t.role[t.edges[e][0]] != CurveRole::kSmooth || t.role[t.edges[e][1]] != CurveRole::kSmooth) continue;
    EXPECT_NEAR(midpoints[e].z, cubic(midpoints[e].x, midpoints[e].y), 1e-5);
    ++checked;
  }
  EXPECT_EQ(checked, 6 * 7 * 2 + 6 * 6);  // edges between the 7 x 7 inner vertices
}

TEST(PredictMidpointsTest, ReproducesLinearFieldsNextToTheBorder) {
  // Not at the corners, where the border curve turns.
  TriangleMesh mesh = shapes::Grid(6);
  const Topology t = shapes::TopologyOf(mesh);
  for (Vec3f& p : mesh.positions) p.z = 2 * p.x - 3 * p.y + 1;
  const std::vector<Vec3f> midpoints = PredictMidpoints(t, StencilTable(t), mesh.positions);
  const auto corner = [](uint32_t v) { return v == 0 || v == 6 || v == 42 || v == 48; };
  int checked = 0;
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    const bool at_corner = t.edge_faces[e][1] == kNone && (corner(t.edges[e][0]) || corner(t.edges[e][1]));
    if (at_corner) continue;
    ExpectNear(midpoints[e], (mesh.positions[t.edges[e][0]] + mesh.positions[t.edges[e][1]]) * 0.5f, 2e-5f);
    ++checked;
  }
  EXPECT_EQ(checked, static_cast<int>(t.num_edges()) - 8);
}

TEST(PredictMidpointsTest, IsAffinelyInvariant) {
  const auto affine = [](const Vec3f& p) { return Vec3f{2 * p.x - p.y + 3, 0.5f * p.z + p.x, p.y - 4 * p.z - 1}; };
  for (const TriangleMesh& mesh : {shapes::Icosahedron(), shapes::Bipyramid(9), shapes::Fan(5), shapes::Grid(3)}) {
    const Topology t = shapes::TopologyOf(mesh);
    const StencilTable table(t);
    std::vector<Vec3f> moved;
    for (const Vec3f& p : mesh.positions) moved.push_back(affine(p));
    const std::vector<Vec3f> midpoints = PredictMidpoints(t, table, mesh.positions);
    const std::vector<Vec3f> moved_midpoints = PredictMidpoints(t, table, moved);
    for (uint32_t e = 0; e < t.num_edges(); ++e) ExpectNear(moved_midpoints[e], affine(midpoints[e]), 2e-5f);
  }
}

TEST(PredictMidpointsTest, SubdividedIcosahedronConvergesToASmoothNearSphere) {
  const SemiRegularMesh mesh = shapes::Subdivided(shapes::Icosahedron(), 4, [](const Vec3f& p) { return p; });
  for (const Vec3f& p : mesh.positions) {
    EXPECT_GT(Norm(p), 0.94f);
    EXPECT_LT(Norm(p), 1.06f);
  }
}

TEST(PredictMidpointsTest, PillowStaysInItsPlaneAndFinite) {
  const TriangleMesh mesh = shapes::Pillow();
  const Topology t = shapes::TopologyOf(mesh);
  for (const Vec3f& p : PredictMidpoints(t, StencilTable(t), mesh.positions)) {
    EXPECT_EQ(p.z, 0.0f);
    EXPECT_GT(p.x, -0.2f);
    EXPECT_GT(p.y, -0.2f);
    EXPECT_LT(p.x + p.y, 1.2f);
  }
}

TEST(PredictMidpointsTest, WorkPerEdgeIsBoundedAtTheHighestValence) {
  const TriangleMesh mesh = shapes::Bipyramid(65535);
  const Topology t = shapes::TopologyOf(mesh);
  const StencilTable table(t);
  uint64_t visits = 0;
  for (uint32_t e = 0; e < t.num_edges(); ++e) VisitStencil(t, table, e, [&](uint32_t, float) { ++visits; });
  EXPECT_LE(visits, uint64_t{t.num_edges()} * 2 * (kMaxStencilValence + 1));
  EXPECT_GE(visits, uint64_t{t.num_edges()} * 5);
}

TEST(PredictMidpointsTest, HighestStencilValenceIsStillExtraordinary) {
  const TriangleMesh at_limit = shapes::Bipyramid(kMaxStencilValence),
                     beyond = shapes::Bipyramid(kMaxStencilValence + 1);
  const Topology a = shapes::TopologyOf(at_limit), b = shapes::TopologyOf(beyond);
  EXPECT_TRUE(IsExtraordinary(a, kMaxStencilValence));
  EXPECT_FALSE(IsExtraordinary(b, kMaxStencilValence + 1));
  EXPECT_GT(StencilOf(a, FindEdge(a, 0, kMaxStencilValence)).size(), size_t{kMaxStencilValence});
  EXPECT_LE(StencilOf(b, FindEdge(b, 0, kMaxStencilValence + 1)).size(), 8u);
}

}  // namespace
}  // namespace lacerta
