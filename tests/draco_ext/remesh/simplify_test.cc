#include "remesh/simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <numeric>
#include <set>
#include <utility>

#include "common/subdivision.h"
#include "lacerta/surface_distance.h"
#include "shapes/real_meshes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

double PsnrOf(const TriangleMesh& mesh, const TriangleMesh& simplified) {
  const double distance = MeasureSurfaceDistance(mesh, simplified, SurfaceDistanceOptions::RmsOnly(20000)).value().Rms();
  return Psnr(distance, BoundingBoxDiagonal(mesh));
}

double Area(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = Vec3Cast<double>(mesh.positions[t[0]]);
    area += Norm(Cross(Vec3Cast<double>(mesh.positions[t[1]]) - a, Vec3Cast<double>(mesh.positions[t[2]]) - a)) / 2;
  }
  return area;
}

void ExpectSound(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    EXPECT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
    for (const uint32_t v : t) {
      ASSERT_LT(v, mesh.positions.size());
      used[v] = true;
    }
  }
  EXPECT_EQ(std::accumulate(used.begin(), used.end(), size_t{0}), mesh.positions.size());
}

TEST(SimplifyTest, TheInputIsTheFirstOfTheSequence) {
  const TriangleMesh mesh = shapes::BumpySphere(3);
  const SimplificationSequence sequence(mesh);
  EXPECT_EQ(sequence.num_input_triangles(), mesh.triangles.size());
  const TriangleMesh all = sequence.MeshWith(1u << 30);
  ASSERT_EQ(all.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(all.positions.size(), mesh.positions.size());
  EXPECT_EQ(PsnrOf(mesh, all), PsnrOf(mesh, mesh));
}

TEST(SimplifyTest, HasEveryShapeAtEverySize) {
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    if (shape.name.find("egenerate") != std::string::npos) continue;  // cleaned away before
    SCOPED_TRACE(shape.name);
    const SimplificationSequence sequence(shape.mesh);
    EXPECT_GE(sequence.fewest_triangles(), 1u);
    EXPECT_LE(sequence.fewest_triangles(), shape.mesh.triangles.size());
    for (uint32_t wanted = sequence.num_input_triangles(); wanted >= sequence.fewest_triangles(); wanted = wanted * 3 / 4) {
      const TriangleMesh mesh = sequence.MeshWith(wanted);
      EXPECT_LE(mesh.triangles.size(), wanted);
      EXPECT_GE(mesh.triangles.size() + 130, wanted);  // a collapse takes its two and what comes to lie on others
      ExpectSound(mesh);
    }
    EXPECT_EQ(sequence.MeshWith(0).triangles.size(), sequence.fewest_triangles());
  }
}

TEST(SimplifyTest, KeepsFlatsCreasesAndCorners) {
  struct Case {
    TriangleMesh mesh;
    uint32_t triangles;  // 24 corners, genus 2: 52
  };
  for (const auto& [mesh, triangles] : {Case{shapes::CreasedBox(12), 12}, Case{shapes::TwoHoledPlate(4), 56}}) {
    const TriangleMesh simplified = SimplificationSequence(mesh).MeshWith(triangles);
    EXPECT_GT(PsnrOf(mesh, simplified), 100);
    EXPECT_NEAR(Area(simplified), Area(mesh), 1e-3 * Area(mesh));
  }
}

TEST(SimplifyTest, KeepsStraightBorders) {
  const TriangleMesh mesh = shapes::GridWithBorder(30, 30);
  const TriangleMesh simplified = SimplificationSequence(mesh).MeshWith(8);
  EXPECT_GT(PsnrOf(mesh, simplified), 100);
  EXPECT_NEAR(Area(simplified), 1, 1e-4);
}

TEST(SimplifyTest, SmoothSurfacesStayClosedManifoldsAtModerateSizes) {
  for (const TriangleMesh& mesh : {shapes::BumpySphere(4, 0.2f), shapes::Torus(60, 30)}) {
    const int euler = BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles).ok()
                          ? static_cast<int>(mesh.positions.size()) - static_cast<int>(mesh.triangles.size()) / 2
                          : -1000;
    const TriangleMesh simplified = SimplificationSequence(mesh).MeshWith(500);
    ASSERT_TRUE(BuildTopology(static_cast<uint32_t>(simplified.positions.size()), simplified.triangles).ok());
    EXPECT_EQ(static_cast<int>(simplified.positions.size()) - static_cast<int>(simplified.triangles.size()) / 2, euler);
  }
}

TEST(SimplifyTest, ErrorFallsWithTheSquareOfTheSize) {
  const TriangleMesh mesh = shapes::Icosphere(5);
  const SimplificationSequence sequence(mesh);
  const double coarse = PsnrOf(mesh, sequence.MeshWith(200)), fine = PsnrOf(mesh, sequence.MeshWith(800));
  EXPECT_GT(fine - coarse, 10);  // 12 dB for the second order
  EXPECT_LT(fine - coarse, 14);
  EXPECT_GT(coarse, 48);
  EXPECT_LT(coarse, 53);
}

TEST(SimplifyTest, ClosesHandlesOnlyWhenNothingElseIsCheaper) {
  const TriangleMesh mesh = shapes::Torus(60, 30);
  const SimplificationSequence sequence(mesh);
  EXPECT_LE(sequence.fewest_triangles(), 4u);
  const TriangleMesh simplified = sequence.MeshWith(100);
  EXPECT_EQ(static_cast<int>(simplified.positions.size()), static_cast<int>(simplified.triangles.size()) / 2);
}

TEST(SimplifyTest, EveryComponentKeepsATriangle) {
  TriangleMesh mesh;
  constexpr uint32_t kCount = 40;
  for (uint32_t i = 0; i < kCount; ++i) {
    const TriangleMesh part = i % 2 == 0 ? shapes::Icosphere(1) : shapes::GridWithBorder(3, 3);
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const Vec3f& p : part.positions) mesh.positions.push_back(p + Vec3f{3.0f * static_cast<float>(i), 0, 0});
    for (const Triangle& t : part.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  const TriangleMesh fewest = SimplificationSequence(mesh).MeshWith(0);
  std::vector<bool> has_triangle(kCount);
  for (const Triangle& t : fewest.triangles) has_triangle[static_cast<size_t>(fewest.positions[t[0]].x / 3 + 0.5f)] = true;
  EXPECT_EQ(std::accumulate(has_triangle.begin(), has_triangle.end(), uint32_t{0}), kCount);
  EXPECT_LE(fewest.triangles.size(), 4 * kCount);
}

// Vertices near a plane across the sphere, as where parts meet: they and their edges are there at every size, to the last bit.
TEST(SimplifyTest, HeldVerticesStay) {
  const TriangleMesh mesh = shapes::BumpySphere(4);
  std::vector<uint8_t> held(mesh.positions.size());
  for (size_t v = 0; v < held.size(); ++v) held[v] = std::fabs(mesh.positions[v].x) < 0.05f;
  const auto held_edges = [](const TriangleMesh& m, const auto& is_held) {
    std::set<std::pair<std::array<float, 3>, std::array<float, 3>>> edges;
    for (const Triangle& t : m.triangles) {
      for (int k = 0; k < 3; ++k) {
        const Vec3f &a = m.positions[t[k]], &b = m.positions[t[(k + 1) % 3]];
        if (is_held(a) && is_held(b)) edges.insert({{a.x, a.y, a.z}, {b.x, b.y, b.z}});
      }
    }
    return edges;
  };
  std::set<std::array<float, 3>> held_positions;
  for (size_t v = 0; v < held.size(); ++v) {
    const Vec3f& p = mesh.positions[v];
    if (held[v] != 0) held_positions.insert({p.x, p.y, p.z});
  }
  const auto is_held = [&](const Vec3f& p) { return held_positions.count({p.x, p.y, p.z}) == 1; };
  ASSERT_GT(held_positions.size(), 100u);
  SimplificationOptions options;
  options.held = held;
  const SimplificationSequence sequence(mesh, options);
  EXPECT_LT(sequence.fewest_triangles(), mesh.triangles.size() / 4);
  for (const uint32_t wanted : {4000u, 2000u, 0u}) {
    const TriangleMesh simplified = sequence.MeshWith(wanted);
    ExpectSound(simplified);
    std::set<std::array<float, 3>> there;
    for (const Vec3f& p : simplified.positions) {
      if (is_held(p)) there.insert({p.x, p.y, p.z});
    }
    EXPECT_EQ(there.size(), held_positions.size());
    const auto before = held_edges(mesh, is_held), after = held_edges(simplified, is_held);
    EXPECT_TRUE(std::includes(after.begin(), after.end(), before.begin(), before.end()));
  }
}

// A thin stick is soon a short one, at hardly any cost in the mean.
TEST(SimplifyTest, NothingGoesFartherThanTheOriginalAllows) {
  const TriangleMesh mesh = shapes::WithStick(shapes::BumpySphere(4, 0.2f), 0.003f, 0.3f);
  const auto farthest_within = [&](double bound) {
    SimplificationOptions options;
    if (bound > 0) options.original = std::make_shared<const DeviationSamples>(mesh, bound);
    return MeasureSurfaceDistance(mesh, SimplificationSequence(mesh, options).MeshWith(100)).value().Hausdorff();
  };
  EXPECT_GT(farthest_within(0), 0.1);
  for (const double bound : {0.02, 0.05}) {
    EXPECT_LT(farthest_within(bound), 1.3 * bound);
    EXPECT_GT(farthest_within(bound), 0.7 * bound);
  }
}

TEST(SimplifyTest, EndsWhereNoMoreIsAskedFor) {
  const TriangleMesh mesh = shapes::BumpySphere(4, 0.2f);
  SimplificationOptions options;
  options.fewest_triangles = 1000;
  const SimplificationSequence all(mesh), some(mesh, options);
  EXPECT_LE(some.fewest_triangles(), 1000u);
  EXPECT_GE(some.fewest_triangles(), 998u);
  EXPECT_LT(all.fewest_triangles(), 10u);
  EXPECT_EQ(some.MeshWith(2000).positions, all.MeshWith(2000).positions);
  EXPECT_EQ(some.MeshWith(0).triangles, all.MeshWith(1000).triangles);
}

TEST(SimplifyTest, DependsNeitherOnPlaceNorOnSize) {
  const TriangleMesh mesh = shapes::BumpySphere(3);
  TriangleMesh moved = mesh;
  for (Vec3f& p : moved.positions) p = p * 1024.0f + Vec3f{4096, -8192, 2048};
  const double here = PsnrOf(mesh, SimplificationSequence(mesh).MeshWith(200));
  const double there = PsnrOf(moved, SimplificationSequence(moved).MeshWith(200));
  EXPECT_NEAR(here, there, 0.5);
}

TEST(SimplifyTest, IsTheSameEveryTime) {
  const TriangleMesh mesh = shapes::BumpySphere(3, 0.1f, 0.01f);
  const TriangleMesh a = SimplificationSequence(mesh).MeshWith(300), b = SimplificationSequence(mesh).MeshWith(300);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(Vec3f)), 0);
}

// One vertex of very many triangles, and one edge of very many: neither may take a time that is quadratic in them.
TEST(SimplifyTest, EndsSoonWhereManyTrianglesMeet) {
  constexpr uint32_t kCount = 100000;
  TriangleMesh fan, book;
  fan.positions = {{0, 0, 1}};
  book.positions = {{0, 0, 0}, {0, 0, 1}};
  for (uint32_t i = 0; i < kCount; ++i) {
    const float angle = 6.2831853f * static_cast<float>(i) / kCount;
    const Vec3f p{std::cos(angle), std::sin(angle), 0};
    fan.positions.push_back(p);
    fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % kCount});
    book.positions.push_back(p);
    book.triangles.push_back({0, 1, 2 + i});
  }
  EXPECT_LE(SimplificationSequence(fan).fewest_triangles(), kCount);
  EXPECT_LE(SimplificationSequence(book).fewest_triangles(), kCount);
}

TEST(SimplifyTest, TakesMeshesWithoutArea) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 2, 3}};
  EXPECT_GE(SimplificationSequence(mesh).MeshWith(1).triangles.size(), 1u);
  mesh.positions.assign(4, {5, 5, 5});
  EXPECT_GE(SimplificationSequence(mesh).MeshWith(1).triangles.size(), 1u);
}

TEST(SimplifyTest, ScansAndPartsStayClose) {
  struct Case {
    const char* name;
    uint32_t triangles;
    double least_psnr, most_psnr;
  };
  int tried = 0;
  for (const Case& c : {Case{"camelhead.ply", 1000, 64, 67}, Case{"crank.ply", 4000, 70, 73}, Case{"dragon_vrip_res2.ply", 4000, 63, 66}}) {
    const auto mesh = testing::RealMesh(c.name);
    if (!mesh.has_value()) continue;
    SCOPED_TRACE(c.name);
    ++tried;
    const double psnr = PsnrOf(*mesh, SimplificationSequence(*mesh).MeshWith(c.triangles));
    EXPECT_GT(psnr, c.least_psnr);
    EXPECT_LT(psnr, c.most_psnr);
  }
  if (tried == 0) GTEST_SKIP() << "no real mesh in " LACERTA_TEST_DATA_DIR;
}

}  // namespace
}  // namespace lacerta
