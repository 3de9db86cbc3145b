#include "remesh/collapse_history.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "draco_ext/remesh/remeshing.h"

namespace lacerta {
namespace {

constexpr uint32_t kRing = 6, kTop = 6, kBottom = 7;

// A double pyramid over a hexagon, its faces turned to start at any corner: faces 0..5 around the top, 6..11 below.
TriangleMesh DoublePyramid() {
  TriangleMesh mesh;
  mesh.positions.resize(kRing + 2);
  for (uint32_t i = 0; i < 2 * kRing; ++i) {
    const uint32_t a = i % kRing, b = (i + 1) % kRing;
    Triangle t = i < kRing ? Triangle{kTop, a, b} : Triangle{kBottom, b, a};
    std::rotate(t.begin(), t.begin() + i % 3, t.end());
    mesh.triangles.push_back(t);
  }
  return mesh;
}

std::vector<Vec2d> Hexagon() {
  std::vector<Vec2d> chart;
  for (uint32_t i = 0; i < kRing; ++i) chart.push_back({std::cos(i * M_PI / 3), std::sin(i * M_PI / 3)});
  return chart;
}

// The top removed in favor of ring vertex `kept`.
CollapseHistory AfterOneCollapse(int kept) {
  const TriangleMesh mesh = DoublePyramid();
  CollapseHistory history(BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles).value());
  EXPECT_EQ(history.Append(kTop, {0, 1, 2, 3, 4, 5}, Hexagon(), {0, 1, 2, 3, 4, 5}, kept), 12u);
  return history;
}

// Where the chart has a point of the upper side, by its face's vertices.
Vec2d InChart(const CollapseHistory& history, const DomainPoint& point) {
  std::vector<Vec2d> chart = Hexagon();
  chart.push_back({});
  Vec2d q;
  for (int k = 0; k < 3; ++k) {
    const Vec2d& p = chart.at(history.face(point.face)[k]);
    q.x += p.x * point.barycentric[k];
    q.y += p.y * point.barycentric[k];
  }
  return q;
}

void ExpectSamePlace(const CollapseHistory& history, const DomainPoint& a, const DomainPoint& b) {
  EXPECT_NEAR(InChart(history, a).x, InChart(history, b).x, 1e-14);
  EXPECT_NEAR(InChart(history, a).y, InChart(history, b).y, 1e-14);
}

void ExpectWeights(const DomainPoint& p) {
  EXPECT_GE(std::min({p.barycentric.x, p.barycentric.y, p.barycentric.z}), 0);
  EXPECT_NEAR(p.barycentric.x + p.barycentric.y + p.barycentric.z, 1, 1e-14);
}

DomainPoint RandomPointOn(size_t face, std::mt19937* random) {
  std::uniform_real_distribution<double> unit(0, 1);
  double a = unit(*random), b = unit(*random);
  if (a + b > 1) a = 1 - a, b = 1 - b;
  return {static_cast<uint32_t>(face), {1 - a - b, a, b}};
}

TEST(CollapseHistory, KnowsHowManyCollapsesLeaveSoManyVertices) {
  const CollapseHistory history = AfterOneCollapse(4);  // 8 vertices
  EXPECT_EQ(history.CollapsesTo(9), 0u);
  EXPECT_EQ(history.CollapsesTo(8), 0u);
  EXPECT_EQ(history.CollapsesTo(7), 1u);
  EXPECT_EQ(history.CollapsesTo(0), 1u);  // that is all
}

TEST(CollapseHistory, KnowsTheFacesOfEveryTime) {
  const CollapseHistory history = AfterOneCollapse(4);
  EXPECT_EQ(history.num_collapses(), 1u);
  EXPECT_EQ(history.num_faces(), 16u);
  EXPECT_EQ(history.FacesAt(0), (std::vector<uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_EQ(history.FacesAt(1), (std::vector<uint32_t>{6, 7, 8, 9, 10, 11, 12, 13, 14, 15}));
  EXPECT_EQ(history.face(12), (Triangle{4, 5, 0}));
  EXPECT_EQ(history.face(15), (Triangle{4, 2, 3}));
}

TEST(CollapseHistory, MapsBothWaysWhateverVertexIsKept) {
  std::mt19937 random(7);
  for (int kept = 0; kept < static_cast<int>(kRing); ++kept) {
    const CollapseHistory history = AfterOneCollapse(kept);
    for (int i = 0; i < 300; ++i) {
      const DomainPoint old = RandomPointOn(random() % kRing, &random);
      const DomainPoint forward = history.Forward(old, 1);
      ASSERT_GE(forward.face, 12u);
      ASSERT_LT(forward.face, 16u);
      ExpectWeights(forward);
      ExpectSamePlace(history, forward, old);
      ExpectSamePlace(history, history.Backward(forward), old);

      const DomainPoint fresh = RandomPointOn(12 + random() % 4, &random);
      const DomainPoint backward = history.Backward(fresh);
      ASSERT_LT(backward.face, kRing);
      ExpectWeights(backward);
      ExpectSamePlace(history, backward, fresh);
      ExpectSamePlace(history, history.Forward(backward, 1), fresh);
    }
  }
}

TEST(CollapseHistory, LeavesAlonePointsThatNoCollapseTouches) {
  const CollapseHistory history = AfterOneCollapse(0);
  std::mt19937 random(8);
  for (uint32_t f = 0; f < 12; ++f) {
    const DomainPoint p = RandomPointOn(f, &random);
    const DomainPoint now = history.Forward(p, 0);  // before the collapse
    EXPECT_EQ(now.face, f);
    EXPECT_EQ(now.barycentric, p.barycentric);
    if (f < kRing) continue;
    EXPECT_EQ(history.Forward(p, 1).face, f);
    EXPECT_EQ(history.Backward(p).face, f);
    EXPECT_EQ(history.Backward(p).barycentric, p.barycentric);
  }
}

TEST(CollapseHistory, CornersAndEdgesStayWhereTheyAre) {
  const CollapseHistory history = AfterOneCollapse(2);
  for (uint32_t f = 0; f < kRing; ++f) {
    for (int k = 0; k < 3; ++k) {
      DomainPoint corner{f, {}}, edge{f, {0.5, 0.5, 0.5}};
      corner.barycentric[k] = 1;
      edge.barycentric[k] = 0;
      ExpectSamePlace(history, history.Forward(corner, 1), corner);
      ExpectSamePlace(history, history.Forward(edge, 1), edge);
      ExpectSamePlace(history, history.Backward(history.Forward(edge, 1)), edge);
    }
  }
}

TEST(ClampWeights, MakesWeightsOfAnyNumbers) {
  EXPECT_EQ(ClampWeights({0.25, 0.25, 0.5}), (Vec3d{0.25, 0.25, 0.5}));
  EXPECT_EQ(ClampWeights({-1e-9, 1, 1}), (Vec3d{0, 0.5, 0.5}));
  EXPECT_EQ(ClampWeights({-1, -1, -1}), (Vec3d{1, 0, 0}));
  EXPECT_EQ(ClampWeights({0, 0, 4}), (Vec3d{0, 0, 1}));
}

TEST(CollapseHistory, HoldsCollapsesBackWithWhatBuildsOnThem) {
  std::mt19937 random(17);
  size_t num_finer = 0, num_refused = 0;
  for (const shapes::NamedShape& shape : lacerta::testing::ClosedShapes()) {
    SCOPED_TRACE(shape.name);
    const CollapseHistory history = lacerta::testing::Decimated(shape.mesh, {16, 12, 0.2});
    if (history.num_collapses() == 0) continue;
    const int64_t euler = 2 - 2 * shape.genus;
    for (int i = 0; i < 20; ++i) {
      const uint32_t time = i % 2 == 0 ? history.num_collapses() : 1 + static_cast<uint32_t>(random() % history.num_collapses());
      std::vector<uint32_t> held;
      for (int k = 0; k <= i / 4; ++k) held.push_back(time - 1 - static_cast<uint32_t>(random() % std::min(time, 40u)));
      const HistoryCut cut = history.CutWithout(held, time);
      std::vector<Triangle> triangles;
      std::set<uint32_t> vertices;
      for (const uint32_t f : history.FacesAt(cut)) {
        triangles.push_back(history.face(f));
        vertices.insert(triangles.back().begin(), triangles.back().end());
      }
      const StatusOr<Topology> topology = BuildTopology(static_cast<uint32_t>(shape.mesh.positions.size()), triangles);
      ASSERT_TRUE(topology.ok()) << topology.status().message();
      EXPECT_EQ(static_cast<int64_t>(vertices.size()) - topology.value().num_edges() + topology.value().num_faces(), euler);
      const size_t num_plain = shape.mesh.positions.size() - time;
      EXPECT_LT(vertices.size(), shape.mesh.positions.size() + 1);
      if (cut.held.empty()) {
        ++num_refused;
        EXPECT_EQ(vertices.size(), num_plain);
        continue;
      }
      ++num_finer;
      EXPECT_GT(vertices.size(), num_plain);
      for (const uint32_t c : held) EXPECT_FALSE(cut.Has(c));
      for (int n = 0; n < 30; ++n) {
        const DomainPoint p = RandomPointOn(random() % shape.mesh.triangles.size(), &random);
        const DomainPoint on_base = history.Forward(p, cut), again = history.Forward(history.Backward(on_base), cut);
        ExpectWeights(on_base);
        const auto place = [&](const DomainPoint& q) { return lacerta::testing::PositionOf(shape.mesh.positions, history.face(q.face), q.barycentric); };
        EXPECT_LT(Norm(place(again) - place(on_base)), 1e-5 * BoundingBoxDiagonal(shape.mesh));
      }
    }
  }
  EXPECT_GT(num_finer, 50u);
  EXPECT_LT(num_refused, num_finer / 10);
}

TEST(CollapseHistory, HoldsNothingBackUnasked) {
  const CollapseHistory history = AfterOneCollapse(0);
  EXPECT_TRUE(history.CutWithout({}, 1).held.empty());
  EXPECT_EQ(history.FacesAt(history.CutWithout({0}, 1)), history.FacesAt(0));
  EXPECT_EQ(history.FacesAt(history.CutWithout({0}, 0)), history.FacesAt(0)) << "not yet made";
  EXPECT_EQ(history.created_by(0), kNone);
  EXPECT_EQ(history.created_by(12), 0u);
}

}  // namespace
}  // namespace lacerta
