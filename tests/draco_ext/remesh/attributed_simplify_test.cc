#include "remesh/attributed_simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "geometry/facing.h"
#include "geometry/vertex_area_vectors.h"
#include "lacerta/attribute_distance.h"
#include "lacerta/surface_distance.h"
#include "shapes/attributed_shapes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

// A texel of 1024 or two degrees as bad as 1/1000 of the diagonal.
constexpr double kTexture = 1.0, kNormal = 0.03;

AttributedMesh Weld(const std::vector<VertexSoup>& soups) { return WeldSoups(soups).value(); }

AttributeDistance Distance(const AttributedMesh& a, const AttributedMesh& b) {
  return AttributeDistanceMeter::Create(a).value().Measure(b).value();
}

double PositionError(const AttributedMesh& a, const AttributedMesh& b) { return MeasureSurfaceDistance(a.surface, b.surface).value().Rms(); }

size_t CountEdges(const AttributedMesh& mesh, int num_triangles) {
  std::map<std::pair<uint32_t, uint32_t>, int> count;
  for (const Triangle& t : mesh.surface.triangles) {
    for (size_t k = 0; k < 3; ++k) ++count[std::minmax(t[k], t[(k + 1) % 3])];
  }
  return static_cast<size_t>(std::count_if(count.begin(), count.end(), [&](const auto& edge) { return edge.second == num_triangles; }));
}

size_t CountBorderEdges(const AttributedMesh& mesh) { return CountEdges(mesh, 1); }

// A floor of 2 n x n squares, and a wall of n x n that stands on a wavy line of it.
TriangleMesh WallOnAFloor(uint32_t n) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i <= 3 * n; ++i) {  // rows of the floor, then of the wall
    for (uint32_t j = 0; j <= n; ++j) {
      const auto x = static_cast<float>(i) / static_cast<float>(n) - 1, y = static_cast<float>(j) / static_cast<float>(n);
      const float wave = 0.1f * std::sin(5 * y);
      mesh.positions.push_back(i <= 2 * n ? Vec3f{x + wave, y, 0} : Vec3f{wave, y, x - 1});
    }
  }
  for (uint32_t i = 0; i < 3 * n; ++i) {
    for (uint32_t j = 0; j < n; ++j) {
      const uint32_t a = (i == 2 * n ? n : i) * (n + 1) + j, b = (i + 1) * (n + 1) + j;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return mesh;
}

// Doubled, in the texture.
double LeastTextureArea(const AttributedMesh& mesh, size_t attribute) {
  double least = INFINITY;
  for (const Triangle& t : mesh.attributes[attribute].corners) {
    const float* values = mesh.attributes[attribute].values.data();
    const auto at = [&](size_t k, size_t i) { return static_cast<double>(values[2 * t[k] + i]); };
    least = std::min(least, (at(1, 0) - at(0, 0)) * (at(2, 1) - at(0, 1)) - (at(1, 1) - at(0, 1)) * (at(2, 0) - at(0, 0)));
  }
  return least;
}

TEST(AttributedSimplificationTest, TheWholeSequenceBeginsWithTheInput) {
  for (const VertexSoup& soup : {shapes::Cylinder(24, 8), shapes::TexturedBox(4), shapes::TexturedGrid(9, 7, 0.2f)}) {
    const AttributedMesh mesh = Weld({soup});
    const AttributedSimplification sequence(mesh, {kTexture, kNormal});
    const AttributedMesh all = sequence.MeshWith(sequence.num_input_triangles());
    EXPECT_EQ(all.surface.positions, mesh.surface.positions);
    EXPECT_EQ(all.surface.triangles, mesh.surface.triangles);
    for (size_t a = 0; a < 2; ++a) {
      EXPECT_EQ(all.attributes[a].num_values(), mesh.attributes[a].num_values());
      EXPECT_LT(Distance(mesh, all).Worst(a).max, 0.01);
    }
  }
}

TEST(AttributedSimplificationTest, ABoxGoesToTwoTrianglesASide) {
  const AttributedMesh mesh = Weld({shapes::TexturedBox(8)});
  const AttributedSimplification sequence(mesh, {kTexture, kNormal});
  const AttributedMesh box = sequence.MeshWith(12);
  ASSERT_EQ(box.surface.triangles.size(), 12u);
  EXPECT_EQ(box.surface.positions.size(), 8u);
  EXPECT_LT(PositionError(mesh, box), 1e-6);
  EXPECT_LT(Distance(mesh, box).Worst(0).max, 0.1);   // texels
  EXPECT_LT(Distance(mesh, box).Worst(1).max, 0.01);  // degrees
}

TEST(AttributedSimplificationTest, APlaneKeepsWhatItsTextureNeeds) {
  // The same plane with a linear texture and with one that is bent along x: only the second one needs more than the two triangles.
  VertexSoup flat = shapes::TexturedGrid(40, 40);
  flat.attributes.pop_back();
  VertexSoup bent = flat;
  std::vector<float>& values = bent.attributes[0].values;
  for (size_t i = 0; i < values.size(); i += 2) values[i] = values[i] * values[i];
  const AttributedMesh flat_mesh = Weld({flat}), bent_mesh = Weld({bent});
  const AttributedSimplification flat_sequence(flat_mesh, {kTexture}), bent_sequence(bent_mesh, {kTexture});
  EXPECT_LT(Distance(flat_mesh, flat_sequence.MeshWith(40)).Worst(0).rms, 0.2);
  const double error = Distance(bent_mesh, bent_sequence.MeshWith(40)).Worst(0).rms;
  // Straight pieces between 21 columns, the best that 40 triangles can do, are off by (1/20)^2 / sqrt(180), times 1024.
  EXPECT_GT(error, 0.19);
  EXPECT_LT(error, 0.4);
  // Where the texture counts for nothing, its error is larger.
  const AttributedSimplification careless(bent_mesh, {1e-9});
  EXPECT_GT(Distance(bent_mesh, careless.MeshWith(40)).Worst(0).rms, 3 * error);
  EXPECT_GT(LeastTextureArea(bent_sequence.MeshWith(40), 0), 0);
}

TEST(AttributedSimplificationTest, TheSeamOfACylinderStays) {
  const AttributedMesh mesh = Weld({shapes::Cylinder(64, 24)});
  const AttributedSimplification sequence(mesh, {kTexture, kNormal});
  const AttributedMesh small = sequence.MeshWith(400);
  EXPECT_LE(small.surface.triangles.size(), 400u);
  EXPECT_GE(small.surface.triangles.size(), 398u);
  // On the line x = 1, y = 0 from one border to the other, with both values at each of its vertices and one normal.
  const MeshAttribute& texture = small.attributes[0];
  std::map<uint32_t, std::set<float>> u_at_seam;
  for (size_t f = 0; f < small.surface.triangles.size(); ++f) {
    for (size_t k = 0; k < 3; ++k) {
      const float u = texture.values[2 * texture.corners[f][k]];
      if (u < 0.01f || u > 0.99f) u_at_seam[small.surface.triangles[f][k]].insert(u);
    }
  }
  EXPECT_GE(u_at_seam.size(), 2u);
  for (const auto& [v, values] : u_at_seam) {
    EXPECT_EQ(values.size(), 2u);
    EXPECT_NEAR(small.surface.positions[v].y, 0, 0.02);
  }
  EXPECT_LE(texture.num_values(), small.surface.positions.size() + u_at_seam.size());
  std::map<uint32_t, std::set<uint32_t>> normals;
  for (size_t f = 0; f < small.surface.triangles.size(); ++f) {
    for (size_t k = 0; k < 3; ++k) normals[small.surface.triangles[f][k]].insert(small.attributes[1].corners[f][k]);
  }
  for (const auto& [v, values] : normals) EXPECT_EQ(values.size(), 1u);
  const AttributeDistance distance = Distance(mesh, small);
  EXPECT_LT(distance.Worst(0).rms_99, 2);
  EXPECT_LT(distance.Worst(1).rms_99, 3);
  EXPECT_GT(LeastTextureArea(small, 0), 0);
}

TEST(AttributedSimplificationTest, NoCrackOpensBetweenGroups) {
  // Four sectors of a sphere as four primitives.
  const TriangleMesh sphere = shapes::BumpySphere(4, 0.1f);
  std::vector<VertexSoup> soups(4, {sphere.positions, {}, {}});
  for (const Triangle& t : sphere.triangles) {
    const Vec3f middle = sphere.positions[t[0]] + sphere.positions[t[1]] + sphere.positions[t[2]];
    soups[(middle.x > 0 ? 1u : 0u) + (middle.y > 0 ? 2u : 0u)].triangles.push_back(t);
  }
  const AttributedMesh mesh = Weld(soups);
  const AttributedSimplification sequence(mesh, {});
  const AttributedMesh small = sequence.MeshWith(600);
  EXPECT_EQ(CountBorderEdges(small), 0u);
  for (uint32_t g = 0; g < 4; ++g) EXPECT_GT(std::count(small.groups.begin(), small.groups.end(), g), 20);
  EXPECT_LT(PositionError(mesh, small), 0.01);
}

TEST(AttributedSimplificationTest, NoCrackOpensWhereAWallStandsOnAFloor) {
  constexpr uint32_t kSide = 20;
  const TriangleMesh wall = WallOnAFloor(kSide);
  const AttributedMesh mesh = Weld({{wall.positions, wall.triangles, {}}});
  ASSERT_EQ(CountEdges(mesh, 3), kSide);
  const AttributedMesh small = AttributedSimplification(mesh, {}).MeshWith(300);
  EXPECT_LE(small.surface.triangles.size(), 300u);
  EXPECT_EQ(CountEdges(small, 3), kSide);
}

TEST(AttributedSimplificationTest, EverySizeOfEveryShapeIsSound) {
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    SCOPED_TRACE(shape.name);
    const AttributedMesh mesh = Weld({{shape.mesh.positions, shape.mesh.triangles, {}}});
    const AttributedSimplification sequence(mesh, {});
    uint32_t last = sequence.num_input_triangles();
    for (uint32_t size = last; size > 0; size = size * 2 / 3) {
      const AttributedMesh small = sequence.MeshWith(size);
      ASSERT_TRUE(CheckAttributedMesh(small).ok());
      EXPECT_LE(small.surface.triangles.size(), last);
      EXPECT_GE(small.surface.triangles.size(), std::min(size, sequence.fewest_triangles()) - std::min(size, 1u));
      EXPECT_LE(small.surface.triangles.size(), std::max(size, sequence.fewest_triangles()));
      EXPECT_TRUE(!shape.manifold || (CountBorderEdges(small) > 0) == (CountBorderEdges(mesh) > 0));
      last = static_cast<uint32_t>(small.surface.triangles.size());
    }
  }
}

TEST(AttributedSimplificationTest, ReversedTrianglesStayReversed) {
  const AttributedMesh mesh = Weld({{shapes::Misoriented(3).positions, shapes::Misoriented(3).triangles, {}}});
  const AttributedSimplification sequence(mesh, {});
  const auto share_inward = [](const TriangleMesh& surface) {
    double inward = 0, all = 0;
    for (const Triangle& t : surface.triangles) {
      const Vec3f &a = surface.positions[t[0]], &b = surface.positions[t[1]], &c = surface.positions[t[2]];
      const double area = static_cast<double>(Norm(Cross(b - a, c - a)));
      all += area;
      if (Dot(Cross(b - a, c - a), a + b + c) < 0) inward += area;
    }
    return inward / all;
  };
  EXPECT_NEAR(share_inward(sequence.MeshWith(sequence.num_input_triangles() * 3 / 4).surface), share_inward(mesh.surface), 0.05);
}

// Thin welts, one side of which is easily laid over the other.
VertexSoup Welts() {
  VertexSoup soup = shapes::TexturedGrid(80, 80);
  for (Vec3f& p : soup.positions) {
    const float welt = std::sin(14 * p.x + 2 * std::sin(5 * p.y));
    p.z = 0.3f * welt * welt * welt * std::cos(2 * p.y);
    p.x += 0.7f * p.z;
  }
  const std::vector<Vec3d> normals = VertexAreaVectors({soup.positions, soup.triangles});
  for (size_t v = 0; v < normals.size(); ++v) {
    const Vec3f n = Vec3Cast<float>(Normalized(normals[v]));
    std::copy_n(&n.x, 3, &soup.attributes[1].values[3 * v]);
  }
  return soup;
}

TEST(AttributedSimplificationTest, NoTriangleTurnsFromItsNormals) {
  const AttributedMesh mesh = Weld({Welts()});
  ASSERT_EQ(FindNormals(mesh), &mesh.attributes[1]);
  ASSERT_EQ(ShareAgainstNormals(mesh), 0);
  const AttributedSimplification sequence(mesh, {kTexture, kNormal});
  for (const uint32_t size : {4000u, 1500u, 600u}) {
    const AttributedMesh coarse = sequence.MeshWith(size);
    EXPECT_LE(coarse.surface.triangles.size(), size);
    EXPECT_EQ(ShareAgainstNormals(coarse), 0) << size;  // 9e-5 at 1500 without a look at the normals
  }
}

// A grid of n x n squares, each with normals of its own and of one of `num_groups` primitives, strips of rows; dome: it bulges.
AttributedMesh Facets(uint32_t n, float dome, uint32_t num_groups) {
  std::vector<VertexSoup> soups(num_groups, {{}, {}, {{"NORMAL", AttributeKind::kNormal, 3, {}}}});
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t j = 0; j < n; ++j) {
      VertexSoup& soup = soups[i * num_groups / n];
      const auto first = static_cast<uint32_t>(soup.positions.size());
      for (uint32_t k = 0; k < 4; ++k) {
        const float x = static_cast<float>(i + k / 2) / static_cast<float>(n), y = static_cast<float>(j + k % 2) / static_cast<float>(n);
        soup.positions.push_back({x, y, dome * x * (1 - x) * y * (1 - y)});
      }
      soup.triangles.push_back({first, first + 2, first + 3});
      soup.triangles.push_back({first, first + 3, first + 1});
      const Vec3f normal = Normalized(Cross(soup.positions[first + 3] - soup.positions[first], soup.positions[first + 1] - soup.positions[first + 2]));
      const float tilt = 1e-3f * static_cast<float>((i + j) % 2);  // no two neighbors have the same
      for (uint32_t k = 0; k < 4; ++k) soup.attributes[0].values.insert(soup.attributes[0].values.end(), {normal.x + tilt, normal.y, normal.z});
    }
  }
  return Weld(soups);
}

TEST(AttributedSimplificationTest, ChartsVanishWhereTheirCurvesAreNear) {
  constexpr uint32_t kSide = 16;
  const AttributedMesh flat = Facets(kSide, 0.0f, 1);
  const AttributedSimplification whole(flat, {kNormal});
  EXPECT_GE(whole.fewest_triangles(), kSide * kSide);  // a triangle for each chart
  // Curves come together that are a square apart.
  constexpr double kSquare = 1.0 / kSide;
  EXPECT_LT(AttributedSimplification(flat, {kNormal}, {}, {2 * kSquare}).fewest_triangles(), kSide * kSide / 4);
  EXPECT_EQ(AttributedSimplification(flat, {kNormal}, {}, {1e-3 * kSquare}).fewest_triangles(), whole.fewest_triangles());
}

TEST(AttributedSimplificationTest, VanishedChartsLeaveTheShape) {
  const AttributedMesh dome = Facets(24, 1.5f, 1);
  double last = 0;
  for (const double farthest : {0.01, 0.04}) {
    const AttributedSimplification sequence(dome, {kNormal}, {}, {farthest});
    const AttributedMesh small = sequence.MeshWith(1);
    EXPECT_LT(small.surface.triangles.size(), farthest > 0.02 ? 300u : 1100u) << farthest;
    const double error = PositionError(dome, small);
    EXPECT_LT(error, farthest);
    EXPECT_GT(error, last);
    last = error;
  }
}

TEST(AttributedSimplificationTest, NoGroupVanishes) {
  const AttributedMesh mesh = Facets(12, 0.0f, 6);
  const AttributedMesh small = AttributedSimplification(mesh, {kNormal}, {}, {10.0}).MeshWith(1);
  ASSERT_TRUE(CheckAttributedMesh(small).ok());
  EXPECT_LT(small.surface.triangles.size(), 60u);
  for (uint32_t g = 0; g < 6; ++g) EXPECT_GE(std::count(small.groups.begin(), small.groups.end(), g), 1) << g;
}

// A plate with a narrow tab, which is nothing of its area.
TEST(AttributedSimplificationTest, NothingGoesFartherThanItsBound) {
  VertexSoup plate = shapes::TexturedGrid(16, 16, 0.05f);
  const Vec3f& corner = plate.positions[16];
  const uint32_t first = 16, second = 2 * 16 + 1;
  const float width = 1.0f / 16, length = 0.5f;
  ASSERT_NEAR(Norm(Vec3Cast<double>(plate.positions[second] - corner)), width, 0.01);
  plate.attributes.clear();
  const auto last = static_cast<uint32_t>(plate.positions.size());
  plate.positions.push_back(corner + Vec3f{length, 0, 0});
  plate.positions.push_back(plate.positions[second] + Vec3f{length, 0, 0});
  plate.triangles.push_back({first, last, second});
  plate.triangles.push_back({second, last, last + 1});
  const AttributedMesh mesh = Weld({plate});
  for (const double bound : {0.0, 0.02, 0.05}) {
    const AttributedMesh small = AttributedSimplification(mesh, {}, {}, {0, bound}).MeshWith(1);
    const double farthest = MeasureSurfaceDistance(mesh.surface, small.surface).value().Hausdorff();
    if (bound > 0) {
      EXPECT_LT(farthest, 1.2 * bound);
      EXPECT_GT(farthest, 0.3 * bound);
    } else {
      EXPECT_GT(farthest, 0.3);
    }
  }
}

TEST(AttributedSimplificationTest, IsTheSameEveryTime) {
  const AttributedMesh mesh = Weld({shapes::Cylinder(30, 10)});
  const AttributedMesh a = AttributedSimplification(mesh, {kTexture, kNormal}).MeshWith(200);
  const AttributedMesh b = AttributedSimplification(mesh, {kTexture, kNormal}).MeshWith(200);
  EXPECT_EQ(a.surface.positions, b.surface.positions);
  EXPECT_EQ(a.surface.triangles, b.surface.triangles);
  EXPECT_EQ(a.attributes[0].values, b.attributes[0].values);
}

TEST(AttributedSimplificationTest, ValuesStayLegal) {
  VertexSoup soup = shapes::TexturedGrid(20, 20, 0.3f);
  VertexSoup::Attribute weights{"WEIGHTS", AttributeKind::kWeights, 3, {}}, colors{"COLOR_0", AttributeKind::kColor, 1, {}};
  for (const Vec3f& p : soup.positions) {
    const float x = p.x < 0.5f ? 0 : 1, y = p.y;
    weights.values.insert(weights.values.end(), {x, (1 - x) * y, (1 - x) * (1 - y)});
    colors.values.push_back(x);
  }
  soup.attributes.push_back(weights);
  soup.attributes.push_back(colors);
  const AttributedMesh small = AttributedSimplification(Weld({soup}), {kTexture, kNormal, 0.1, 0.1}).MeshWith(100);
  for (uint32_t i = 0; i < small.attributes[1].num_values(); ++i) {
    const float* n = &small.attributes[1].values[3 * i];
    EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-5);
  }
  for (uint32_t i = 0; i < small.attributes[2].num_values(); ++i) {
    const float* w = &small.attributes[2].values[3 * i];
    EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-5);
    EXPECT_GE(std::min({w[0], w[1], w[2]}), 0);
  }
  for (const float c : small.attributes[3].values) EXPECT_TRUE(c >= 0 && c <= 1);
}

TEST(AttributedSimplificationTest, OfNothingIsNothing) {
  EXPECT_TRUE(AttributedSimplification({}, {}).MeshWith(10).surface.triangles.empty());
}

}  // namespace
}  // namespace lacerta
