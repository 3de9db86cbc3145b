#include "remesh/surface_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "draco_ext/remesh/remeshing.h"
#include "remesh/base_parts.h"

namespace lacerta {
namespace {

using lacerta::testing::Moved;
using lacerta::testing::Tetrahedron;

size_t NumCorners(const Topology& t) {
  return static_cast<size_t>(std::count(t.role.begin(), t.role.end(), CurveRole::kCorner));
}

TEST(SplitSurface, OneClosedSurfaceIsRefinedAsItIs) {
  const TriangleMesh mesh = shapes::BumpySphere(3);
  const SurfaceParts parts = SplitSurface(mesh);
  EXPECT_EQ(parts.refined.positions, mesh.positions);
  EXPECT_EQ(parts.refined.triangles, mesh.triangles);
  EXPECT_TRUE(parts.still.triangles.empty());
  EXPECT_TRUE(parts.still.positions.empty());
  std::vector<uint32_t> all(mesh.positions.size());
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(parts.source_vertex, all);
  EXPECT_EQ(parts.refined_components, 1u);
  EXPECT_EQ(parts.still_components, 0u);
  EXPECT_EQ(parts.topology.num_faces(), mesh.triangles.size());
  EXPECT_EQ(std::count(parts.topology.on_curve.begin(), parts.topology.on_curve.end(), 1), 0);
}

TEST(SplitSurface, SmallComponentsStandStill) {
  const TriangleMesh large = shapes::BumpySphere(3);  // 1280 triangles
  TriangleMesh mesh = Together(Tetrahedron(), Moved(large, {5, 0, 0}));
  mesh = Together(mesh, Moved(shapes::Icosphere(2), {0, 5, 0}));  // 320
  const SurfaceParts parts = SplitSurface(mesh);
  EXPECT_EQ(parts.refined_components, 1u);
  EXPECT_EQ(parts.still_components, 2u);
  EXPECT_EQ(parts.refined.triangles.size(), 1280u);
  EXPECT_EQ(parts.still.triangles.size(), 324u);
  EXPECT_EQ(parts.refined.positions, Moved(large, {5, 0, 0}).positions);
  EXPECT_EQ(parts.still.positions.size(), 4u + 162u);
  for (uint32_t v = 0; v < parts.source_vertex.size(); ++v) EXPECT_EQ(parts.source_vertex[v], v + 4);
}

TEST(SplitSurface, TheFewestFacesCount) {
  const TriangleMesh mesh = Together(shapes::Icosphere(2), Moved(shapes::Icosphere(3), {5, 0, 0}));
  const auto refined = [&](uint32_t fewest) { return SplitSurface(mesh, {fewest}).refined.triangles.size(); };
  EXPECT_EQ(refined(320), 1600u);
  EXPECT_EQ(refined(321), 1280u);
  EXPECT_EQ(refined(1280), 1280u);
  EXPECT_EQ(refined(1281), 0u);
}

TEST(SplitSurface, NothingMayBeWorthRefining) {
  const SurfaceParts parts = SplitSurface(Tetrahedron());
  EXPECT_TRUE(parts.refined.triangles.empty());
  EXPECT_TRUE(parts.source_vertex.empty());
  EXPECT_EQ(parts.topology.num_faces(), 0u);
  EXPECT_EQ(parts.still.triangles.size(), 4u);
  EXPECT_EQ(parts.still_components, 1u);
}

TEST(SplitSurface, FindsCreasesAndCorners) {
  const SurfaceParts box = SplitSurface(shapes::CreasedBox(10));
  EXPECT_EQ(std::count(box.topology.on_curve.begin(), box.topology.on_curve.end(), 1), 120);
  EXPECT_EQ(NumCorners(box.topology), 8u);
  const SurfaceParts grid = SplitSurface(shapes::GridWithBorder(20, 20, 0.3f));
  EXPECT_EQ(std::count(grid.topology.on_curve.begin(), grid.topology.on_curve.end(), 1), 80);
  EXPECT_EQ(NumCorners(grid.topology), 4u);
}

TEST(SplitSurface, CopiesOfACutAreCorners) {
  const SurfaceParts parts = SplitSurface(shapes::TouchingBoxes(8), {1});
  EXPECT_GT(parts.report.cut_edges, 0u);
  std::map<uint32_t, std::vector<uint32_t>> copies;
  for (uint32_t v = 0; v < parts.source_vertex.size(); ++v) copies[parts.source_vertex[v]].push_back(v);
  size_t num_copied = 0;
  for (const auto& [source, vertices] : copies) {
    if (vertices.size() == 1) continue;
    ++num_copied;
    for (const uint32_t v : vertices) {
      EXPECT_EQ(parts.topology.role[v], CurveRole::kCorner);
      EXPECT_EQ(parts.refined.positions[v], parts.refined.positions[vertices[0]]);
    }
  }
  EXPECT_EQ(num_copied, parts.report.split_vertices);
  EXPECT_GE(num_copied, 7u);
  EXPECT_LE(num_copied, 9u);  // of 8 edges in a row, perhaps without its ends
}

// Two sheets in one plane that touch at the ends of a row of vertices and are apart between them, as far as `apart` says.
TriangleMesh SheetsThatTouchTwice(float apart) {
  const TriangleMesh sheet = shapes::GridWithBorder(20, 20);
  const auto side = [&](float sign) {
    TriangleMesh mesh = sheet;
    for (Vec3f& p : mesh.positions) p.y = sign * (p.y + (p.x > 0 && p.x < 1 ? apart : 0.0f));
    for (Triangle& t : mesh.triangles) {
      if (sign < 0) std::swap(t[1], t[2]);
    }
    return mesh;
  };
  return Clean(Together(side(1), side(-1))).value().mesh;
}

TEST(SplitSurface, BordersThatShareOnlyTheirEndsGetACornerBetween) {
  const SurfaceParts parts = SplitSurface(SheetsThatTouchTwice(0.02f));
  ASSERT_EQ(parts.report.split_vertices, 2u);
  std::vector<float> middles;
  for (uint32_t v = 0; v < parts.topology.num_vertices; ++v) {
    const Vec3f& p = parts.refined.positions[v];
    if (parts.topology.role[v] == CurveRole::kCorner && p.x > 0.25f && p.x < 0.75f) middles.push_back(p.y);
  }
  ASSERT_EQ(middles.size(), 1u) << "of one of the two borders between both points, and not of the long ways round, which have corners";
  EXPECT_FLOAT_EQ(std::fabs(middles[0]), 0.02f);
}

TEST(SplitSurface, TakesEveryShape) {
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    SCOPED_TRACE(shape.name);
    const TriangleMesh cleaned = Clean(shape.mesh).value().mesh;
    for (const uint32_t fewest : {1u, 500u}) {
      const SurfaceParts parts = SplitSurface(cleaned, {fewest});
      EXPECT_EQ(parts.refined.triangles.size() + parts.still.triangles.size(), cleaned.triangles.size());
      EXPECT_EQ(parts.refined_components + parts.still_components, parts.report.components);
      EXPECT_EQ(parts.source_vertex.size(), parts.refined.positions.size());
      for (uint32_t v = 0; v < parts.source_vertex.size(); ++v) {
        EXPECT_EQ(parts.refined.positions[v], cleaned.positions[parts.source_vertex[v]]);
      }
    }
  }
}

}  // namespace
}  // namespace lacerta
