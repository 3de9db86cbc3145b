#include "geometry/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "common/subdivision.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using Real = long double;
using Vec3r = Vec3<Real>;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A second opinion, by another way than the tree's: Gram matrix and all three edges, in long double.
Real SquaredDistanceToTriangle(const Vec3r& p, const Vec3r& a, const Vec3r& b, const Vec3r& c) {
  Real best = std::numeric_limits<Real>::infinity();
  const Vec3r corners[3] = {a, b, c};
  for (int k = 0; k < 3; ++k) {
    const Vec3r d = corners[(k + 1) % 3] - corners[k];
    const Real length2 = SquaredNorm(d);
    const Real t = length2 > 0 ? std::clamp<Real>(Dot(p - corners[k], d) / length2, 0, 1) : 0;
    best = std::min(best, SquaredNorm(corners[k] + d * t - p));
  }
  const Vec3r ab = b - a, ac = c - a, ap = p - a;
  const Real d00 = Dot(ab, ab), d01 = Dot(ab, ac), d11 = Dot(ac, ac), d0 = Dot(ap, ab), d1 = Dot(ap, ac);
  const Real det = d00 * d11 - d01 * d01;
  if (det > d00 * d11 * 1e-15L) {
    const Real u = (d11 * d0 - d01 * d1) / det, v = (d00 * d1 - d01 * d0) / det;
    if (u >= 0 && v >= 0 && u + v <= 1) best = std::min(best, SquaredNorm(ap - ab * u - ac * v));
  }
  return best;
}

Vec3r Corner(const TriangleMesh& mesh, size_t f, int k) { return Vec3Cast<Real>(mesh.positions[mesh.triangles[f][k]]); }

double BruteForceDistance(const TriangleMesh& mesh, const Vec3f& p) {
  Real best = std::numeric_limits<Real>::infinity();
  for (size_t f = 0; f < mesh.triangles.size(); ++f) {
    best = std::min(
        best, SquaredDistanceToTriangle(Vec3Cast<Real>(p), Corner(mesh, f, 0), Corner(mesh, f, 1), Corner(mesh, f, 2)));
  }
  return static_cast<double>(std::sqrt(best));
}

Vec3f RandomPoint(std::mt19937* random, float half_size) {
  std::uniform_real_distribution<float> share(-half_size, half_size);
  const float x = share(*random), y = share(*random), z = share(*random);
  return {x, y, z};
}

Vec3f PointOnFace(const TriangleMesh& mesh, size_t f, const std::array<float, 3>& barycentric) {
  Vec3r p;
  for (int k = 0; k < 3; ++k) p += Corner(mesh, f, k) * static_cast<Real>(barycentric[k]);
  return Vec3Cast<float>(p);
}

void ExpectConsistent(const TriangleMesh& mesh, const Vec3f& query, const ClosestPointResult& result) {
  ASSERT_LT(result.point.face, mesh.triangles.size());
  const auto& weights = result.point.barycentric;
  for (const float w : weights) {
    EXPECT_GE(w, 0.0f);
    EXPECT_LE(w, 1.0f);
  }
  EXPECT_NEAR(weights[0] + weights[1] + weights[2], 1.0f, 1e-6f);
  const Vec3f by_weights = PointOnFace(mesh, result.point.face, weights);
  EXPECT_LT(Norm(by_weights - result.point.position), 2e-6f);
  EXPECT_NEAR(Norm(result.point.position - query), std::sqrt(result.squared_distance), 1e-6f);
}

TEST(TriangleTree, ClosestPointAgreesWithBruteForceOnAllShapes) {
  std::mt19937 random(7);
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    SCOPED_TRACE(shape.name);
    const TriangleTree tree(shape.mesh);
    uint32_t hint = 0;
    for (int k = 0; k < 60; ++k) {
      // Far ones and near ones.
      Vec3f p = RandomPoint(&random, 2.0f);
      if (k % 2 == 1)
        p = PointOnFace(shape.mesh, random() % shape.mesh.triangles.size(), {0.25f, 0.5f, 0.25f}) + p * 1e-3f;
      const double expected = BruteForceDistance(shape.mesh, p);
      const ClosestPointResult result = tree.ClosestPoint(p);
      EXPECT_NEAR(std::sqrt(static_cast<double>(result.squared_distance)), expected, 1e-6 * expected + 1e-15);
      ExpectConsistent(shape.mesh, p, result);
      EXPECT_TRUE(tree.IsNear(p, result.squared_distance * 1.001f));
      EXPECT_EQ(tree.IsNear(p, result.squared_distance * 0.999f), result.squared_distance == 0);
      const ClosestPointResult hinted = tree.ClosestPointNear(p, hint);
      EXPECT_EQ(hinted.squared_distance, result.squared_distance);
      ExpectConsistent(shape.mesh, p, hinted);
      hint = static_cast<uint32_t>(random());  // of a face sometimes, mostly of none
      if (k % 3 != 0) hint %= static_cast<uint32_t>(shape.mesh.triangles.size());
    }
  }
}

TEST(TriangleTree, PointsNearAreThoseOfAllFacesInReach) {
  std::mt19937 random(11);
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    SCOPED_TRACE(shape.name);
    const TriangleTree tree(shape.mesh);
    for (int k = 0; k < 10; ++k) {
      const Vec3f p = PointOnFace(shape.mesh, random() % shape.mesh.triangles.size(), {0.25f, 0.5f, 0.25f}) + RandomPoint(&random, 0.02f);
      constexpr float kReach2 = 0.05f * 0.05f;
      std::vector<ClosestPointResult> points;
      tree.PointsNear(p, kReach2, shape.mesh.triangles.size(), &points);
      std::vector<float> distance2(shape.mesh.triangles.size(), 2 * kReach2);
      for (const ClosestPointResult& result : points) {
        ExpectConsistent(shape.mesh, p, result);
        EXPECT_EQ(distance2[result.point.face], 2 * kReach2) << "twice";
        distance2[result.point.face] = result.squared_distance;
      }
      for (uint32_t f = 0; f < shape.mesh.triangles.size(); ++f) {
        const TriangleMesh one{shape.mesh.positions, {shape.mesh.triangles[f]}};
        const float expected = TriangleTree(one).ClosestPoint(p).squared_distance;
        EXPECT_EQ(distance2[f], expected <= kReach2 ? expected : 2 * kReach2);
      }
      std::vector<float> nearest;
      for (const ClosestPointResult& result : points) nearest.push_back(result.squared_distance);
      std::sort(nearest.begin(), nearest.end());
      for (const size_t most : {size_t{0}, size_t{1}, points.size() / 2, points.size() - 1}) {
        if (most >= points.size()) continue;
        std::vector<ClosestPointResult> fewer(1);  // what is there stays
        tree.PointsNear(p, kReach2, most, &fewer);
        ASSERT_EQ(fewer.size(), 1 + most);
        EXPECT_EQ(fewer[0].point.face, SurfacePoint::kNone);
        std::sort(fewer.begin() + 1, fewer.end(), [](const auto& x, const auto& y) { return x.squared_distance < y.squared_distance; });
        for (size_t i = 0; i < most; ++i) EXPECT_EQ(fewer[1 + i].squared_distance, nearest[i]);
      }
    }
  }
}

TEST(TriangleTree, FacesInOrderOfSubdivisionStayTogether) {
  TriangleMesh ordered = shapes::BumpySphere(2);
  Topology topology = BuildTopology(static_cast<uint32_t>(ordered.positions.size()), ordered.triangles).value();
  for (int level = 0; level < 2; ++level) {
    for (const auto& [a, b] : topology.edges) ordered.positions.push_back((ordered.positions[a] + ordered.positions[b]) * 0.5f);
    topology = Refine(topology);
  }
  ordered.triangles = topology.triangles;
  TriangleMesh shuffled = ordered;
  std::shuffle(shuffled.triangles.begin(), shuffled.triangles.end(), std::mt19937(5));
  const TriangleTree tree(ordered), other(shuffled);
  const auto kept_together = [](const TriangleTree& t) {
    size_t count = 0;
    for (size_t slot = 0; slot < t.faces_in_tree_order().size(); slot += 16) {
      bool together = true;
      for (size_t k = 0; k < 16; ++k) {
        together = together && t.faces_in_tree_order()[slot + k] == t.faces_in_tree_order()[slot] + k;
      }
      count += together && t.faces_in_tree_order()[slot] % 16 == 0;
    }
    return count;
  };
  EXPECT_EQ(kept_together(tree), ordered.triangles.size() / 16);
  EXPECT_EQ(kept_together(other), 0u);
  std::mt19937 random(11);
  std::vector<LineHit> hits, other_hits;
  for (int k = 0; k < 2000; ++k) {
    const Vec3f p = RandomPoint(&random, 1.5f), direction = RandomPoint(&random, 1.0f);
    EXPECT_EQ(tree.ClosestPoint(p).squared_distance, other.ClosestPoint(p).squared_distance);
    hits.clear(), other_hits.clear();
    tree.IntersectLine(p, direction, -9, 9, &hits);
    other.IntersectLine(p, direction, -9, 9, &other_hits);
    EXPECT_EQ(hits.size(), other_hits.size());
  }
}

TEST(TriangleTree, SmallDistancesToLargeTrianglesAreAccurate) {
  // 100 dB below the diagonal, away from the origin, over faces as large as the mesh.
  TriangleMesh mesh = shapes::CreasedBox(1);
  for (Vec3f& p : mesh.positions) p = Vec3f{p.x + 0.1f * p.y, p.y + 0.3f * p.z, p.z - 0.2f * p.x} + Vec3f{1, 2, 3};
  const TriangleTree tree(mesh);
  std::mt19937 random(3);
  for (int k = 0; k < 300; ++k) {
    const Vec3f p = PointOnFace(mesh, random() % 12, {0.2f, 0.3f, 0.5f}) + RandomPoint(&random, 2e-5f);
    const double expected = BruteForceDistance(mesh, p);
    EXPECT_NEAR(std::sqrt(static_cast<double>(tree.ClosestPoint(p).squared_distance)), expected,
                1e-6 * expected + 1e-15);
  }
}

TEST(TriangleTree, ThinTrianglesAreAccurate) {
  std::mt19937 random(5);
  for (const float width : {1e-3f, 1e-5f, 1e-7f, 0.0f}) {
    TriangleMesh mesh;
    mesh.positions = {{-1, 0, 0}, {1, 0.5f, 0.25f}, {0.3f, 0.325f + width, 0.1625f - width}};
    mesh.triangles = {{0, 1, 2}};
    const TriangleTree tree(mesh);
    for (int k = 0; k < 200; ++k) {
      const float weight = 0.001f * static_cast<float>(random() % 1000);
      const Vec3f p = PointOnFace(mesh, 0, {1.0f - weight, weight, 0.0f}) + RandomPoint(&random, 1e-4f);
      const double expected = BruteForceDistance(mesh, p);
      EXPECT_NEAR(std::sqrt(static_cast<double>(tree.ClosestPoint(p).squared_distance)), expected,
                  1e-5 * expected + 1e-9);
    }
  }
}

TEST(TriangleTree, LimitIsInclusive) {
  const TriangleTree tree(shapes::GridWithBorder(4, 4));
  const Vec3f p{0.3f, 0.4f, 0.5f};
  EXPECT_EQ(tree.ClosestPoint(p, 0.2499f).point.face, SurfacePoint::kNone);
  EXPECT_NE(tree.ClosestPoint(p, 0.25f).point.face, SurfacePoint::kNone);
  EXPECT_EQ(tree.ClosestPoint(p, 0.25f).squared_distance, 0.25f);
  EXPECT_EQ(tree.ClosestPoint({0.3f, 0.4f, 0.0f}, 0.0f).squared_distance, 0.0f);
  EXPECT_EQ(tree.ClosestPoint(p, -1.0f).point.face, SurfacePoint::kNone);
  EXPECT_FALSE(tree.IsNear(p, 0.2499f));
  EXPECT_TRUE(tree.IsNear(p, 0.25f));
  EXPECT_FALSE(tree.IsNear(p, -1.0f));
  EXPECT_FALSE(tree.IsNear({std::nanf(""), 0, 0}, 1.0f));
}

TEST(TriangleTree, WithoutTrianglesNothingIsFound) {
  const TriangleTree tree((TriangleMesh()));
  EXPECT_EQ(tree.ClosestPoint({0, 0, 0}).point.face, SurfacePoint::kNone);
  EXPECT_EQ(tree.ClosestPointNear({0, 0, 0}, 0).point.face, SurfacePoint::kNone);
  std::vector<LineHit> hits;
  tree.IntersectLine({0, 0, 0}, {0, 0, 1}, -kInfinity, kInfinity, &hits);
  EXPECT_TRUE(hits.empty());
}

TEST(TriangleTree, UnusableFacesAndQueriesAreLeftOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {nan, 0, 0}, {kInfinity, 0, 0}, {2e18f, 0, 0}};
  mesh.triangles = {{0, 1, 3}, {0, 1, 4}, {0, 1, 5}, {0, 1, 6}, {0, 1, 2}};
  const TriangleTree tree(mesh);
  EXPECT_EQ(tree.faces_in_tree_order(), std::vector<uint32_t>{4});
  EXPECT_EQ(tree.ClosestPoint({0.2f, 0.2f, 1.0f}).point.face, 4u);
  EXPECT_EQ(tree.ClosestPointNear({0.2f, 0.2f, 1.0f}, 0).point.face, 4u);
  EXPECT_EQ(tree.ClosestPoint({nan, 0, 0}).point.face, SurfacePoint::kNone);
  EXPECT_EQ(tree.ClosestPoint({0, kInfinity, 0}).point.face, SurfacePoint::kNone);
  EXPECT_EQ(tree.ClosestPoint({0, 0, 0}, nan).point.face, SurfacePoint::kNone);
  std::vector<LineHit> hits;
  tree.IntersectLine({0.2f, 0.2f, 1.0f}, {0, 0, 0}, -1, 1, &hits);
  tree.IntersectLine({0.2f, nan, 1.0f}, {0, 0, 1}, -1, 1, &hits);
  tree.IntersectLine({0.2f, 0.2f, 1.0f}, {0, 0, kInfinity}, -1, 1, &hits);
  tree.IntersectLine({0.2f, 0.2f, 1.0f}, {0, 0, 1}, nan, 1, &hits);
  EXPECT_TRUE(hits.empty());
}

TEST(TriangleTree, ExtremeScalesWork) {
  for (const float scale : {1e-12f, 1e-3f, 1e6f, 1e17f}) {
    const TriangleMesh mesh = shapes::Icosphere(3, scale);
    const TriangleTree tree(mesh);
    const ClosestPointResult result = tree.ClosestPoint({0, 0, 1.5f * scale});
    EXPECT_GE(std::sqrt(result.squared_distance), 0.4999f * scale);
    EXPECT_LE(std::sqrt(result.squared_distance), 0.52f * scale);
    std::vector<LineHit> hits;
    tree.IntersectLine({0, 0, 0}, {0.1f * scale, 0.2f * scale, 0.3f * scale}, 0, kInfinity, &hits);
    ASSERT_GE(hits.size(), 1u);
    EXPECT_NEAR(hits[0].t, 2.67f, 0.03f);
  }
}

TEST(TriangleTree, PlacesFarFromZeroAreAsAccurateAndAsFast) {
  const TriangleMesh near = shapes::BumpySphere(5, 0.2f, 0.002f);
  const double crowding = TriangleTree(near).Crowding();
  EXPECT_GT(crowding, 4.0);  // its own leaf at least, and neighbors
  EXPECT_LT(crowding, 40.0);
  std::mt19937 random(9);
  for (const float offset : {1e2f, 1e4f}) {
    TriangleMesh far = near;
    for (Vec3f& p : far.positions) p = p + Vec3f{offset, -offset, offset};
    far.positions.push_back({-1e9f, 0, 0});  // of no face
    const TriangleTree tree(far);
    EXPECT_NEAR(tree.Crowding(), crowding, 0.3 * crowding);
    for (int k = 0; k < 20; ++k) {
      const Vec3f p = PointOnFace(far, random() % far.triangles.size(), {0.25f, 0.5f, 0.25f}) + RandomPoint(&random, k % 2 == 0 ? 0.01f : 3.0f);
      const double expected = BruteForceDistance(far, p);
      EXPECT_NEAR(std::sqrt(static_cast<double>(tree.ClosestPoint(p).squared_distance)), expected, 1e-6 * expected + 1e-15);
    }
  }
}

TEST(TriangleTree, CrowdingGrowsWithTrianglesThroughEachOther) {
  const auto crowding_of = [](uint32_t num_triangles) {
    std::mt19937 random(2);
    TriangleMesh soup;
    for (uint32_t i = 0; i < 3 * num_triangles; ++i) soup.positions.push_back(RandomPoint(&random, 1.0f));
    for (uint32_t f = 0; f < num_triangles; ++f) soup.triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
    return TriangleTree(soup).Crowding();
  };
  const double of_1000 = crowding_of(1000), of_4000 = crowding_of(4000);
  EXPECT_GT(of_1000, 100.0);
  EXPECT_LT(of_1000, 1000.0);
  EXPECT_GT(of_4000, 2.5 * of_1000);
  EXPECT_EQ(TriangleTree({}).Crowding(), 0.0);
}

TEST(TriangleTree, CrowdedAndStretchedInputsStayWithinTheStack) {
  TriangleMesh mesh;
  // Many times the same face, and faces that shrink by halves towards a corner, which the heuristic splits off one by
  // one.
  for (int k = 0; k < 3000; ++k) {
    const float size = k < 2000 ? 1.0f : std::ldexp(1.0f, -(k % 120));
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const Vec3f& p : {Vec3f{1, 0, 0}, Vec3f{2, 0, 0}, Vec3f{1, 1, 0}}) mesh.positions.push_back(p * size);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  const TriangleTree tree(mesh);
  std::vector<uint32_t> faces = tree.faces_in_tree_order();
  std::sort(faces.begin(), faces.end());
  for (uint32_t f = 0; f < faces.size(); ++f) ASSERT_EQ(faces[f], f);
  EXPECT_EQ(faces.size(), 3000u);
  EXPECT_NEAR(tree.ClosestPoint({1.25f, 0.25f, 0.5f}).squared_distance, 0.25f, 1e-6f);
  EXPECT_NEAR(tree.ClosestPoint({0, 0, 0.5f}).squared_distance, 0.25f, 1e-6f);
}

struct BruteForceHit {
  Real t, smallest_weight;
};

// Moeller-Trumbore in long double, for the plane of face f.
bool MeetPlane(const TriangleMesh& mesh, size_t f, const Vec3f& origin, const Vec3f& direction, BruteForceHit* hit) {
  const Vec3r a = Corner(mesh, f, 0), ab = Corner(mesh, f, 1) - a, ac = Corner(mesh, f, 2) - a;
  const Vec3r d = Vec3Cast<Real>(direction), ao = Vec3Cast<Real>(origin) - a;
  const Vec3r h = Cross(d, ac), q = Cross(ao, ab);
  const Real det = Dot(ab, h);
  if (!(std::fabs(det) > 1e-9L * Norm(d) * Norm(ab) * Norm(ac))) return false;
  const Real u = Dot(ao, h) / det, v = Dot(d, q) / det;
  *hit = {Dot(ac, q) / det, std::min({u, v, 1 - u - v})};
  return true;
}

TEST(TriangleTree, LineHitsAgreeWithBruteForceOnAllShapes) {
  std::mt19937 random(11);
  size_t num_hits = 0;
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    SCOPED_TRACE(shape.name);
    const TriangleTree tree(shape.mesh);
    for (int k = 0; k < 100; ++k) {
      const Vec3f target = PointOnFace(shape.mesh, random() % shape.mesh.triangles.size(), {0.3f, 0.3f, 0.4f});
      const Vec3f origin = RandomPoint(&random, 2.0f), direction = (target - origin) * 0.7f;
      const float t_min = k % 2 == 0 ? -kInfinity : 0.0f, t_max = k % 3 == 0 ? kInfinity : 1.5f;
      std::vector<LineHit> hits;
      tree.IntersectLine(origin, direction, t_min, t_max, &hits);
      std::set<uint32_t> faces;
      for (const LineHit& hit : hits) {
        EXPECT_TRUE(faces.insert(hit.point.face).second);
        EXPECT_GE(hit.t, t_min);
        EXPECT_LE(hit.t, t_max);
        EXPECT_LT(Norm(hit.point.position - (origin + direction * hit.t)), 1e-5f);
        EXPECT_LT(Norm(hit.point.position - PointOnFace(shape.mesh, hit.point.face, hit.point.barycentric)), 1e-5f);
        BruteForceHit expected;
        if (!MeetPlane(shape.mesh, hit.point.face, origin, direction, &expected)) continue;
        EXPECT_NEAR(static_cast<double>(hit.t), static_cast<double>(expected.t), 1e-4);
        EXPECT_GT(expected.smallest_weight, -1e-6L);
      }
      for (uint32_t f = 0; f < shape.mesh.triangles.size(); ++f) {
        BruteForceHit expected;
        if (!MeetPlane(shape.mesh, f, origin, direction, &expected) || expected.smallest_weight < 1e-6L) continue;
        if (expected.t < static_cast<Real>(t_min) + 1e-5L || expected.t > static_cast<Real>(t_max) - 1e-5L) continue;
        EXPECT_EQ(faces.count(f), 1u) << "face " << f << " at t = " << expected.t;
      }
      num_hits += hits.size();
    }
  }
  EXPECT_GT(num_hits, 1400u);
}

TEST(TriangleTree, NoLineSlipsThroughVerticesAndEdges) {
  for (const TriangleMesh& mesh : {shapes::Icosphere(3), shapes::BumpySphere(3), shapes::SpikySphere(3)}) {
    const TriangleTree tree(mesh);
    const Vec3f origin{0.011f, -0.023f, 0.037f};
    const auto expect_hit = [&](const Vec3f& target) {
      std::vector<LineHit> hits;
      tree.IntersectLine(origin, target - origin, 0.0f, 2.0f, &hits);
      const bool any =
          std::any_of(hits.begin(), hits.end(), [](const LineHit& hit) { return std::fabs(hit.t - 1.0f) < 1e-4f; });
      EXPECT_TRUE(any) << target.x << " " << target.y << " " << target.z;
    };
    for (const Vec3f& p : mesh.positions) expect_hit(p);
    for (const Triangle& t : mesh.triangles) {
      for (const float share : {0.5f, 0.123f, 0.9f}) {
        expect_hit(mesh.positions[t[0]] * share + mesh.positions[t[1]] * (1.0f - share));
      }
    }
  }
}

TEST(TriangleTree, LinesAlongTheAxesHitGridVerticesAndBorders) {
  const TriangleTree tree(shapes::GridWithBorder(4, 4));
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 8; ++j) {
      const Vec3f origin{static_cast<float>(i) / 8.0f, static_cast<float>(j) / 8.0f, 1.0f};
      std::vector<LineHit> hits;
      tree.IntersectLine(origin, {0, 0, 2}, -1.0f, 0.0f, &hits);
      ASSERT_GE(hits.size(), 1u) << i << " " << j;
      EXPECT_LE(hits.size(), 6u);
      for (const LineHit& hit : hits) EXPECT_EQ(hit.t, -0.5f);
      hits.clear();
      tree.IntersectLine(origin, {0, 0, 2}, -0.4f, 10.0f, &hits);
      EXPECT_TRUE(hits.empty());
    }
  }
  std::vector<LineHit> hits;
  tree.IntersectLine({-0.5f, 0.3f, 0}, {1, 0, 0}, -10, 10, &hits);  // in the plane of the grid
  tree.IntersectLine({1.01f, 0.3f, 1}, {0, 0, 1}, -10, 10, &hits);  // beside it
  EXPECT_TRUE(hits.empty());
}

}  // namespace
}  // namespace lacerta
