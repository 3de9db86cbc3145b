#include "remesh/manifold.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/clean.h"
#include "shapes/real_meshes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

// Everything that holds for any input: nothing moved, nothing dropped, a manifold, and a report that says what was
// done.
ManifoldMesh Made(const TriangleMesh& input, Orientation orientation = Orientation::kMadeToAgree) {
  ManifoldMesh made = MakeManifold(input, orientation);
  EXPECT_EQ(made.mesh.triangles.size(), input.triangles.size());
  EXPECT_EQ(made.component.size(), input.triangles.size());
  EXPECT_EQ(made.source_vertex.size(), made.mesh.positions.size());
  EXPECT_GE(made.mesh.positions.size(), input.positions.size());
  std::vector<bool> has_copy(input.positions.size(), false);
  for (uint32_t v = 0; v < made.mesh.positions.size(); ++v) {
    const uint32_t source = made.source_vertex[v];
    EXPECT_TRUE(v < input.positions.size() ? source == v : source < input.positions.size());
    EXPECT_EQ(made.mesh.positions[v], input.positions[source]);
    if (v >= input.positions.size()) has_copy[source] = true;
  }
  EXPECT_EQ(made.report.split_vertices, static_cast<uint64_t>(std::count(has_copy.begin(), has_copy.end(), true)));
  uint64_t flipped = 0;
  for (size_t f = 0; f < input.triangles.size(); ++f) {
    Triangle t = made.mesh.triangles[f];
    for (uint32_t& v : t) v = made.source_vertex[v];
    if (t == input.triangles[f]) continue;
    std::swap(t[1], t[2]);
    EXPECT_EQ(t, input.triangles[f]);
    ++flipped;
  }
  EXPECT_EQ(made.report.flipped_triangles, flipped);

  const StatusOr<Topology> built =
      BuildTopology(static_cast<uint32_t>(made.mesh.positions.size()), made.mesh.triangles);
  EXPECT_TRUE(built.ok()) << built.status().message();
  EXPECT_EQ(made.report.components, made.components.size());
  if (!built.ok()) return made;
  const Topology& topology = built.value();
  // Faces across an edge share their component, and each component has the counts that it is said to have.
  std::vector<int64_t> euler(made.components.size(), 0);
  std::vector<uint32_t> faces(made.components.size(), 0), of_vertex(made.mesh.positions.size(), kNone);
  uint32_t next_component = 0;
  for (uint32_t f = 0; f < made.component.size(); ++f) {
    const uint32_t c = made.component[f];
    EXPECT_LE(c, next_component);
    next_component = std::max(next_component, c + 1);
    ++faces[c];
    ++euler[c];
    for (const uint32_t v : made.mesh.triangles[f]) {
      EXPECT_TRUE(of_vertex[v] == kNone || of_vertex[v] == c);
      euler[c] += of_vertex[v] == kNone;
      of_vertex[v] = c;
    }
  }
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    const auto [f, g] = topology.edge_faces[e];
    --euler[made.component[f]];
    EXPECT_TRUE(g == kNone || made.component[f] == made.component[g]);
  }
  uint64_t borders = 0;
  for (size_t c = 0; c < made.components.size(); ++c) {
    EXPECT_EQ(made.components[c].faces, faces[c]);
    EXPECT_EQ(made.components[c].euler, euler[c]);
    EXPECT_EQ(made.components[c].vertices, static_cast<uint32_t>(std::count(of_vertex.begin(), of_vertex.end(), c)));
    borders += made.components[c].borders;
  }
  EXPECT_EQ(made.report.borders, borders);
  return made;
}

void ExpectReport(const ManifoldReport& r, uint64_t flipped, uint64_t cut, uint64_t split, uint64_t components,
                  uint64_t borders) {
  EXPECT_EQ(r.flipped_triangles, flipped);
  EXPECT_EQ(r.cut_edges, cut);
  EXPECT_EQ(r.split_vertices, split);
  EXPECT_EQ(r.components, components);
  EXPECT_EQ(r.borders, borders);
}

double SignedVolume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = Vec3Cast<double>(mesh.positions[t[0]]), b = Vec3Cast<double>(mesh.positions[t[1]]);
    volume += Dot(Cross(a, b), Vec3Cast<double>(mesh.positions[t[2]])) / 6.0;
  }
  return volume;
}

TriangleMesh CleanedMeshOf(const TriangleMesh& mesh) {
  StatusOr<CleanedMesh> cleaned = Clean(mesh);
  EXPECT_TRUE(cleaned.ok()) << cleaned.status().message();
  return std::move(cleaned).value().mesh;
}

TEST(MakeManifold, LeavesManifoldsAlone) {
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    if (!shape.manifold || !shape.oriented || shape.name == "triangle_soup") continue;
    SCOPED_TRACE(shape.name);
    const ManifoldMesh made = Made(shape.mesh);
    EXPECT_EQ(made.mesh.triangles, shape.mesh.triangles);
    ExpectReport(made.report, 0, 0, 0, 1, static_cast<uint64_t>(shape.num_borders));
    EXPECT_EQ(made.components[0].euler, 2 - 2 * shape.genus - shape.num_borders);
  }
}

TEST(MakeManifold, AnyShapeBecomesAManifold) {
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    SCOPED_TRACE(shape.name);
    Made(CleanedMeshOf(shape.mesh));
  }
}

TEST(MakeManifold, TurnsTheLesserAreaOver) {
  TriangleMesh mesh = shapes::Misoriented(3);  // every third of 1280 faces
  const ManifoldMesh made = Made(mesh);
  ExpectReport(made.report, 427, 0, 0, 1, 0);
  EXPECT_GT(SignedVolume(made.mesh), 4.1);
  EXPECT_LT(SignedVolume(made.mesh), 4.2);
  // Turned inside out as a whole it stays so: most of it says where its outside is.
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  const ManifoldMesh inside_out = Made(mesh);
  ExpectReport(inside_out.report, 427, 0, 0, 1, 0);
  EXPECT_LT(SignedVolume(inside_out.mesh), -4.1);
}

TEST(MakeManifold, AreaCountsRatherThanFaces) {
  // One large face against the two small ones beside it, which agree with each other.
  const std::vector<Vec3f> positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {2, -0.1f, 0}, {-0.1f, 2, 0}};
  const ManifoldMesh made = Made({positions, {{0, 1, 2}, {0, 1, 3}, {2, 0, 4}}});
  ExpectReport(made.report, 2, 0, 0, 1, 1);
  EXPECT_EQ(made.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 3, 1}, {2, 4, 0}}));
  const ManifoldMesh large_is_odd = Made({positions, {{0, 2, 1}, {0, 3, 1}, {2, 0, 4}}});
  ExpectReport(large_is_odd.report, 1, 0, 0, 1, 1);
  EXPECT_EQ(large_is_odd.mesh.triangles, (std::vector<Triangle>{{0, 2, 1}, {0, 1, 3}, {2, 0, 4}}));
}

TEST(MakeManifold, TurnsNothingOverWhereOrientationsAreKept) {
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    SCOPED_TRACE(shape.name);
    const TriangleMesh mesh = CleanedMeshOf(shape.mesh);
    const ManifoldMesh kept = Made(mesh, Orientation::kKept), turned = Made(mesh);
    EXPECT_EQ(kept.report.flipped_triangles, 0u);
    EXPECT_EQ(kept.mesh.triangles == turned.mesh.triangles, turned.report.flipped_triangles == 0);
  }
  // Every third of 1280 faces, not all of which are apart: along their 3 edges each, less those between two of them.
  const ManifoldMesh made = Made(shapes::Misoriented(3), Orientation::kKept);
  EXPECT_GT(made.report.cut_edges, 427u);
  EXPECT_LE(made.report.cut_edges, 3 * 427u);
  // The one that was to be turned over is cut off.
  const std::vector<Vec3f> positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {2, -0.1f, 0}, {-0.1f, 2, 0}};
  const ManifoldMesh odd = Made({positions, {{0, 1, 2}, {0, 1, 3}, {0, 2, 4}}}, Orientation::kKept);
  ExpectReport(odd.report, 0, 1, 2, 2, 2);
}

TEST(MakeManifold, MoebiusBandIsCutOnceAcross) {
  for (const int n : {3, 4, 50}) {
    const ManifoldMesh made = Made(shapes::MoebiusBand(n));
    ExpectReport(made.report, 0, 1, 2, 1, 1);
    EXPECT_EQ(made.components[0].euler, 1);  // a disk
  }
}

TEST(MakeManifold, TheThirdSheetAtAnEdgeIsCutOff) {
  TriangleMesh mesh = shapes::NonManifoldEdge();  // all run the same way, so one of the pair is turned over
  ExpectReport(Made(mesh).report, 1, 1, 2, 2, 2);
  std::swap(mesh.triangles[1][0], mesh.triangles[1][1]);
  ExpectReport(Made(mesh).report, 0, 1, 2, 2, 2);
}

// Of an odd number of sheets one would stay alone at a border that the others know nothing of: all are cut, and their borders are one curve.
TEST(MakeManifold, LargeSheetsAreAllCutWhereOneWouldStayAlone) {
  EXPECT_EQ(Made(shapes::SheetsAroundACurve(3, 16, 16)).report.components, 3u);
  EXPECT_EQ(Made(shapes::SheetsAroundACurve(5, 16, 16)).report.components, 5u);
  EXPECT_EQ(Made(shapes::SheetsAroundACurve(4, 16, 16)).report.components, 2u);  // two pass through each other
  EXPECT_LT(Made(shapes::SheetsAroundACurve(3, 16, 4)).report.components, 3u);  // small ones are no surfaces to refine
}

TEST(MakeManifold, DoubleSheetBecomesTwo) {
  const ManifoldMesh made = Made(shapes::DoubleSheet(8, 6));
  // 8 * 6 cells have 48 diagonals, 8 * 5 and 7 * 6 edges inside and 28 on the rim; all 63 vertices become two.
  ExpectReport(made.report, 0, 48 + 40 + 42 + 28, 63, 2, 2);
  EXPECT_EQ(made.components[0].faces, 96u);
  EXPECT_EQ(made.components[1].faces, 96u);
  EXPECT_EQ(made.components[1].euler, 1);
  // Two faces alone, front and back.
  ExpectReport(Made({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}}).report, 0, 3, 3, 2, 2);
}

TEST(MakeManifold, SolidsThatTouchComeApart) {
  const ManifoldMesh edge = Made(shapes::TouchingBoxes(4));
  ExpectReport(edge.report, 0, 4, 5, 2, 0);
  EXPECT_EQ(edge.components[0].euler, 2);
  EXPECT_EQ(edge.components[1].euler, 2);
  ExpectReport(Made(shapes::Pinched()).report, 0, 0, 1, 2, 0);
}

TEST(MakeManifold, AStrayFaceIsTurnedBeforeEdgesOfFourFacesArePaired) {
  TriangleMesh mesh = shapes::TouchingBoxes(4);
  const auto at_edge = [&](const Triangle& t) {
    return std::count_if(t.begin(), t.end(),
                         [&](uint32_t v) { return mesh.positions[v].x == 1 && mesh.positions[v].y == 1; }) == 2;
  };
  Triangle& stray = *std::find_if(mesh.triangles.begin(), mesh.triangles.end(), at_edge);
  std::swap(stray[0], stray[1]);
  ExpectReport(Made(mesh).report, 1, 4, 5, 2, 0);
}

TEST(MakeManifold, WallsBetweenBoxes) {
  // A row of boxes around a corner, with the walls between them as double sheets; the last one touches the first at an
  // edge.
  for (const int n : {1, 2}) {
    TriangleMesh mesh = shapes::CreasedBox(n), cell = mesh;
    for (const auto& [x, y] :
         std::vector<std::pair<int, int>>{{1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {-1, 2}, {-1, 1}}) {
      const auto first = static_cast<uint32_t>(mesh.positions.size());
      for (const Vec3f& p : cell.positions)
        mesh.positions.push_back(p + Vec3f{static_cast<float>(x), static_cast<float>(y), 0});
      for (const Triangle& t : cell.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    Made(CleanedMeshOf(mesh));  // with the walls between boxes, as double sheets
  }
}

TEST(MakeManifold, RandomTrianglesOnFewVertices) {
  std::mt19937 random(5);  // the same numbers everywhere
  for (int run = 0; run < 2000 && !::testing::Test::HasFailure(); ++run) {
    SCOPED_TRACE(run);
    const auto num_vertices = static_cast<uint32_t>(4 + random() % 8),
               num_triangles = static_cast<uint32_t>(1 + random() % 40);
    TriangleMesh mesh;
    for (uint32_t v = 0; v < num_vertices;
         ++v) {  // on a small grid, so that there are faces without area and coplanar ones
      mesh.positions.push_back(
          {static_cast<float>(random() % 3), static_cast<float>(random() % 3), static_cast<float>(v % 3)});
    }
    for (uint32_t f = 0; f < num_triangles; ++f) {
      mesh.triangles.push_back({static_cast<uint32_t>(random() % num_vertices),
                                static_cast<uint32_t>(random() % num_vertices),
                                static_cast<uint32_t>(random() % num_vertices)});
    }
    const StatusOr<CleanedMesh> cleaned = Clean(mesh);
    if (cleaned.ok()) Made(cleaned.value().mesh);
  }
}

TEST(MakeManifold, FansTooLargeForATopologyAreCut) {
  for (const uint32_t n : {65534u, 65535u, 200000u}) {
    TriangleMesh fan;
    fan.positions.push_back({0, 0, 0});
    for (uint32_t i = 0; i < n; ++i) {
      const double a = 6.283185307179586 * i / n;
      fan.positions.push_back(
          {static_cast<float>(std::cos(a)), static_cast<float>(std::sin(a)), static_cast<float>(i)});
      fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % n});
    }
    const ManifoldMesh made = MakeManifold(fan);
    EXPECT_TRUE(BuildTopology(static_cast<uint32_t>(made.mesh.positions.size()), made.mesh.triangles).ok());
    EXPECT_EQ(made.report.components, (n + 65533) / 65534);
    EXPECT_EQ(made.report.cut_edges, n == 65534 ? 0 : made.report.components);
  }
}

TEST(MakeManifold, ManyFacesAtOneEdgeTakeNoLonger) {
  TriangleMesh book;
  book.positions = {{0, 0, 0}, {0, 0, 1}};
  constexpr uint32_t kFaces = 200000;
  for (uint32_t i = 0; i < kFaces; ++i) {
    const double a = 6.283185307179586 * i / kFaces;
    book.positions.push_back({static_cast<float>(std::cos(a)), static_cast<float>(std::sin(a)), 0.5f});
    book.triangles.push_back(i < kFaces / 2 ? Triangle{0, 1, 2 + i} : Triangle{1, 0, 2 + i});
  }
  const std::clock_t start = std::clock();
  const ManifoldMesh made = MakeManifold(book);
  EXPECT_LT(std::clock() - start, 20 * CLOCKS_PER_SEC);
  EXPECT_TRUE(BuildTopology(static_cast<uint32_t>(made.mesh.positions.size()), made.mesh.triangles).ok());
  EXPECT_GE(made.report.components, kFaces / 2);  // pairs; a few find their partner taken
  EXPECT_LT(made.report.components, kFaces / 2 + kFaces / 20);
}

TEST(MakeManifold, RealMeshes) {
  struct Expected {
    std::string name;
    ManifoldReport report;
  };
  const std::vector<Expected> expected = {
      {"horse.ply", {0, 0, 0, 1, 0}},        {"lion_statue.ply", {2, 0, 0, 1, 1}}, {"beetle.ply", {0, 0, 2, 1, 11}},
      {"plane_holes.ply", {0, 0, 0, 1, 27}}, {"crank.ply", {0, 36, 36, 25, 24}},
  };
  for (const auto& [name, r] : expected) {
    const std::optional<TriangleMesh> mesh = testing::RealMesh(name);
    if (!mesh) GTEST_SKIP() << name << " is not there";
    SCOPED_TRACE(name);
    ExpectReport(Made(CleanedMeshOf(*mesh)).report, r.flipped_triangles, r.cut_edges, r.split_vertices, r.components,
                 r.borders);
  }
}

TEST(MakeManifold, EveryRealMeshGetsATopology) {
  std::error_code error;
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(LACERTA_TEST_DATA_DIR, error)) {
    if (entry.path().extension() != ".ply") continue;
    const std::optional<TriangleMesh> mesh = testing::RealMesh(entry.path().filename().string());
    ASSERT_TRUE(mesh) << entry.path();
    const ManifoldMesh made = MakeManifold(CleanedMeshOf(*mesh));
    EXPECT_TRUE(BuildTopology(static_cast<uint32_t>(made.mesh.positions.size()), made.mesh.triangles).ok())
        << entry.path();
    ++count;
  }
  if (count == 0) GTEST_SKIP() << "no .ply files there";
}

TEST(MakeManifold, ADamagedScanStaysInFewPieces) {
  const std::optional<TriangleMesh> mesh = testing::RealMesh("dragon_vrip_res2.ply");
  if (!mesh) GTEST_SKIP() << "dragon_vrip_res2.ply is not there";
  const ManifoldMesh made = MakeManifold(CleanedMeshOf(*mesh));
  EXPECT_TRUE(BuildTopology(static_cast<uint32_t>(made.mesh.positions.size()), made.mesh.triangles).ok());
  uint32_t largest = 0;
  for (const ComponentTopology& c : made.components) largest = std::max(largest, c.faces);
  EXPECT_GT(largest, made.mesh.triangles.size() * 9 / 10);
}

}  // namespace
}  // namespace lacerta
