#include "remesh/base_domain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "draco_ext/remesh/remeshing.h"

namespace lacerta {
namespace {

using lacerta::testing::BasePositions;
using lacerta::testing::ClosedShapes;
using lacerta::testing::PositionOf;
using lacerta::testing::RandomPointOn;

struct Fixture {
  TriangleMesh mesh;
  CollapseHistory history;

  Fixture(TriangleMesh input, uint32_t target) : mesh(std::move(input)), history(testing::Decimated(mesh, {target, 12, 0.2})) {}
  BaseDomain Domain() const { return BaseDomain(history, history.num_collapses()); }
};

Vec3d OnBase(const BaseDomain& domain, const TriangleMesh& mesh, const DomainPoint& p) {
  return PositionOf(BasePositions(domain, mesh), domain.triangles()[p.face], p.barycentric);
}

Vec3d OnInput(const TriangleMesh& mesh, const DomainPoint& p) { return PositionOf(mesh.positions, mesh.triangles[p.face], p.barycentric); }

void ExpectNear(const Vec3d& a, const Vec3d& b, double tolerance) { EXPECT_LT(Norm(a - b), tolerance); }

uint32_t Neighbor(const BaseDomain& domain, uint32_t face, int k) {
  return FaceAcross(domain.topology(), face, domain.topology().face_edges[face][k]);
}

TEST(BaseDomain, NamesInputVerticesAndFaces) {
  const Fixture f(shapes::BumpySphere(3), 60);
  const BaseDomain domain = f.Domain();
  EXPECT_EQ(domain.num_vertices(), 60u);
  EXPECT_EQ(domain.triangles().size(), 116u);
  const std::vector<uint32_t> faces = f.history.FacesAt(f.history.num_collapses());
  for (size_t i = 0; i < faces.size(); ++i) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(domain.input_vertex(domain.triangles()[i][k]), f.history.face(faces[i])[k]);
  }
}

TEST(BaseDomain, InputAndBaseMapBothWays) {
  for (const shapes::NamedShape& shape : ClosedShapes()) {
    SCOPED_TRACE(shape.name);
    const Fixture f(shape.mesh, 40);
    const BaseDomain domain = f.Domain();
    const double diagonal = BoundingBoxDiagonal(shape.mesh);
    std::mt19937 random(3);
    for (int i = 0; i < 1000; ++i) {
      const DomainPoint in = RandomPointOn(random() % f.mesh.triangles.size(), &random);
      ExpectNear(OnInput(f.mesh, domain.ToInput(domain.FromInput(in))), OnInput(f.mesh, in), 1e-7 * diagonal);
      const DomainPoint on = RandomPointOn(random() % domain.triangles().size(), &random);
      ExpectNear(OnBase(domain, f.mesh, domain.FromInput(domain.ToInput(on))), OnBase(domain, f.mesh, on), 1e-7 * diagonal);
    }
  }
}

TEST(BaseDomain, ManyPointsGoWhereEachOfThemGoes) {
  for (const shapes::NamedShape& shape : ClosedShapes()) {
    SCOPED_TRACE(shape.name);
    const Fixture f(shape.mesh, 40);
    const BaseDomain domain = f.Domain();
    std::mt19937 random(5);
    std::vector<DomainPoint> alone, together;
    for (int i = 0; i < 300; ++i) {
      const DomainPoint in = RandomPointOn(random() % f.mesh.triangles.size(), &random);
      alone.push_back(domain.FromInput(in));
      together.push_back(in);
    }
    domain.FromInput(&together);
    ASSERT_EQ(together.size(), alone.size());
    for (size_t i = 0; i < alone.size(); ++i) {
      EXPECT_EQ(together[i].face, alone[i].face);
      EXPECT_EQ(together[i].barycentric, alone[i].barycentric);
    }
    together.clear();
    domain.FromInput(&together);
    EXPECT_TRUE(together.empty());
  }
}

TEST(BaseDomain, BaseVerticesAreInputVertices) {
  const Fixture f(shapes::Torus(32, 16), 30);
  const BaseDomain domain = f.Domain();
  for (uint32_t face = 0; face < domain.triangles().size(); ++face) {
    for (int k = 0; k < 3; ++k) {
      DomainPoint corner{face, {}};
      corner.barycentric[k] = 1;
      const Vec3d expected = Vec3Cast<double>(f.mesh.positions[domain.input_vertex(domain.triangles()[face][k])]);
      ExpectNear(OnInput(f.mesh, domain.ToInput(corner)), expected, 1e-12);
    }
  }
}

// Weights as single precision gives them: a sum a little off one, or a weight a little below zero.
TEST(BaseDomain, TakesRoundedWeights) {
  const Fixture f(shapes::Icosphere(2), 1000);  // no collapse: the base is the input
  const BaseDomain domain = f.Domain();
  ASSERT_EQ(domain.triangles().size(), 320u);
  for (const Vec3d& w : {Vec3d{0.5, 0.5000001, 0}, Vec3d{-1e-7, 0.3, 0.7}, Vec3d{1, -1e-9, 1e-9}}) {
    const DomainPoint p = domain.FromInput({5, w});
    EXPECT_GE(std::min({p.barycentric.x, p.barycentric.y, p.barycentric.z}), 0);
    EXPECT_NEAR(p.barycentric.x + p.barycentric.y + p.barycentric.z, 1, 1e-15);
  }
}

void ExpectChartMapsBothWays(const BaseDomain& domain, const TriangleMesh& mesh, uint32_t center, const DomainPoint& p) {
  const std::optional<ChartPoint> q = domain.ToChart(center, p);
  ASSERT_TRUE(q.has_value()) << "face " << p.face << " from " << center;
  EXPECT_NEAR(q->x + q->y + q->z, 1, 1e-12);
  const std::optional<DomainPoint> back = domain.FromChart(center, *q);
  ASSERT_TRUE(back.has_value());
  EXPECT_NEAR(back->barycentric.x + back->barycentric.y + back->barycentric.z, 1, 1e-12);
  EXPECT_GE(std::min({back->barycentric.x, back->barycentric.y, back->barycentric.z}), 0);
  ExpectNear(OnBase(domain, mesh, *back), OnBase(domain, mesh, p), 1e-9);
}

TEST(BaseDomain, ChartsMapBothWays) {
  for (const uint32_t target : {4u, 12u, 100u}) {
    const Fixture f(shapes::BumpySphere(3), target);
    const BaseDomain domain = f.Domain();
    ASSERT_EQ(domain.num_vertices(), target);
    std::mt19937 random(4);
    for (uint32_t center = 0; center < domain.triangles().size(); ++center) {
      for (int k = -1; k < 3; ++k) {
        const uint32_t face = k < 0 ? center : Neighbor(domain, center, k);
        for (int i = 0; i < 20; ++i) ExpectChartMapsBothWays(domain, f.mesh, center, RandomPointOn(face, &random));
        for (int c = 0; c < 3; ++c) {  // corners, the far one included, and edges
          DomainPoint corner{face, {}}, edge{face, {0.3, 0.3, 0.3}};
          corner.barycentric[c] = 1;
          edge.barycentric[c] = 0;
          edge.barycentric[(c + 1) % 3] = 0.7;
          ExpectChartMapsBothWays(domain, f.mesh, center, corner);
          ExpectChartMapsBothWays(domain, f.mesh, center, edge);
        }
      }
    }
  }
}

TEST(BaseDomain, ChartsAgreeAcrossEdges) {
  const Fixture f(shapes::Torus(32, 16), 40);
  const BaseDomain domain = f.Domain();
  const Topology& t = domain.topology();
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    const uint32_t f0 = t.edge_faces[e][0], f1 = t.edge_faces[e][1];
    const int k0 = EdgeCorner(t, f0, e), k1 = EdgeCorner(t, f1, e);
    DomainPoint from_first{f0, {}}, from_second{f1, {}};  // the same point of the edge
    from_first.barycentric[(k0 + 1) % 3] = from_second.barycentric[(k1 + 2) % 3] = 0.3;
    from_first.barycentric[(k0 + 2) % 3] = from_second.barycentric[(k1 + 1) % 3] = 0.7;
    for (const uint32_t center : {f0, f1}) {
      const Vec3d a = domain.ToChart(center, from_first).value(), b = domain.ToChart(center, from_second).value();
      ExpectNear(a, b, 1e-14);
    }
    // The far corner of the neighbor is the reflection of the near one.
    DomainPoint far{f1, {}};
    far.barycentric[k1] = 1;
    ChartPoint reflected{1, 1, 1};
    reflected[k0] = -1;
    ExpectNear(domain.ToChart(f0, far).value(), reflected, 1e-14);
  }
}

TEST(BaseDomain, HasNoChartFartherAway) {
  const Fixture f(shapes::BumpySphere(3), 100);
  const BaseDomain domain = f.Domain();
  for (uint32_t center = 0; center < 20; ++center) {
    const Triangle& t = domain.triangles()[center];
    int num_in = 0, num_with_corner = 0;
    for (uint32_t face = 0; face < domain.triangles().size(); ++face) {
      num_in += domain.ToChart(center, {face, {0.3, 0.3, 0.4}}).has_value();
      for (int k = 0; k < 3; ++k) {
        DomainPoint corner{face, {}};
        corner.barycentric[k] = 1;
        const bool shared = std::find(t.begin(), t.end(), domain.triangles()[face][k]) != t.end();
        num_with_corner += shared;
        EXPECT_TRUE(!shared || domain.ToChart(center, corner).has_value());
      }
    }
    EXPECT_EQ(num_in, 4);
    EXPECT_GT(num_with_corner, 9);
    EXPECT_FALSE(domain.FromChart(center, {-0.6, 0.3, 1.3}).has_value());
    EXPECT_FALSE(domain.FromChart(center, {2, -0.5, -0.5}).has_value());
    EXPECT_TRUE(domain.FromChart(center, {-0.5, 0.6, 0.9}).has_value());
  }
}

TEST(BaseDomain, ReorderKeepsTheMap) {
  const Fixture f(shapes::Torus(32, 16), 50);
  const BaseDomain before = f.Domain();
  BaseDomain after = f.Domain();
  std::mt19937 random(9);
  for (int round = 0; round < 2; ++round) {  // the second on top of the first
    std::vector<uint32_t> vertex_map(after.num_vertices()), new_number(after.num_vertices());
    std::iota(vertex_map.begin(), vertex_map.end(), 0u);
    std::shuffle(vertex_map.begin(), vertex_map.end(), random);
    for (uint32_t v = 0; v < vertex_map.size(); ++v) new_number[vertex_map[v]] = v;
    std::vector<Triangle> triangles = after.triangles();
    std::shuffle(triangles.begin(), triangles.end(), random);
    for (Triangle& t : triangles) {
      std::rotate(t.begin(), t.begin() + random() % 3, t.end());
      for (uint32_t& v : t) v = new_number[v];
    }
    after.Reorder(vertex_map, triangles);
    EXPECT_EQ(after.triangles(), triangles);
    EXPECT_EQ(after.topology().triangles, triangles);
  }
  int moved = 0;
  for (int i = 0; i < 1000; ++i) {
    const DomainPoint in = RandomPointOn(random() % f.mesh.triangles.size(), &random);
    const DomainPoint a = before.FromInput(in), b = after.FromInput(in);
    moved += a.face != b.face;
    for (int k = 0; k < 3; ++k) {  // the same weights at the same input vertices
      const uint32_t v = before.input_vertex(before.triangles()[a.face][k]);
      int same = 0;
      while (same < 3 && after.input_vertex(after.triangles()[b.face][same]) != v) ++same;
      ASSERT_LT(same, 3);
      EXPECT_EQ(a.barycentric[k], b.barycentric[same]);
    }
    const DomainPoint back = after.ToInput(b);
    ExpectNear(OnInput(f.mesh, back), OnInput(f.mesh, in), 1e-9);
  }
  EXPECT_GT(moved, 900);
}

}  // namespace
}  // namespace lacerta
