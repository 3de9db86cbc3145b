#include "remesh/attributed_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "remesh/wedge_mesh.h"
#include "shapes/attributed_shapes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

size_t CountSeams(const AttributedParts& parts, size_t attribute) {
  size_t count = 0;
  for (uint32_t e = 0; e < parts.topology.num_edges(); ++e) count += parts.seams[attribute][e] != 0 && !parts.topology.is_border(e);
  return count;
}

size_t CountRole(const AttributedParts& parts, CurveRole role) {
  return static_cast<size_t>(std::count(parts.topology.role.begin(), parts.topology.role.end(), role));
}

TEST(AttributedPartsTest, CutsOfATextureAndBordersOfGroupsAreCurves) {
  const StatusOr<AttributedParts> parts = SplitAttributedSurface(WeldSoups(shapes::HalvedTorus(40, 20)).value());
  ASSERT_TRUE(parts.ok()) << parts.status().message();
  EXPECT_EQ(CountSeams(parts.value(), 0), 40u + 20);
  EXPECT_EQ(CountSeams(parts.value(), 1), 0u);
  // The border of the groups at angle 0 is a cut of the texture, too, the one at pi is none.
  EXPECT_EQ(static_cast<size_t>(std::count(parts.value().topology.on_curve.begin(), parts.value().topology.on_curve.end(), 1)), 40u + 2 * 20);
  EXPECT_EQ(CountRole(parts.value(), CurveRole::kCorner), 2u);  // where these cross the cut around the axis
  EXPECT_EQ(CountRole(parts.value(), CurveRole::kCurve), 39u + 19 + 19 - 1);
}

TEST(AttributedPartsTest, ASlitStaysOpenInItsMiddle) {
  const StatusOr<AttributedParts> parts = SplitAttributedSurface(WeldSoups({shapes::SlitGrid(24)}).value());
  ASSERT_TRUE(parts.ok()) << parts.status().message();
  EXPECT_EQ(CountSeams(parts.value(), 0), 12u);
  std::vector<float> corners;  // those inside of the square
  for (uint32_t v = 0; v < parts.value().topology.num_vertices; ++v) {
    const Vec3f& p = parts.value().refined.surface.positions[v];
    const bool is_inside = p.x > 0.01f && p.x < 0.99f && p.y > 0.01f && p.y < 0.99f;
    if (is_inside && parts.value().topology.role[v] == CurveRole::kCorner) corners.push_back(p.x);
  }
  std::sort(corners.begin(), corners.end());
  ASSERT_EQ(corners.size(), 3u);
  EXPECT_FLOAT_EQ(corners[0], 0.25f);
  EXPECT_NEAR(corners[1], 0.5f, 0.05f);
  EXPECT_FLOAT_EQ(corners[2], 0.75f);
}

TEST(AttributedPartsTest, ACornerStandsWhereACreaseBecomesASeam) {
  // Two planes that meet at a right angle; along one half of the edge the texture is cut.
  VertexSoup soup = shapes::TexturedGrid(24, 24);
  for (Vec3f& p : soup.positions) {
    if (p.x > 0.5f) p = {0.5f, p.y, p.x - 0.5f};
  }
  soup.attributes.pop_back();  // the normals of the plane
  const AttributedMesh uncut = WeldSoups({soup}).value();
  AttributedMesh cut = uncut;
  MeshAttribute& texture = cut.attributes[0];
  for (size_t f = 0; f < texture.corners.size(); ++f) {
    const Triangle& t = cut.surface.triangles[f];
    const bool is_upright = std::any_of(t.begin(), t.end(), [&](uint32_t v) { return cut.surface.positions[v].z > 0; });
    for (size_t k = 0; k < 3; ++k) {
      const Vec3f& p = cut.surface.positions[t[k]];
      if (!is_upright || p.z > 0 || p.y > 0.51f) continue;
      texture.corners[f][k] = texture.num_values();
      texture.values.insert(texture.values.end(), {0.9f, p.y});
    }
  }
  WeldExactly(&cut);
  const auto corners_on_edge = [](const AttributedMesh& mesh) {
    const AttributedParts parts = SplitAttributedSurface(mesh).value();
    size_t count = 0;
    for (uint32_t v = 0; v < parts.topology.num_vertices; ++v) {
      const Vec3f& p = parts.refined.surface.positions[v];
      count += p.x == 0.5f && p.z == 0 && parts.topology.role[v] == CurveRole::kCorner;
    }
    return count;
  };
  EXPECT_EQ(corners_on_edge(uncut), 2u);
  EXPECT_EQ(corners_on_edge(cut), 3u);
}

TEST(AttributedPartsTest, SmallComponentsStandStillWithTheirValues) {
  std::vector<VertexSoup> soups = shapes::HalvedTorus(40, 20);
  VertexSoup box = shapes::TexturedBox(2);
  for (Vec3f& p : box.positions) p += Vec3f{3, 0, 0};
  soups.push_back(std::move(box));
  const AttributedParts parts = SplitAttributedSurface(WeldSoups(soups).value()).value();
  EXPECT_EQ(parts.refined.surface.triangles.size(), 2u * 40 * 20);
  ASSERT_EQ(parts.still.surface.triangles.size(), 48u);
  for (size_t f = 0; f < 48; ++f) {
    EXPECT_EQ(parts.still.GroupOf(f), 2u);
    const Vec3f& p = parts.still.surface.positions[parts.still.surface.triangles[f][0]];
    const float* uv = &parts.still.attributes[0].values[2 * size_t{parts.still.attributes[0].corners[f][0]}];
    EXPECT_GE(p.x, 3.0f);
    EXPECT_TRUE(uv[0] == p.x - 3 || uv[0] == p.y || uv[0] == p.z);
  }
}

TEST(AttributedPartsTest, SurfacesThatAreAllSeamsAreRefused) {
  // Flat shading: every triangle has its own normal.
  AttributedMesh mesh = WeldSoups({VertexSoup{shapes::Icosphere(3).positions, shapes::Icosphere(3).triangles, {}}}).value();
  EXPECT_TRUE(SplitAttributedSurface(mesh).ok());
  MeshAttribute normals{"NORMAL", AttributeKind::kNormal, 3, {}, {}};
  for (uint32_t f = 0; f < mesh.surface.triangles.size(); ++f) {
    const Triangle& t = mesh.surface.triangles[f];
    const auto& p = mesh.surface.positions;
    const Vec3f n = Normalized(Cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
    normals.values.insert(normals.values.end(), {n.x, n.y, n.z});
    normals.corners.push_back({f, f, f});
  }
  mesh.attributes.push_back(normals);
  const StatusOr<AttributedParts> refused = SplitAttributedSurface(mesh);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.status().code(), StatusCode::kUnsupported);
  EXPECT_NE(refused.status().message().find("seams"), std::string::npos);
}

TEST(AttributedPartsTest, TrianglesThatLookTheOtherWayAreRefused) {
  AttributedMesh mesh = WeldSoups(shapes::HalvedTorus(40, 20)).value();
  std::swap(mesh.surface.triangles[7][0], mesh.surface.triangles[7][1]);
  for (MeshAttribute& attribute : mesh.attributes) std::swap(attribute.corners[7][0], attribute.corners[7][1]);
  EXPECT_EQ(SplitAttributedSurface(mesh).status().code(), StatusCode::kUnsupported);
}

TEST(AttributedPartsTest, WedgesEndAtSeamsAlone) {
  const AttributedParts parts = SplitAttributedSurface(WeldSoups(shapes::HalvedTorus(40, 20)).value()).value();
  std::vector<uint32_t> texture = FindWedges(parts.topology, parts.seams[0]), normals = FindWedges(parts.topology, parts.seams[1]);
  const auto count = [](std::vector<uint32_t> wedges) {
    std::sort(wedges.begin(), wedges.end());
    return static_cast<size_t>(std::unique(wedges.begin(), wedges.end()) - wedges.begin());
  };
  EXPECT_EQ(count(normals), 40u * 20);
  EXPECT_EQ(count(texture), 41u * 21);
}

}  // namespace
}  // namespace lacerta
