#include "remesh/domain_moves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "draco_ext/remesh/remeshing.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using lacerta::testing::PositionOf;
using lacerta::testing::RandomPointOn;
using lacerta::testing::TopologyOf;

struct Base {
  explicit Base(const TriangleMesh& m) : mesh(m), topology(TopologyOf(m)) {
    for (const Vec3f& p : m.positions) positions.push_back(Vec3Cast<double>(p));
  }
  Vec3d At(const DomainPoint& p) const { return PositionOf(mesh.positions, mesh.triangles[p.face], p.barycentric); }
  // A face around v and the corner where it is.
  DomainPoint Near(uint32_t v, double share) const {
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
      for (int k = 0; k < 3; ++k) {
        if (mesh.triangles[f][k] != v) continue;
        DomainPoint p{f, {}};
        p.barycentric[k] = 1 - share;
        p.barycentric[(k + 1) % 3] = 0.7 * share;
        p.barycentric[(k + 2) % 3] = 0.3 * share;
        return p;
      }
    }
    return {};
  }

  const TriangleMesh mesh;
  const Topology topology;
  std::vector<Vec3d> positions;
};

// Of all vertices by turns those that can.
size_t MoveAll(const Base& base, double share, DomainMoves* slides) {
  size_t moved = 0;
  for (uint32_t v = 0; v < base.mesh.positions.size(); ++v) moved += slides->Slide(v, base.Near(v, share), base.topology, base.positions);
  return moved;
}

const std::vector<TriangleMesh> kBases = {shapes::Icosphere(1), shapes::BumpySphere(2), shapes::Torus(12, 7)};

TEST(DomainMoves, SlidesMapBothWays) {
  for (const TriangleMesh& mesh : kBases) {
    const Base base(mesh);
    DomainMoves slides(base.mesh.triangles.size());
    EXPECT_GT(MoveAll(base, 0.3, &slides), mesh.positions.size() * 3 / 4);
    std::mt19937 random(1);
    double farthest = 0;
    for (int i = 0; i < 2000; ++i) {
      const DomainPoint p = RandomPointOn(random() % mesh.triangles.size(), &random);
      EXPECT_LT(Norm(base.At(slides.Backward(slides.Forward(p))) - base.At(p)), 1e-9);
      EXPECT_LT(Norm(base.At(slides.Forward(slides.Backward(p))) - base.At(p)), 1e-9);
      farthest = std::max(farthest, Norm(base.At(slides.Forward(p)) - base.At(p)));
    }
    EXPECT_GT(farthest, 0.02);  // it does something
  }
}

TEST(DomainMoves, WhatLayAtTheNewPlaceLiesAtTheVertex) {
  for (const TriangleMesh& mesh : kBases) {
    const Base base(mesh);
    DomainMoves slides(base.mesh.triangles.size());
    std::vector<char> moved;
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) moved.push_back(slides.Slide(v, base.Near(v, 0.25), base.topology, base.positions));
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const DomainPoint from = moved[v] != 0 ? base.Near(v, 0.25) : base.Near(v, 0.0);
      EXPECT_LT(Norm(base.At(slides.Forward(from)) - base.positions[v]), 1e-9) << v;
    }
  }
}

// An edge has two sides: a point of it is the same point in either face, before and after.
TEST(DomainMoves, SlidesAreContinuousAcrossEdges) {
  for (const TriangleMesh& mesh : kBases) {
    const Base base(mesh);
    DomainMoves slides(base.mesh.triangles.size());
    MoveAll(base, 0.3, &slides);
    for (uint32_t e = 0; e < base.topology.num_edges(); ++e) {
      for (const double share : {0.1, 0.5, 0.8}) {
        Vec3d at[2];
        for (int side = 0; side < 2; ++side) {
          const uint32_t face = base.topology.edge_faces[e][side];
          DomainPoint p{face, {}};
          for (int k = 0; k < 3; ++k) {
            if (mesh.triangles[face][k] == base.topology.edges[e][0]) p.barycentric[k] = share;
            if (mesh.triangles[face][k] == base.topology.edges[e][1]) p.barycentric[k] = 1 - share;
          }
          at[side] = base.At(slides.Forward(p));
        }
        EXPECT_LT(Norm(at[0] - at[1]), 1e-9);
      }
    }
  }
}

TEST(DomainMoves, RefuseSlidesThatWouldFold) {
  const Base base(shapes::Icosphere(1));
  DomainMoves slides(base.mesh.triangles.size());
  EXPECT_FALSE(slides.Slide(0, base.Near(0, 0.99), base.topology, base.positions));  // onto its neighbors
  EXPECT_FALSE(slides.Slide(0, base.Near(20, 0.01), base.topology, base.positions));  // far away
  const DomainPoint p = base.Near(0, 0.4);
  EXPECT_EQ(slides.Forward(p).face, p.face);
  EXPECT_EQ(slides.Forward(p).barycentric, p.barycentric);
  EXPECT_TRUE(slides.Slide(0, p, base.topology, base.positions));
}

TEST(DomainMoves, BordersStay) {
  const Base base(shapes::GridWithBorder(8, 8, 0.2f));
  DomainMoves slides(base.mesh.triangles.size());
  size_t moved = 0;
  for (uint32_t v = 0; v < base.mesh.positions.size(); ++v) {
    const bool has_moved = slides.Slide(v, base.Near(v, 0.2), base.topology, base.positions);
    EXPECT_FALSE(has_moved && base.topology.role[v] != CurveRole::kSmooth) << v;
    moved += has_moved;
  }
  EXPECT_GT(moved, 0u);
}

// The base with every edge turned that can be, of which no two have a face in common.
struct Turned {
  explicit Turned(const TriangleMesh& mesh) : before(mesh), moves(mesh.triangles.size()) {
    std::vector<char> is_taken(mesh.triangles.size());
    TriangleMesh turned = mesh;
    for (uint32_t e = 0; e < before.topology.num_edges(); ++e) {
      const auto& [f, g] = before.topology.edge_faces[e];
      if (g == kNone || is_taken[f] != 0 || is_taken[g] != 0 || !moves.Flip(e, before.topology, before.positions)) continue;
      is_taken[f] = is_taken[g] = 1;
      const int at_c = EdgeCorner(before.topology, f, e), at_d = EdgeCorner(before.topology, g, e);
      turned.triangles[f][static_cast<size_t>(at_c + 2) % 3] = mesh.triangles[g][static_cast<size_t>(at_d)];
      turned.triangles[g][static_cast<size_t>(at_d + 2) % 3] = mesh.triangles[f][static_cast<size_t>(at_c)];
      edges.push_back(e);
    }
    after = std::make_unique<Base>(turned);
  }

  const Base before;
  DomainMoves moves;
  std::vector<uint32_t> edges;
  std::unique_ptr<Base> after;
};

TEST(DomainMoves, TurnedEdgesMapBothWays) {
  for (const TriangleMesh& mesh : kBases) {
    const Turned turned(mesh);
    EXPECT_GT(turned.edges.size(), mesh.triangles.size() / 4);
    std::mt19937 random(2);
    double farthest = 0;
    for (int i = 0; i < 2000; ++i) {
      const DomainPoint p = RandomPointOn(random() % mesh.triangles.size(), &random);
      EXPECT_LT(Norm(turned.before.At(turned.moves.Backward(turned.moves.Forward(p))) - turned.before.At(p)), 1e-9);
      EXPECT_LT(Norm(turned.after->At(turned.moves.Forward(turned.moves.Backward(p))) - turned.after->At(p)), 1e-9);
      farthest = std::max(farthest, Norm(turned.after->At(turned.moves.Forward(p)) - turned.before.At(p)));
    }
    EXPECT_GT(farthest, 0.01);  // across the fold of the quadrangle
    EXPECT_LT(farthest, 0.5);   // and no farther: a point of two triangles stays in their place
  }
}

// The outline of a quadrangle stays, and its corners.
TEST(DomainMoves, TurnedEdgesChangeNothingAtTheOutline) {
  for (const TriangleMesh& mesh : kBases) {
    const Turned turned(mesh);
    std::vector<char> is_turned(turned.before.topology.num_edges());
    for (const uint32_t e : turned.edges) is_turned[e] = 1;
    for (uint32_t e = 0; e < is_turned.size(); ++e) {
      if (is_turned[e] != 0) continue;
      for (const uint32_t face : turned.before.topology.edge_faces[e]) {
        DomainPoint p{face, {}};
        const int corner = EdgeCorner(turned.before.topology, face, e);
        p.barycentric[(corner + 1) % 3] = 0.3;
        p.barycentric[(corner + 2) % 3] = 0.7;
        EXPECT_LT(Norm(turned.after->At(turned.moves.Forward(p)) - turned.before.At(p)), 1e-9) << e;
      }
    }
  }
}

TEST(DomainMoves, OfAFlatQuadrangleAllPointsStayWhereTheyAre) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0.6f, 0.8f, 0}, {0.4f, -0.7f, 0}}, {{0, 1, 2}, {3, 1, 0}}};
  const Turned turned(mesh);
  ASSERT_EQ(turned.edges.size(), 1u);
  EXPECT_NE(turned.after->mesh.triangles, mesh.triangles);
  std::mt19937 random(3);
  for (int i = 0; i < 500; ++i) {
    const DomainPoint p = RandomPointOn(random() % 2, &random);
    EXPECT_LT(Norm(turned.after->At(turned.moves.Forward(p)) - turned.before.At(p)), 1e-7);
  }
}

TEST(DomainMoves, RefuseEdgesOfQuadranglesThatAreNotConvex) {
  for (const float x : {0.0f, 0.05f, 1.2f}) {
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {x, 0.8f, 0}, {x, -0.7f, 0}}, {{0, 1, 2}, {3, 1, 0}}};
    EXPECT_TRUE(Turned(mesh).edges.empty()) << x;
  }
}

TEST(DomainMoves, SlidesAndTurnedEdgesAddUp) {
  for (const TriangleMesh& mesh : kBases) {
    Turned turned(mesh);
    size_t moved = 0;
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const DomainPoint to = turned.moves.Backward(turned.after->Near(v, 0.2));
      if (!turned.moves.Slide(v, to, turned.after->topology, turned.after->positions)) continue;
      ++moved;
      EXPECT_LT(Norm(turned.after->At(turned.moves.Forward(to)) - turned.after->positions[v]), 1e-9) << v;
    }
    EXPECT_GT(moved, mesh.positions.size() / 2);
    std::mt19937 random(4);
    for (int i = 0; i < 500; ++i) {
      const DomainPoint p = RandomPointOn(random() % mesh.triangles.size(), &random);
      EXPECT_LT(Norm(turned.before.At(turned.moves.Backward(turned.moves.Forward(p))) - turned.before.At(p)), 1e-9);
    }
  }
}

}  // namespace
}  // namespace lacerta
