// Remeshing of surfaces with borders, creases and cuts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "draco_ext/remesh/remeshing.h"
#include "remesh/base_parts.h"
#include "lacerta/decoder.h"
#include "remesh/surface_fit.h"
#include "remesh/surface_parts.h"

namespace lacerta {
namespace {

using lacerta::testing::Moved;
using lacerta::testing::TimeOf;

struct Remeshed {
  SurfaceParts parts;
  NormalMesh mesh;
  Topology finest;
  std::vector<uint32_t> input_vertex;  // of the base vertices

  const std::vector<Vec3f>& positions() const { return mesh.mesh.positions; }
  TriangleMesh Surface() const { return {positions(), finest.triangles}; }
};

Remeshed RemeshOf(const TriangleMesh& input, uint32_t num_base_vertices, int levels, bool fit) {
  Remeshed result;
  result.parts = SplitSurface(input, {1});
  const SurfaceParts& parts = result.parts;
  const CollapseHistory history = Decimate(parts.refined, parts.topology, {num_base_vertices, 12, 0.2});
  const InputSurface surface(parts.refined, parts.topology);
  const BaseDomain domain(history, TimeOf(history, parts.refined, num_base_vertices));
  PiercingOptions options;
  options.num_levels = levels;
  result.mesh = Pierce(surface, domain, domain.PositionsOn(parts.refined), options);
  if (fit) FitToInput(surface, SurfaceFitOptions(), &result.mesh);
  result.finest = domain.topology();
  for (int level = 0; level < levels; ++level) result.finest = Refine(result.finest);
  for (uint32_t v = 0; v < domain.num_vertices(); ++v) result.input_vertex.push_back(domain.input_vertex(v));
  return result;
}

// Vertices on curve edges of the finest level: on borders, or on creases.
std::vector<uint32_t> CurveVertices(const Topology& t, bool border) {
  std::vector<uint8_t> on(t.num_vertices, 0);
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    if (t.on_curve[e] && t.is_border(e) == border) on[t.edges[e][0]] = on[t.edges[e][1]] = 1;
  }
  std::vector<uint32_t> vertices;
  for (uint32_t v = 0; v < on.size(); ++v) {
    if (on[v]) vertices.push_back(v);
  }
  return vertices;
}

// Distance of the second smallest kind: how far a point of the unit cube is from the nearest of its twelve edges.
double OffCubeEdges(const Vec3f& p) {
  std::array<double, 3> off;
  for (int c = 0; c < 3; ++c) off[c] = std::min(std::fabs(p[c]), std::fabs(p[c] - 1));
  std::sort(off.begin(), off.end());
  return off[1];
}

double OffUnitSquare(const Vec3f& p) {
  const double x = std::min(std::fabs(p.x), std::fabs(p.x - 1)), y = std::min(std::fabs(p.y), std::fabs(p.y - 1));
  return std::max<double>(std::min(x, y), std::fabs(p.z));
}

size_t NumAt(const std::vector<Vec3f>& positions, const Vec3f& p) {
  return static_cast<size_t>(std::count_if(positions.begin(), positions.end(), [&](const Vec3f& q) { return Norm(q - p) < 1e-6f; }));
}

TEST(PierceCurves, ASquareKeepsItsStraightBorderAndCorners) {
  for (const float height : {0.0f, 0.3f}) {
    const Remeshed r = RemeshOf(shapes::GridWithBorder(32, 32, height), 40, 3, false);
    const std::vector<uint32_t> border = CurveVertices(r.finest, true);
    EXPECT_GE(border.size(), 4u * 8);
    for (const uint32_t v : border) EXPECT_LT(OffUnitSquare(r.positions()[v]), 1e-6) << v;
    for (const Vec3f& corner : {Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{1, 1, 0}}) {
      EXPECT_EQ(NumAt(r.positions(), corner), 1u);
    }
    // The rest is inside.
    EXPECT_EQ(border.size(), static_cast<size_t>(std::count_if(r.positions().begin(), r.positions().end(), [](const Vec3f& p) {
                return OffUnitSquare(p) < 1e-6;
              })));
    const SurfaceDistance d = MeasureSurfaceDistance(r.parts.refined, r.Surface()).value();
    EXPECT_LT(d.Rms(), height == 0 ? 1e-6 : 3e-3);
    EXPECT_GE(d.Rms(), height == 0 ? 0 : 1e-5);
  }
}

TEST(PierceCurves, CurveVerticesAreFoundOnCurves) {
  const Remeshed r = RemeshOf(shapes::GridWithBorder(32, 32, 0.3f), 40, 3, false);
  std::vector<uint32_t> expected = CurveVertices(r.finest, true), found;
  const uint32_t num_base = r.mesh.mesh.num_base_vertices;
  expected.erase(expected.begin(), std::lower_bound(expected.begin(), expected.end(), num_base));
  for (uint32_t i = 0; i < r.mesh.piercing.size(); ++i) {
    if (r.mesh.piercing[i] == PiercingKind::kCurve) found.push_back(num_base + i);
  }
  EXPECT_EQ(found, expected);
}

TEST(PierceCurves, ABoxStaysABox) {
  for (const bool fit : {false, true}) {
    const Remeshed r = RemeshOf(shapes::CreasedBox(12), 8, 3, fit);
    EXPECT_EQ(r.mesh.mesh.num_base_vertices, 8u) << "the corners are enough";
    const std::vector<uint32_t> creases = CurveVertices(r.finest, false);
    EXPECT_EQ(creases.size(), 8u + 12 * 7);
    for (const uint32_t v : creases) EXPECT_LT(OffCubeEdges(r.positions()[v]), 1e-6) << v;
    const SurfaceDistance d = MeasureSurfaceDistance(r.parts.refined, r.Surface()).value();
    EXPECT_LT(d.Hausdorff(), 1e-6);
    EXPECT_EQ(NormalShare(r.mesh), 1.0);
  }
}

// Manifold, Euler characteristic and number of border edges' polygons at every level.
void ExpectTopology(const Remeshed& r, int euler, int borders) {
  for (int level = 0; level <= r.mesh.mesh.num_levels; ++level) {
    const TriangleMesh mesh = MeshAtLevel(r.mesh.mesh, level).value();
    const StatusOr<Topology> built = BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles);
    ASSERT_TRUE(built.ok()) << built.status().message();
    const Topology& t = built.value();
    EXPECT_EQ(static_cast<int>(t.num_vertices) - static_cast<int>(t.num_edges()) + static_cast<int>(t.num_faces()), euler);
    std::map<uint32_t, uint32_t> next;
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      if (!t.is_border(e)) continue;
      const uint32_t f = t.edge_faces[e][0];
      const int k = EdgeCorner(t, f, e);
      next[t.triangles[f][(k + 1) % 3]] = t.triangles[f][(k + 2) % 3];
    }
    int polygons = 0;
    while (!next.empty()) {
      ++polygons;
      for (auto at = next.begin(); at != next.end();) {
        const uint32_t to = at->second;
        next.erase(at);
        at = next.find(to);
      }
    }
    EXPECT_EQ(polygons, borders);
  }
}

TEST(PierceCurves, APuncturedSphereKeepsItsHole) {
  const Remeshed r = RemeshOf(shapes::PuncturedSphere(4), 40, 3, false);
  ExpectTopology(r, 1, 1);
  for (const Vec3f& p : r.positions()) {
    EXPECT_LE(Norm(p), 1.0f + 1e-5f);
    EXPECT_GT(Norm(p), 0.99f);
  }
  EXPECT_GT(NormalShare(r.mesh), 0.95);
}

TEST(PierceCurves, EveryCaseIsCloseToItsInput) {
  struct Case {
    const char* name;
    TriangleMesh mesh;
    int euler, borders;
    double min_psnr, max_psnr;
  };
  const Case cases[] = {{"plate with holes", shapes::TwoHoledPlate(6), -2, 0, 100, 200},
                        {"touching boxes", shapes::TouchingBoxes(8), 4, 0, 100, 200},
                        {"double sheet", shapes::DoubleSheet(16, 16), 2, 2, 60, 80},
                        {"bumps beside a sheet", Together(shapes::BumpySphere(4), Moved(shapes::GridWithBorder(20, 20, 0.3f), {3, 0, 0})), 3, 1, 50, 80}};
  for (const Case& c : cases) {
    for (const bool fit : {false, true}) {
      SCOPED_TRACE(c.name + std::string(fit ? ", fitted" : ""));
      const Remeshed r = RemeshOf(c.mesh, 60, 3, fit);
      const SurfaceDistance d = MeasureSurfaceDistance(r.parts.refined, r.Surface()).value();
      const double psnr = Psnr(d.Rms(), BoundingBoxDiagonal(r.parts.refined));
      EXPECT_GE(psnr, c.min_psnr);
      EXPECT_LE(psnr, c.max_psnr);
      ExpectTopology(r, c.euler, c.borders);
    }
  }
}

// Borders along a cut: what decoders join lies at the same places already.
TEST(PierceCurves, BothSidesOfACutPassThroughTheSamePoints) {
  const Remeshed r = RemeshOf(shapes::DoubleSheet(16, 16), 100, 3, false);
  const std::vector<uint32_t> border = CurveVertices(r.finest, true);
  EXPECT_EQ(border.size(), 2u * 64 * 8) << "each vertex of the rim is kept";
  for (const uint32_t v : border) {
    EXPECT_TRUE(std::any_of(border.begin(), border.end(), [&](uint32_t w) {
      return w != v && Norm(r.positions()[w] - r.positions()[v]) < 1e-6f;
    })) << v;
  }
}

// How far midpoints of the curves stray from the middle of their edge, in lengths of it, as decoders number them: the farthest.
double FarthestFromMiddle(const NormalMesh& mesh) {
  Topology t = BuildTopology(mesh.mesh.num_base_vertices, mesh.mesh.base_triangles, mesh.mesh.tags).value();
  double farthest = 0;
  for (int level = 0; level < mesh.mesh.num_levels; ++level) {
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      if (!t.on_curve[e]) continue;
      const Vec3f &a = mesh.mesh.positions[t.edges[e][0]], &b = mesh.mesh.positions[t.edges[e][1]];
      const double off = Norm(mesh.mesh.positions[t.num_vertices + e] - (a + b) * 0.5f) / Norm(b - a);
      farthest = std::max(farthest, off);
    }
    t = Refine(t);
  }
  return farthest;
}

// Copies of an edge run as their master does, so their halves are numbered otherwise than without it: piercing has to know. Two sheets
// side by side, whose borders run against each other.
TEST(PierceCurves, BothSidesOfACutNumberTheirHalvesAlike) {
  const TriangleMesh sheet = shapes::GridWithBorder(12, 12);
  const auto [low, high] = std::minmax_element(sheet.positions.begin(), sheet.positions.end(), [](const Vec3f& a, const Vec3f& b) { return a.x < b.x; });
  const float low_x = low->x, high_x = high->x;
  const TriangleMesh input = Together(sheet, lacerta::testing::Moved(sheet, {high_x - low_x, 0, 0}));
  const auto is_on_cut = [&](const Vec3f& p) { return std::fabs(p.x - high_x) < 1e-4f; };
  Topology topology = lacerta::testing::TopologyOf(input);
  for (uint32_t v = 0; v < topology.num_vertices; ++v) {
    if (is_on_cut(input.positions[v])) topology.role[v] = CurveRole::kCorner;
  }
  const CollapseHistory history = Decimate(input, topology, {40, 12, 0.2});
  const InputSurface surface(input, topology);
  BaseDomain domain(history, history.num_collapses());
  const std::vector<Vec3f> base = domain.PositionsOn(input);
  std::vector<uint32_t> joined(domain.num_vertices());
  size_t num_joined = 0;
  for (uint32_t v = 0; v < joined.size(); ++v) {
    joined[v] = v;
    for (uint32_t w = 0; w < v && joined[v] == v; ++w) {
      if (is_on_cut(base[v]) && Norm(base[v] - base[w]) < 1e-4f) joined[v] = w;
    }
    num_joined += joined[v] != v;
  }
  ASSERT_GE(num_joined, 12u);
  PiercingOptions options;
  options.num_levels = 3;
  NormalMesh too_late = Pierce(surface, domain, base, options);
  too_late.mesh.tags.joined = joined;
  EXPECT_GT(FarthestFromMiddle(too_late), 0.9) << "no copy runs against its master";
  domain.Join(joined);
  const NormalMesh mesh = Pierce(surface, domain, base, options);
  EXPECT_EQ(mesh.mesh.tags.joined, joined);
  EXPECT_LT(FarthestFromMiddle(mesh), 0.4);
}

}  // namespace
}  // namespace lacerta
