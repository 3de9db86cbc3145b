#include "remesh/attributed_remesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "geometry/triangle_tree.h"
#include "lacerta/surface_distance.h"
#include "remesh/level_wedges.h"
#include "remesh/simplify_to_errors.h"
#include "shapes/attributed_shapes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

struct Shape {
  std::string name;
  AttributedMesh mesh;
  uint32_t num_base_vertices;
  int num_levels;
  double least_psnr;
  double most_texels, most_degrees;  // rms over 99 %
};

// A box whose texture and normals are cut at all edges and whose sides are groups, with a torus of two groups beside it.
AttributedMesh BoxBesideTorus() {
  std::vector<VertexSoup> soups = shapes::HalvedTorus(48, 24);
  VertexSoup box = shapes::TexturedBox(12);
  for (Vec3f& p : box.positions) p += Vec3f{2, 0, 0};
  soups.push_back(std::move(box));
  return WeldSoups(soups).value();
}

std::vector<Shape> Shapes() {
  std::vector<Shape> result;
  result.push_back({"torus", WeldSoups(shapes::HalvedTorus(64, 32)).value(), 0, 3, 60, 1.5, 1.5});
  result.push_back({"slit", WeldSoups({shapes::SlitGrid(32, 0.2f)}).value(), 0, 3, 60, 2, 2});
  result.push_back({"box", WeldSoups({shapes::TexturedBox(12)}).value(), 0, 2, 100, 0.05, 0.05});
  result.push_back({"cylinder", WeldSoups({shapes::Cylinder(48, 24)}).value(), 0, 3, 60, 2, 2});
  result.push_back({"box beside torus", BoxBesideTorus(), 100, 3, 60, 1.5, 1.5});
  return result;
}

StatusOr<AttributedNormalMesh> Remesh(const AttributedMesh& mesh, const AttributedRemeshOptions& options) {
  LACERTA_ASSIGN_OR_RETURN(const AttributedParts parts, SplitAttributedSurface(mesh));
  LACERTA_ASSIGN_OR_RETURN(const CollapseHistory history, DecimateAttributed(parts));
  const InputSurface surface(parts.refined.surface, parts.topology);
  return RemeshAttributed(parts, surface, history, options);
}

AttributedSemiRegularMesh Remeshed(const AttributedMesh& mesh, int num_levels, uint32_t num_base_vertices) {
  AttributedRemeshOptions options;
  options.num_levels = num_levels;
  options.num_base_vertices = num_base_vertices;
  const StatusOr<AttributedNormalMesh> remesh = Remesh(mesh, options);
  EXPECT_TRUE(remesh.ok()) << remesh.status().message();
  return remesh.value().Semiregular();
}

// Length of the edges at which the attribute is not continuous, borders of the surface aside, and of borders of groups.
double SeamLength(const AttributedMesh& mesh, size_t attribute) {
  const Topology topology = BuildTopology(static_cast<uint32_t>(mesh.surface.positions.size()), mesh.surface.triangles).value();
  double length = 0;
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    if (topology.is_border(e)) continue;
    const auto& [f, g] = topology.edge_faces[e];
    bool is_seam = false;
    for (const uint32_t v : topology.edges[e]) {
      const auto row = [&](uint32_t face) {
        const Triangle& t = mesh.surface.triangles[face];
        return mesh.attributes[attribute].corners[face][t[0] == v ? 0 : t[1] == v ? 1 : 2];
      };
      is_seam = is_seam || row(f) != row(g);
    }
    const auto& p = mesh.surface.positions;
    if (is_seam) length += static_cast<double>(Norm(p[topology.edges[e][1]] - p[topology.edges[e][0]]));
  }
  return length;
}

std::vector<double> GroupAreas(const AttributedMesh& mesh) {
  std::vector<double> areas;
  for (size_t f = 0; f < mesh.surface.triangles.size(); ++f) {
    const Triangle& t = mesh.surface.triangles[f];
    const auto& p = mesh.surface.positions;
    areas.resize(std::max(areas.size(), size_t{mesh.GroupOf(f)} + 1), 0.0);
    areas[mesh.GroupOf(f)] += static_cast<double>(Norm(Cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]))) / 2;
  }
  return areas;
}

TEST(AttributedRemeshTest, TheFinestLevelIsNearTheInputInAllAttributes) {
  for (const Shape& shape : Shapes()) {
    SCOPED_TRACE(shape.name);
    AttributedSemiRegularMesh remesh = Remeshed(shape.mesh, shape.num_levels, shape.num_base_vertices);
    const SurfaceErrorMeter meter = SurfaceErrorMeter::Create(shape.mesh).value();
    for (const bool is_fitted : {false, true}) {
      SCOPED_TRACE(is_fitted ? "fitted" : "sampled");
      if (is_fitted) FitLevelAttributes(GroupSurface(shape.mesh), &remesh);
      const AttributedMesh finest = FinestLevel(remesh);
      ASSERT_TRUE(CheckAttributedMesh(finest).ok());
      const SurfaceErrors errors = meter.Measure(finest, 20'000).value();
      EXPECT_GT(Psnr(errors.distance, meter.diagonal()), shape.least_psnr);
      EXPECT_LT(errors.attributes[0].rms_99, shape.most_texels);
      EXPECT_LT(errors.attributes[0].rms, 2 * shape.most_texels);
      EXPECT_LT(errors.attributes[1].rms_99, shape.most_degrees);
      EXPECT_EQ(errors.turned, 0);
    }
  }
}

// They slide over the input, and are not where its vertices are.
TEST(AttributedRemeshTest, BaseVerticesHaveTheValuesOfTheInputWhereTheyStand) {
  for (const Shape& shape : Shapes()) {
    SCOPED_TRACE(shape.name);
    const AttributedSemiRegularMesh remesh = Remeshed(shape.mesh, shape.num_levels, shape.num_base_vertices);
    const TriangleTree tree(shape.mesh.surface);
    const float near = static_cast<float>(6e-3 * BoundingBoxDiagonal(shape.mesh.surface));  // the fit moves them off the input
    size_t between = 0;  // vertices of the input
    for (size_t f = 0; f < remesh.surface.base_triangles.size(); ++f) {
      for (size_t k = 0; k < 3; ++k) {
        const MeshAttribute& input = shape.mesh.attributes[0];
        const LevelAttribute& base = remesh.attributes[0];
        const float* value = &base.values[size_t{base.base_corners[f][k]} * base.components];
        std::vector<ClosestPointResult> places;
        tree.PointsNear(remesh.surface.positions[remesh.surface.base_triangles[f][k]], near * near, 64, &places);
        ASSERT_FALSE(places.empty());
        double least = 1;
        for (const ClosestPointResult& place : places) {
          double square = 0;
          for (uint32_t c = 0; c < input.components; ++c) {
            double expected = 0;
            for (size_t j = 0; j < 3; ++j) expected += static_cast<double>(place.point.barycentric[j] * input.values[size_t{input.corners[place.point.face][j]} * input.components + c]);
            square += (value[c] - expected) * (value[c] - expected);
          }
          least = std::min(least, std::sqrt(square));
        }
        EXPECT_LT(least, 0.002);
        const auto& weights = places[0].point.barycentric;
        between += *std::max_element(weights.begin(), weights.end()) < 0.99f;
      }
    }
    EXPECT_GE(between, shape.name == "torus" ? 20u : 0u);
  }
}

TEST(AttributedRemeshTest, SeamsAndGroupsKeepTheirPlaces) {
  for (const Shape& shape : Shapes()) {
    SCOPED_TRACE(shape.name);
    const AttributedMesh finest = FinestLevel(Remeshed(shape.mesh, shape.num_levels, shape.num_base_vertices));
    for (size_t a = 0; a < 2; ++a) {
      const double expected = SeamLength(shape.mesh, a);
      EXPECT_NEAR(SeamLength(finest, a), expected, 0.02 * expected) << shape.mesh.attributes[a].name;
    }
    const std::vector<double> areas = GroupAreas(finest), expected = GroupAreas(shape.mesh);
    ASSERT_EQ(areas.size(), expected.size());
    for (size_t g = 0; g < areas.size(); ++g) EXPECT_NEAR(areas[g], expected[g], 0.02 * expected[g]);
  }
}

// Where one value stands at two vertices of the surface, or a level has other wedges than the one below, decoders would not find it.
TEST(AttributedRemeshTest, WedgeMeshesLieOnTheSurfaceAtEveryLevel) {
  for (const Shape& shape : Shapes()) {
    SCOPED_TRACE(shape.name);
    const AttributedSemiRegularMesh remesh = Remeshed(shape.mesh, shape.num_levels, shape.num_base_vertices);
    Topology surface = BuildTopology(remesh.surface.num_base_vertices, remesh.surface.base_triangles).value();
    ASSERT_EQ(remesh.base_groups.size(), remesh.surface.base_triangles.size());
    for (int level = 0; level <= shape.num_levels; ++level) {
      if (level > 0) surface = Refine(surface);
      for (const LevelAttribute& attribute : remesh.attributes) {
        const std::vector<Triangle> wedges = WedgeTriangles(remesh.surface, attribute, level);
        ASSERT_EQ(wedges.size(), surface.triangles.size());
        std::vector<uint32_t> vertex_of;
        for (size_t f = 0; f < wedges.size(); ++f) {
          for (size_t k = 0; k < 3; ++k) {
            const uint32_t row = wedges[f][k];
            if (row >= vertex_of.size()) vertex_of.resize(row + 1, kNone);
            if (vertex_of[row] == kNone) vertex_of[row] = surface.triangles[f][k];
            ASSERT_EQ(vertex_of[row], surface.triangles[f][k]);
          }
        }
        EXPECT_EQ(std::count(vertex_of.begin(), vertex_of.end(), kNone), 0);
        if (level == shape.num_levels) {
          EXPECT_EQ(vertex_of.size() * attribute.components, attribute.values.size());
        }
      }
    }
  }
}

TEST(AttributedRemeshTest, BordersOfGroupsAreTheSameVertices) {
  const AttributedMesh finest = FinestLevel(Remeshed(BoxBesideTorus(), 2, 100));
  const std::vector<VertexSoup> soups = SplitIntoSoups(finest, 3);
  std::set<std::vector<float>> first;
  for (const Vec3f& p : soups[0].positions) first.insert({p.x, p.y, p.z});
  size_t num_common = 0;
  std::set<std::vector<float>> second;
  for (const Vec3f& p : soups[1].positions) second.insert({p.x, p.y, p.z});
  for (const std::vector<float>& p : second) num_common += first.count(p);
  // Two circles of at least three base edges, each split in four.
  EXPECT_GE(num_common, 2u * 3 * 4);
  EXPECT_LT(num_common, first.size() / 3);
}

TEST(AttributedRemeshTest, StillPartsKeepTheirTriangles) {
  std::vector<VertexSoup> soups = shapes::HalvedTorus(48, 24);
  VertexSoup box = shapes::TexturedBox(2);
  for (Vec3f& p : box.positions) p += Vec3f{3, 0, 0};
  soups.push_back(std::move(box));
  const AttributedMesh mesh = WeldSoups(soups).value();
  AttributedRemeshOptions options;
  options.num_levels = 3;
  // A coder that wants everything the other way around.
  options.order = [](const TriangleMesh& base) -> StatusOr<BaseOrder> {
    BaseOrder order;
    const auto count = static_cast<uint32_t>(base.positions.size());
    for (uint32_t v = 0; v < count; ++v) order.vertex_map.push_back(count - 1 - v);
    for (auto t = base.triangles.rbegin(); t != base.triangles.rend(); ++t) {
      order.triangles.push_back({count - 1 - (*t)[1], count - 1 - (*t)[2], count - 1 - (*t)[0]});
    }
    return order;
  };
  const AttributedNormalMesh remesh = Remesh(mesh, options).value();
  const AttributedMesh finest = FinestLevel(remesh.Semiregular());
  ASSERT_TRUE(CheckAttributedMesh(finest).ok());
  EXPECT_EQ((finest.surface.triangles.size() - 48) % 64, 0u);
  EXPECT_NEAR(GroupAreas(finest)[2], 6.0, 1e-5);
  const SurfaceErrorMeter meter = SurfaceErrorMeter::Create(mesh).value();
  const SurfaceErrors errors = meter.Measure(finest, 20'000).value();
  EXPECT_GT(Psnr(errors.distance, meter.diagonal()), 60);
  EXPECT_LT(errors.attributes[0].rms, 3);
  EXPECT_LT(errors.attributes[1].rms_99, 2);
}

TEST(AttributedRemeshTest, ABaseOfTooManySeamsIsRefused) {
  // Seams all over, but none that meet: rings around the torus.
  constexpr int kAround = 26, kTube = 20;
  AttributedMesh mesh = WeldSoups(shapes::HalvedTorus(kAround, kTube)).value();
  mesh.attributes.clear();
  mesh.groups.clear();
  for (size_t f = 0; f < mesh.surface.triangles.size(); ++f) mesh.groups.push_back(static_cast<uint32_t>((f / 2) % (kAround / 2) % 2));
  const StatusOr<AttributedParts> parts = SplitAttributedSurface(mesh);
  ASSERT_TRUE(parts.ok()) << parts.status().message();
  const Status status = DecimateAttributed(parts.value()).status();
  EXPECT_EQ(status.code(), StatusCode::kUnsupported);
  EXPECT_NE(status.message().find("base mesh"), std::string::npos);
}

}  // namespace
}  // namespace lacerta
