#include "remesh/domain_slides.h"

#include <gtest/gtest.h>

#include <cmath>
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
size_t MoveAll(const Base& base, double share, DomainSlides* slides) {
  size_t moved = 0;
  for (uint32_t v = 0; v < base.mesh.positions.size(); ++v) moved += slides->Move(v, base.Near(v, share), base.topology, base.positions);
  return moved;
}

const std::vector<TriangleMesh> kBases = {shapes::Icosphere(1), shapes::BumpySphere(2), shapes::Torus(12, 7)};

TEST(DomainSlides, MapBothWays) {
  for (const TriangleMesh& mesh : kBases) {
    const Base base(mesh);
    DomainSlides slides(base.topology);
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

TEST(DomainSlides, WhatLayAtTheNewPlaceLiesAtTheVertex) {
  for (const TriangleMesh& mesh : kBases) {
    const Base base(mesh);
    DomainSlides slides(base.topology);
    std::vector<char> moved;
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) moved.push_back(slides.Move(v, base.Near(v, 0.25), base.topology, base.positions));
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const DomainPoint from = moved[v] != 0 ? base.Near(v, 0.25) : base.Near(v, 0.0);
      EXPECT_LT(Norm(base.At(slides.Forward(from)) - base.positions[v]), 1e-9) << v;
    }
  }
}

// An edge has two sides: a point of it is the same point in either face, before and after.
TEST(DomainSlides, AreContinuousAcrossEdges) {
  for (const TriangleMesh& mesh : kBases) {
    const Base base(mesh);
    DomainSlides slides(base.topology);
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

TEST(DomainSlides, RefusesWhatWouldFold) {
  const Base base(shapes::Icosphere(1));
  DomainSlides slides(base.topology);
  EXPECT_FALSE(slides.Move(0, base.Near(0, 0.99), base.topology, base.positions));  // onto its neighbors
  EXPECT_FALSE(slides.Move(0, base.Near(20, 0.01), base.topology, base.positions));  // far away
  const DomainPoint p = base.Near(0, 0.4);
  EXPECT_EQ(slides.Forward(p).face, p.face);
  EXPECT_EQ(slides.Forward(p).barycentric, p.barycentric);
  EXPECT_TRUE(slides.Move(0, p, base.topology, base.positions));
}

TEST(DomainSlides, BordersStay) {
  const Base base(shapes::GridWithBorder(8, 8, 0.2f));
  DomainSlides slides(base.topology);
  size_t moved = 0;
  for (uint32_t v = 0; v < base.mesh.positions.size(); ++v) {
    const bool has_moved = slides.Move(v, base.Near(v, 0.2), base.topology, base.positions);
    EXPECT_FALSE(has_moved && base.topology.role[v] != CurveRole::kSmooth) << v;
    moved += has_moved;
  }
  EXPECT_GT(moved, 0u);
}

}  // namespace
}  // namespace lacerta
