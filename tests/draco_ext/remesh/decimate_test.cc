#include "remesh/decimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <map>
#include <random>

#include "common/subdivision.h"
#include "draco_ext/remesh/remeshing.h"
#include "remesh/base_parts.h"

namespace lacerta {
namespace {

using lacerta::testing::ClosedRealMeshes;
using lacerta::testing::ClosedShapes;
using lacerta::testing::DoublePyramid;
using lacerta::testing::Moved;
using lacerta::testing::PositionOf;
using lacerta::testing::RandomPointOn;
using lacerta::testing::Scaled;
using lacerta::testing::Tetrahedron;

CollapseHistory DecimateTo(const TriangleMesh& mesh, uint32_t target) {
  DecimateOptions options;
  options.target_vertices = target;
  return testing::Decimated(mesh, options);
}

uint32_t VerticesLeft(const TriangleMesh& mesh, const CollapseHistory& history) {
  return static_cast<uint32_t>(mesh.positions.size()) - history.num_collapses();
}

// The mesh after `time` collapses without the vertices that are gone.
std::vector<Triangle> TrianglesAt(const CollapseHistory& history, uint32_t time, uint32_t* num_vertices) {
  std::map<uint32_t, uint32_t> number;
  std::vector<Triangle> triangles;
  for (const uint32_t f : history.FacesAt(time)) {
    Triangle t = history.face(f);
    for (uint32_t& v : t) v = number.emplace(v, static_cast<uint32_t>(number.size())).first->second;
    triangles.push_back(t);
  }
  *num_vertices = static_cast<uint32_t>(number.size());
  return triangles;
}

void ExpectClosedManifold(const TriangleMesh& mesh, const CollapseHistory& history, uint32_t time, int euler) {
  uint32_t num_vertices = 0;
  const std::vector<Triangle> triangles = TrianglesAt(history, time, &num_vertices);
  ASSERT_EQ(num_vertices, mesh.positions.size() - time);
  const StatusOr<Topology> built = BuildTopology(num_vertices, triangles);
  ASSERT_TRUE(built.ok()) << built.status().message() << " after " << time << " collapses";
  const Topology& t = built.value();
  EXPECT_EQ(std::count(t.on_curve.begin(), t.on_curve.end(), 1), 0);
  EXPECT_EQ(static_cast<int>(t.num_vertices) - static_cast<int>(t.num_edges()) + static_cast<int>(t.num_faces()), euler);
}

// Largest distances over random points, in lengths of the unit of the mesh: input -> base -> input and base -> input -> base.
struct RoundTrips {
  double down_and_up = 0, up_and_down = 0;
};
RoundTrips MeasureRoundTrips(const TriangleMesh& mesh, const CollapseHistory& history, uint32_t time, int num_points) {
  std::mt19937 random(time);
  const auto place = [&](const DomainPoint& p) { return PositionOf(mesh.positions, history.face(p.face), p.barycentric); };
  const std::vector<uint32_t> base = history.FacesAt(time);
  const std::vector<uint32_t> input = history.FacesAt(0);
  RoundTrips worst;
  for (int i = 0; i < num_points; ++i) {
    const DomainPoint p = RandomPointOn(input[random() % input.size()], &random);
    const DomainPoint down = history.Forward(p, time);
    EXPECT_TRUE(std::binary_search(base.begin(), base.end(), down.face));
    worst.down_and_up = std::max(worst.down_and_up, Norm(place(history.Backward(down)) - place(p)));
    const DomainPoint b = RandomPointOn(base[random() % base.size()], &random);
    const DomainPoint up = history.Backward(b);
    EXPECT_LT(up.face, input.size());
    worst.up_and_down = std::max(worst.up_and_down, Norm(place(history.Forward(up, time)) - place(b)));
  }
  return worst;
}

void CheckEveryTime(const shapes::NamedShape& shape, int num_points, double tolerance) {
  SCOPED_TRACE(shape.name);
  const CollapseHistory history = DecimateTo(shape.mesh, 4);
  const uint32_t collapses = history.num_collapses();
  EXPECT_GT(collapses, shape.mesh.positions.size() * 9 / 10) << "hardly simplified";
  for (const double share : {0.0, 0.3, 0.7, 0.9, 0.99, 1.0}) {
    const auto time = static_cast<uint32_t>(share * collapses);
    ExpectClosedManifold(shape.mesh, history, time, 2 - 2 * shape.genus);
    const RoundTrips worst = MeasureRoundTrips(shape.mesh, history, time, num_points);
    const double diagonal = BoundingBoxDiagonal(shape.mesh);
    // Charts of thin triangles lose digits: those near the coarsest meshes of all are given a thousand times as many.
    EXPECT_LT(worst.down_and_up, (share < 0.95 ? tolerance : 1000 * tolerance) * diagonal) << time;
    EXPECT_LT(worst.up_and_down, (share < 0.95 ? tolerance : 1000 * tolerance) * diagonal) << time;
  }
}

TEST(Decimate, EveryIntermediateMeshIsTheInputsTopologyAndMapsBothWays) {
  for (const shapes::NamedShape& shape : ClosedShapes()) CheckEveryTime(shape, 2000, 1e-9);
}

TEST(Decimate, RealMeshesToo) {
  const auto meshes = ClosedRealMeshes({{"dragon_50k.ply", 1}, {"human_skull.ply", 2}, {"fertility.ply", 4}, {"fandisk.ply", 0}});
  if (meshes.empty()) GTEST_SKIP() << "no real mesh in " LACERTA_TEST_DATA_DIR;
  for (const shapes::NamedShape& mesh : meshes) CheckEveryTime(mesh, 5000, 1e-8);
}

TEST(Decimate, StopsAtTheTarget) {
  const TriangleMesh sphere = shapes::BumpySphere(4);
  for (const uint32_t target : {2562u, 2561u, 500u, 37u, 16u, 4u}) EXPECT_EQ(VerticesLeft(sphere, DecimateTo(sphere, target)), target);
  EXPECT_EQ(VerticesLeft(sphere, DecimateTo(sphere, 10'000)), 2562u);
}

TEST(Decimate, SmallerTargetsContinueLargerOnes) {
  const TriangleMesh sphere = shapes::BumpySphere(3);
  const CollapseHistory coarse = DecimateTo(sphere, 16), fine = DecimateTo(sphere, 100);
  EXPECT_EQ(coarse.FacesAt(fine.num_collapses()), fine.FacesAt(fine.num_collapses()));
}

TEST(Decimate, KeepsTheShape) {
  const TriangleMesh sphere = shapes::Icosphere(4);
  const CollapseHistory history = DecimateTo(sphere, 100);
  TriangleMesh base{sphere.positions, {}};
  for (const uint32_t f : history.FacesAt(history.num_collapses())) base.triangles.push_back(history.face(f));
  const SurfaceDistance distance = MeasureSurfaceDistance(sphere, base).value();
  // 100 points spread evenly on the unit sphere leave chords about 0.035 below it.
  EXPECT_LT(distance.Rms(), 0.05);
  EXPECT_GT(distance.Rms(), 0.01);
}

TEST(Decimate, RespectsTheValenceLimit) {
  const TriangleMesh sphere = shapes::BumpySphere(4, 0.2f, 0.02f);
  const auto largest_valence = [&](int limit) {
    DecimateOptions options;
    options.target_vertices = 100;
    options.max_valence = limit;
    const CollapseHistory history = testing::Decimated(sphere, options);
    uint32_t num_vertices = 0;
    const std::vector<Triangle> triangles = TrianglesAt(history, history.num_collapses(), &num_vertices);
    const std::vector<uint16_t> valence = BuildTopology(num_vertices, triangles).value().valence;
    return int{*std::max_element(valence.begin(), valence.end())};
  };
  EXPECT_LE(largest_valence(7), 7);
  EXPECT_LE(largest_valence(12), 12);
  EXPECT_GT(largest_valence(12), 7);
  EXPECT_LE(largest_valence(100'000), 64);
}

void ExpectSameCollapses(const CollapseHistory& a, const CollapseHistory& b) {
  ASSERT_EQ(a.num_collapses(), b.num_collapses());
  ASSERT_EQ(a.num_faces(), b.num_faces());
  for (uint32_t f = 0; f < a.num_faces(); ++f) ASSERT_EQ(a.face(f), b.face(f)) << "face " << f;
}

TEST(Decimate, IsDeterministic) {
  const TriangleMesh mesh = shapes::Torus(48, 24);
  ExpectSameCollapses(DecimateTo(mesh, 16), DecimateTo(mesh, 16));
}

// Coordinates on a lattice of 2^-12, so that moving and scaling by powers of two are exact.
TriangleMesh OnLattice(TriangleMesh mesh) {
  for (Vec3f& p : mesh.positions) {
    for (int c = 0; c < 3; ++c) p[c] = std::nearbyint(p[c] * 4096.0f) / 4096.0f;
  }
  return mesh;
}

TEST(Decimate, DoesNotDependOnPlaceOrScale) {
  for (const TriangleMesh& mesh : {OnLattice(shapes::BumpySphere(4)), OnLattice(shapes::Torus(48, 24))}) {
    const CollapseHistory expected = DecimateTo(mesh, 16);
    ExpectSameCollapses(DecimateTo(Moved(mesh, {512, -1024, 256}), 16), expected);
    for (const int exponent : {-60, -20, 20, 60}) {
      SCOPED_TRACE(exponent);
      ExpectSameCollapses(DecimateTo(Scaled(mesh, std::ldexp(1.0f, exponent)), 16), expected);
    }
  }
}

TEST(Decimate, TinyMeshesStay) {
  EXPECT_EQ(DecimateTo(Tetrahedron(), 1).num_collapses(), 0u);
  EXPECT_EQ(DecimateTo(Together(Tetrahedron(), Moved(Tetrahedron(), {5, 0, 0})), 1).num_collapses(), 0u);
  const TriangleMesh pillow{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}}};
  EXPECT_EQ(DecimateTo(pillow, 1).num_collapses(), 0u);
  EXPECT_EQ(DecimateTo({}, 1).num_collapses(), 0u);
  EXPECT_EQ(DecimateTo({{{0, 0, 0}}, {}}, 1).num_collapses(), 0u);
}

TEST(Decimate, ComponentsEndAsTetrahedraAtMost) {
  TriangleMesh mesh = shapes::Icosphere(2);
  mesh = Together(mesh, Moved(shapes::Icosphere(1, 0.1f), {3, 0, 0}));
  mesh = Together(mesh, Moved(shapes::Torus(12, 8), {0, 0, 5}));
  const CollapseHistory history = DecimateTo(mesh, 1);
  ExpectClosedManifold(mesh, history, history.num_collapses(), 2 + 2 + 0);
  EXPECT_GE(VerticesLeft(mesh, history), 4u + 4u + 7u);  // no torus has fewer than 7
  EXPECT_LE(VerticesLeft(mesh, history), 30u);
}

TEST(Decimate, RemovesVerticesOfThreeFaces) {
  TriangleMesh mesh = shapes::Icosphere(2);
  const std::vector<Triangle> faces = mesh.triangles;
  const auto smooth = static_cast<uint32_t>(mesh.positions.size());
  mesh.triangles.clear();
  for (const Triangle& t : faces) {  // each face gets a vertex in its middle
    const auto v = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.push_back((mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) * (1.0f / 3));
    for (int k = 0; k < 3; ++k) mesh.triangles.push_back({v, t[k], t[(k + 1) % 3]});
  }
  const CollapseHistory history = DecimateTo(mesh, smooth);
  EXPECT_EQ(VerticesLeft(mesh, history), smooth);
  std::vector<bool> alive(mesh.positions.size(), false);
  for (const uint32_t f : history.FacesAt(history.num_collapses())) {
    for (const uint32_t v : history.face(f)) alive[v] = true;
  }
  EXPECT_LT(std::count(alive.begin() + smooth, alive.end(), true), 10) << "the flat ones go first";
  ExpectClosedManifold(mesh, history, history.num_collapses(), 2);
}

TEST(Decimate, VerticesOfManyFacesTakeNoQuadraticTime) {
  for (const uint32_t n : {10'000u, 65'000u}) {  // a Topology holds hardly more
    const TriangleMesh mesh = DoublePyramid(n);
    const std::clock_t begin = std::clock();  // of the processor: sanitizers on a busy machine take long enough
    const CollapseHistory history = DecimateTo(mesh, 20);
    EXPECT_LT(std::clock() - begin, 30 * CLOCKS_PER_SEC);  // quadratic: hours
    EXPECT_EQ(VerticesLeft(mesh, history), 20u);
    ExpectClosedManifold(mesh, history, history.num_collapses(), 2);
  }
}

TEST(Decimate, SurvivesDegenerateTriangles) {
  // Every fifth vertex moves onto a neighbor or into the middle of an edge across from it.
  std::mt19937 random(5);
  TriangleMesh mesh = shapes::Icosphere(3);
  for (const Triangle& t : mesh.triangles) {
    if (random() % 5 == 0) mesh.positions[t[0]] = mesh.positions[t[1]];
    if (random() % 5 == 0) mesh.positions[t[0]] = (mesh.positions[t[1]] + mesh.positions[t[2]]) * 0.5f;
  }
  const CollapseHistory history = DecimateTo(mesh, 4);
  ExpectClosedManifold(mesh, history, history.num_collapses(), 2);
  const RoundTrips worst = MeasureRoundTrips(mesh, history, history.num_collapses(), 2000);
  EXPECT_LT(worst.down_and_up, 1e-6);
  EXPECT_LT(worst.up_and_down, 1e-6);

  for (Vec3f& p : mesh.positions) p = {1, 2, 3};  // a point
  EXPECT_EQ(DecimateTo(mesh, 4).num_collapses(), 0u);
}

// Around a vertex that lies in the plane of its ring but outside of it, one angle is the sum of the others: flattened, it is
// 180 degrees, and the face there would have no area in the chart.
TEST(Decimate, ChartsHaveNoFlatFace) {
  TriangleMesh mesh = shapes::BumpySphere(3);
  for (Vec3f& p : mesh.positions) p.z = 0;
  DecimateOptions options;
  options.target_vertices = 4;
  options.min_normal_cosine = -1;
  const CollapseHistory history = testing::Decimated(mesh, options);
  EXPECT_GT(history.num_collapses(), mesh.positions.size() / 2);
  for (const double share : {0.3, 1.0}) {
    const auto time = static_cast<uint32_t>(share * history.num_collapses());
    ExpectClosedManifold(mesh, history, time, 2);
    const RoundTrips worst = MeasureRoundTrips(mesh, history, time, 20'000);
    EXPECT_LT(worst.down_and_up, 1e-5);
    EXPECT_LT(worst.up_and_down, 1e-5);
  }
}

}  // namespace
}  // namespace lacerta
