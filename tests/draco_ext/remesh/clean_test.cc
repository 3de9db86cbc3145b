#include "lacerta/clean.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "shapes/shapes.h"

namespace lacerta {
namespace {

using ::testing::HasSubstr;

CleanedMesh Cleaned(const TriangleMesh& mesh) {
  StatusOr<CleanedMesh> cleaned = Clean(mesh);
  EXPECT_TRUE(cleaned.ok()) << cleaned.status().message();
  return cleaned.ok() ? std::move(cleaned).value() : CleanedMesh();
}

void ExpectCounts(const CleanReport& report, uint64_t welded, uint64_t degenerate, uint64_t duplicate,
                  uint64_t isolated) {
  EXPECT_EQ(report.welded_vertices, welded);
  EXPECT_EQ(report.degenerate_triangles, degenerate);
  EXPECT_EQ(report.duplicate_triangles, duplicate);
  EXPECT_EQ(report.isolated_vertices, isolated);
}

void ExpectSameMesh(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_TRUE(a.positions == b.positions);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(Clean, LeavesACleanMeshAlone) {
  const TriangleMesh sphere = shapes::Icosphere(2);
  const CleanedMesh cleaned = Cleaned(sphere);
  ExpectSameMesh(cleaned.mesh, sphere);
  ExpectCounts(cleaned.report, 0, 0, 0, 0);
}

TEST(Clean, WeldsEqualPositionsAndNoMore) {
  const float next = 1.00001f;
  const CleanedMesh cleaned =
      Cleaned({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {next, 0, 0}, {2, 2, 2}},
               {{0, 1, 2}, {3, 5, 4}, {6, 7, 5}}});
  EXPECT_EQ(cleaned.mesh.positions.size(), 6u);
  EXPECT_EQ(cleaned.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {4, 5, 3}}));
  ExpectCounts(cleaned.report, 2, 0, 0, 0);
}

TEST(Clean, WeldsAcrossCracksOfRounding) {
  const float next = std::nextafter(1.0f, 2.0f);
  const CleanedMesh cleaned =
      Cleaned({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {next, 0, 0}, {1, 1, 0}}, {{0, 1, 2}, {3, 4, 2}, {3, 1, 2}}});
  ExpectSameMesh(cleaned.mesh, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}});
  ExpectCounts(cleaned.report, 1, 1, 0, 0);
}

TEST(Clean, MinusZeroIsZero) {
  const CleanedMesh cleaned = Cleaned(
      {{{0.0f, 0, 0}, {1, -0.0f, 0}, {0, 1, 0}, {-0.0f, 0, -0.0f}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}, {3, 5, 4}}});
  EXPECT_EQ(cleaned.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 3, 1}}));
  ExpectCounts(cleaned.report, 2, 0, 0, 0);
}

TEST(Clean, CountsDegenerateTrianglesBeforeAndAfterWelding) {
  const CleanedMesh cleaned =
      Cleaned({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}}, {{0, 1, 2}, {0, 0, 2}, {1, 2, 3}}});
  EXPECT_EQ(cleaned.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  ExpectCounts(cleaned.report, 1, 2, 0, 0);
}

TEST(Clean, KeepsTrianglesWithoutAreaWhoseCornersDiffer) {
  const CleanedMesh cleaned = Cleaned({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}});
  EXPECT_EQ(cleaned.mesh.triangles.size(), 1u);
  ExpectCounts(cleaned.report, 0, 0, 0, 0);
}

TEST(Clean, DropsRepeatedTrianglesButNotTheirBacks) {
  const CleanedMesh cleaned =
      Cleaned({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {1, 2, 0}, {2, 1, 0}, {2, 0, 1}, {0, 2, 1}}});
  EXPECT_EQ(cleaned.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 0}}));
  ExpectCounts(cleaned.report, 0, 0, 3, 0);
}

TEST(Clean, DropsVerticesOfNoTriangleAndKeepsTheOrder) {
  // Vertex 1 belongs to nothing, 4 to a degenerate triangle alone, 5 equals vertex 0 but belongs to nothing.
  const CleanedMesh cleaned =
      Cleaned({{{0, 0, 0}, {9, 9, 9}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}, {0, 0, 0}}, {{3, 0, 2}, {4, 4, 0}}});
  ExpectSameMesh(cleaned.mesh, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{2, 0, 1}}});
  ExpectCounts(cleaned.report, 0, 1, 0, 3);
}

TEST(Clean, SoupBecomesTheSphere) {
  const CleanedMesh cleaned = Cleaned(shapes::TriangleSoup(2));
  EXPECT_EQ(cleaned.mesh.positions.size(), 162u);
  EXPECT_EQ(cleaned.mesh.triangles.size(), 320u);
  ExpectCounts(cleaned.report, 960 - 162, 0, 0, 0);
}

TEST(Clean, IsIdempotentAndAccountsForEverything) {
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    SCOPED_TRACE(shape.name);
    const CleanedMesh once = Cleaned(shape.mesh);
    EXPECT_EQ(once.mesh.positions.size() + once.report.welded_vertices + once.report.isolated_vertices,
              shape.mesh.positions.size());
    EXPECT_EQ(once.mesh.triangles.size() + once.report.degenerate_triangles + once.report.duplicate_triangles,
              shape.mesh.triangles.size());
    const CleanedMesh twice = Cleaned(once.mesh);
    ExpectSameMesh(twice.mesh, once.mesh);
    ExpectCounts(twice.report, 0, 0, 0, 0);
  }
}

TEST(Clean, RefusesWhatItCannotRead) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()}) {
    for (int axis = 0; axis < 3; ++axis) {
      TriangleMesh mesh = shapes::Icosphere(0);
      mesh.positions[7][axis] = bad;
      const Status status = Clean(mesh).status();
      EXPECT_EQ(status.code(), StatusCode::kInvalidData);
      EXPECT_THAT(status.message(), HasSubstr("vertex 7 is not finite"));
    }
  }
  for (const uint32_t index : {12u, 0xffffffffu}) {
    TriangleMesh mesh = shapes::Icosphere(0);
    mesh.triangles[4][1] = index;
    const Status status = Clean(mesh).status();
    EXPECT_EQ(status.code(), StatusCode::kInvalidData);
    EXPECT_THAT(status.message(), HasSubstr("triangle 4 refers to vertex " + std::to_string(index) + " of 12"));
  }
  EXPECT_THAT(Clean({}).status().message(), HasSubstr("no triangle left"));
  EXPECT_THAT(Clean({{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}}).status().message(),
              HasSubstr("no triangle left"));
}

// So many triangles are taken in several ranges of vertices: what repeats or is cracked across them is found all the same.
TEST(Clean, FindsRepetitionsAndCracksOfLargeMeshes) {
  TriangleMesh mesh = shapes::Torus(1200, 900);  // 2,160,000 triangles
  const auto num_vertices = static_cast<uint32_t>(mesh.positions.size());
  const size_t num_triangles = mesh.triangles.size();
  TriangleMesh expected = mesh;
  std::vector<uint32_t> doubled = {0, num_vertices / 3, num_vertices - 1};  // vertices that some triangles have a copy of, one of them a crack away
  for (size_t i = 0; i < doubled.size(); ++i) {
    mesh.positions.push_back(mesh.positions[doubled[i]] + Vec3f{0, 0, i == 1 ? 1e-6f : 0});
    bool is_first = true;
    for (Triangle& t : mesh.triangles) {
      for (uint32_t& v : t) {
        if (v != doubled[i]) continue;
        if (!is_first) v = num_vertices + static_cast<uint32_t>(i);
        is_first = false;
      }
    }
  }
  for (const size_t f : {size_t{5}, num_triangles / 2, num_triangles - 7}) {
    const Triangle t = mesh.triangles[f];
    mesh.triangles.push_back({t[1], t[2], t[0]});
  }
  const CleanedMesh cleaned = Cleaned(mesh);
  ExpectSameMesh(cleaned.mesh, expected);
  ExpectCounts(cleaned.report, 3, 0, 3, 0);
}

TEST(Clean, InPlaceIsTheSame) {
  for (const TriangleMesh& mesh : {shapes::TriangleSoup(3), shapes::WithDegenerateFaces(3), shapes::Torus(20, 10)}) {
    const CleanedMesh expected = Cleaned(mesh);
    TriangleMesh cleaned = mesh;
    const StatusOr<CleanReport> report = CleanInPlace(&cleaned);
    ASSERT_TRUE(report.ok());
    ExpectSameMesh(cleaned, expected.mesh);
    const CleanReport& e = expected.report;
    ExpectCounts(report.value(), e.welded_vertices, e.degenerate_triangles, e.duplicate_triangles, e.isolated_vertices);
  }
}

}  // namespace
}  // namespace lacerta
