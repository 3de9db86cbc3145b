// Decimation, its history and the base domain on surfaces with borders, creases and cuts.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "draco_ext/remesh/remeshing.h"
#include "remesh/base_parts.h"
#include "remesh/surface_parts.h"

namespace lacerta {
namespace {

using lacerta::testing::Moved;
using lacerta::testing::PositionOf;
using lacerta::testing::RandomPointOn;

struct Case {
  const char* name;
  SurfaceParts parts;
};

std::vector<Case> Cases() {
  const SurfacePartsOptions all{1};
  return {{"grid", SplitSurface(shapes::GridWithBorder(24, 20, 0.3f), all)},
          {"punctured sphere", SplitSurface(shapes::PuncturedSphere(4), all)},
          {"box", SplitSurface(shapes::CreasedBox(10), all)},
          {"plate with holes", SplitSurface(shapes::TwoHoledPlate(6), all)},
          {"band", SplitSurface(shapes::MoebiusBand(40), all)},
          {"touching boxes", SplitSurface(shapes::TouchingBoxes(8), all)},
          {"double sheet", SplitSurface(shapes::DoubleSheet(16, 16), all)},
          {"box beside grid", SplitSurface(Together(shapes::CreasedBox(10), Moved(shapes::GridWithBorder(20, 20), {3, 0, 0})), all)}};
}

CollapseHistory DecimateFully(const SurfaceParts& parts) {
  DecimateOptions options;
  options.target_vertices = 4;
  return Decimate(parts.refined, parts.topology, options);
}

// What every intermediate mesh has in common with the input.
struct Shape {
  int64_t euler = 0;
  size_t borders = 0;        // closed polygons
  int64_t border_ends = 0;   // vertices less edges of all borders
  int64_t crease_ends = 0;   // vertices less edges of all curves

  bool operator==(const Shape& b) const {
    return euler == b.euler && borders == b.borders && border_ends == b.border_ends && crease_ends == b.crease_ends;
  }
};

Shape ShapeOf(const Topology& t) {
  std::vector<uint32_t> next(t.num_vertices, kNone);
  std::set<uint32_t> on_curve, on_border;
  Shape shape;
  shape.euler = int64_t{t.num_vertices} - t.num_edges() + t.num_faces();
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    if (!t.on_curve[e]) continue;
    --shape.crease_ends;
    on_curve.insert(t.edges[e].begin(), t.edges[e].end());
    if (!t.is_border(e)) continue;
    --shape.border_ends;
    on_border.insert(t.edges[e].begin(), t.edges[e].end());
    const uint32_t f = t.edge_faces[e][0];
    const int k = EdgeCorner(t, f, e);
    next[t.triangles[f][(k + 1) % 3]] = t.triangles[f][(k + 2) % 3];
  }
  shape.crease_ends += static_cast<int64_t>(on_curve.size());
  shape.border_ends += static_cast<int64_t>(on_border.size());
  for (uint32_t start = 0; start < t.num_vertices; ++start) {
    if (next[start] == kNone) continue;
    ++shape.borders;
    for (uint32_t v = start; next[v] != kNone;) v = std::exchange(next[v], kNone);
  }
  return shape;
}

TEST(DecimateCurves, EveryIntermediateMeshHasTheTopologyAndCurvesOfTheInput) {
  for (const Case& c : Cases()) {
    SCOPED_TRACE(c.name);
    const CollapseHistory history = DecimateFully(c.parts);
    const Shape expected = ShapeOf(c.parts.topology);
    EXPECT_GT(history.num_collapses(), c.parts.refined.positions.size() / 2);
    for (const double share : {0.0, 0.2, 0.5, 0.9, 0.97, 1.0}) {
      const BaseDomain domain(history, static_cast<uint32_t>(share * history.num_collapses()));
      const Shape shape = ShapeOf(domain.topology());
      EXPECT_TRUE(shape == expected) << "after " << share << ": Euler " << shape.euler << " of " << expected.euler << ", borders "
                                     << shape.borders << " of " << expected.borders << ", curve ends " << shape.crease_ends
                                     << " of " << expected.crease_ends;
    }
  }
}

TEST(DecimateCurves, CornersStayCorners) {
  for (const Case& c : Cases()) {
    SCOPED_TRACE(c.name);
    const CollapseHistory history = DecimateFully(c.parts);
    const BaseDomain domain(history, history.num_collapses());
    std::set<uint32_t> corners, expected;
    for (uint32_t v = 0; v < domain.num_vertices(); ++v) {
      if (domain.topology().role[v] == CurveRole::kCorner) corners.insert(domain.input_vertex(v));
    }
    for (uint32_t v = 0; v < c.parts.topology.num_vertices; ++v) {
      if (c.parts.topology.role[v] == CurveRole::kCorner) expected.insert(v);
    }
    EXPECT_EQ(corners, expected);
  }
}

TEST(DecimateCurves, MapsBothWays) {
  for (const Case& c : Cases()) {
    SCOPED_TRACE(c.name);
    const TriangleMesh& mesh = c.parts.refined;
    const CollapseHistory history = DecimateFully(c.parts);
    const double tolerance = 1e-9 * BoundingBoxDiagonal(mesh);
    const auto place = [&](const DomainPoint& p) { return PositionOf(mesh.positions, history.face(p.face), p.barycentric); };
    std::mt19937 random(5);
    for (const double share : {0.3, 0.7, 0.9}) {
      const auto time = static_cast<uint32_t>(share * history.num_collapses());
      const std::vector<uint32_t> base = history.FacesAt(time);
      for (int i = 0; i < 1000; ++i) {
        const DomainPoint p = RandomPointOn(random() % mesh.triangles.size(), &random);
        EXPECT_LT(Norm(place(history.Backward(history.Forward(p, time))) - place(p)), tolerance);
        const DomainPoint b = RandomPointOn(base[random() % base.size()], &random);
        EXPECT_LT(Norm(place(history.Forward(history.Backward(b), time)) - place(b)), tolerance);
      }
    }
  }
}

// Of a face's sides on a curve, how far the nearest is, as a weight.
double OffCurve(const CollapseHistory& history, const DomainPoint& p) {
  double least = 1;
  for (int k = 0; k < 3; ++k) {
    if (history.is_curve(p.face, k)) least = std::min(least, p.barycentric[k]);
  }
  return least;
}

DomainPoint OnSide(uint32_t face, int k, double share) {
  DomainPoint p{face, {}};
  p.barycentric[(k + 1) % 3] = share;
  p.barycentric[(k + 2) % 3] = 1 - share;
  return p;
}

TEST(DecimateCurves, CurvePointsMapOntoCurvePoints) {
  for (const Case& c : Cases()) {
    SCOPED_TRACE(c.name);
    const CollapseHistory history = DecimateFully(c.parts);
    const uint32_t end = history.num_collapses();
    size_t down = 0, up = 0;
    for (uint32_t f = 0; f < c.parts.refined.triangles.size(); ++f) {
      for (int k = 0; k < 3; ++k) {
        if (!history.is_curve(f, k)) continue;
        ++down;
        for (const double share : {0.0213, 0.317, 0.513, 0.871}) EXPECT_LT(OffCurve(history, history.Forward(OnSide(f, k, share), end)), 1e-9);
      }
    }
    for (const uint32_t f : history.FacesAt(end)) {
      for (int k = 0; k < 3; ++k) {
        if (!history.is_curve(f, k)) continue;
        ++up;
        for (const double share : {0.0213, 0.317, 0.513, 0.871}) EXPECT_LT(OffCurve(history, history.Backward(OnSide(f, k, share))), 1e-9);
      }
    }
    EXPECT_GT(up, 2u);
    EXPECT_LE(up, down);
    // What is no curve is not on one either.
    std::mt19937 random(6);
    size_t inside = 0;
    for (int i = 0; i < 500; ++i) {
      inside += OffCurve(history, history.Forward(RandomPointOn(random() % c.parts.refined.triangles.size(), &random), end)) > 1e-9;
    }
    EXPECT_GT(inside, 450u);
  }
}

std::map<uint32_t, int> NumCopies(const SurfaceParts& parts, const BaseDomain& domain) {
  std::map<uint32_t, int> copies;
  for (uint32_t v = 0; v < domain.num_vertices(); ++v) ++copies[parts.source_vertex[domain.input_vertex(v)]];
  return copies;
}

TEST(DecimateCurves, BothSidesOfACutKeepTheSamePoints) {
  for (const TriangleMesh& mesh : {shapes::TouchingBoxes(8), shapes::DoubleSheet(16, 16)}) {
    const SurfaceParts parts = SplitSurface(mesh, {1});
    const CollapseHistory history = DecimateFully(parts);
    const std::map<uint32_t, int> before = NumCopies(parts, BaseDomain(history, 0));
    std::map<uint32_t, int> after = NumCopies(parts, BaseDomain(history, history.num_collapses()));
    size_t on_cut = 0;
    for (uint32_t v = 0; v < parts.source_vertex.size(); ++v) {
      const uint32_t source = parts.source_vertex[v];
      if (before.at(source) < 2 || parts.topology.role[v] == CurveRole::kSmooth) continue;
      ++on_cut;
      EXPECT_EQ(after[source], 2);
    }
    EXPECT_GE(on_cut, 2u * 9);
    EXPECT_LE(on_cut, 2u * 64);
  }
}

TEST(DecimateCurves, TheInsideOfADoubleSheetIsFree) {
  const SurfaceParts parts = SplitSurface(shapes::DoubleSheet(16, 16), {1});
  const CollapseHistory history = DecimateFully(parts);
  EXPECT_GT(history.num_collapses(), 2u * 200);  // of 2 * 225 vertices inside
}

}  // namespace
}  // namespace lacerta
