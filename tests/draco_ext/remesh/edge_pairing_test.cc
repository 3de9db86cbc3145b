#include "remesh/edge_pairing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lacerta {
namespace {

using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

constexpr double kDegree = 3.14159265358979323846 / 180;

// Faces at the edge from vertex 0 up to vertex 1, each with a third vertex of its own.
struct Leaf {
  double degrees;
  bool forward;
};

TriangleMesh Book(const std::vector<Leaf>& leaves) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}};
  for (const Leaf& l : leaves) {
    const auto v = static_cast<uint32_t>(mesh.positions.size());
    const double a = l.degrees * kDegree;
    mesh.positions.push_back({static_cast<float>(std::cos(a)), static_cast<float>(std::sin(a)), 0.5f});
    mesh.triangles.push_back(l.forward ? Triangle{0, 1, v} : Triangle{1, 0, v});
  }
  return mesh;
}

std::vector<std::pair<uint32_t, uint32_t>> PairedFaces(const TriangleMesh& mesh) {
  std::vector<uint32_t> corners;
  for (uint32_t f = 0; f < mesh.triangles.size(); ++f) corners.push_back(3 * f + 2);
  std::vector<std::pair<uint32_t, uint32_t>> faces;
  for (const auto& [c, d] : PairAroundEdge(mesh, std::vector<uint8_t>(mesh.triangles.size(), 0), corners)) {
    faces.emplace_back(std::min(c, d) / 3, std::max(c, d) / 3);
  }
  return faces;
}

TEST(PairAroundEdge, TheStraightestPairOfThreeStaysTogether) {
  EXPECT_THAT(PairedFaces(Book({{0, true}, {170, false}, {90, false}})), UnorderedElementsAre(std::make_pair(0u, 1u)));
  EXPECT_THAT(PairedFaces(Book({{0, true}, {100, false}, {185, false}})), UnorderedElementsAre(std::make_pair(0u, 2u)));
}

TEST(PairAroundEdge, OppositeDirectionsGoFirst) {
  EXPECT_THAT(PairedFaces(Book({{0, true}, {180, true}, {100, false}})), UnorderedElementsAre(std::make_pair(0u, 2u)));
  EXPECT_THAT(PairedFaces(Book({{0, true}, {180, true}, {100, true}})), UnorderedElementsAre(std::make_pair(0u, 1u)));
  EXPECT_THAT(PairedFaces(Book({{0, true}, {180, true}, {100, false}, {10, true}})),
              UnorderedElementsAre(std::make_pair(0u, 2u), std::make_pair(1u, 3u)));
}

TEST(PairAroundEdge, NothingFoldsBackOnItself) {
  EXPECT_THAT(PairedFaces(Book({{0, true}, {1, false}, {2, true}})), IsEmpty());
  EXPECT_THAT(PairedFaces(Book({{0, true}, {20, false}})), UnorderedElementsAre(std::make_pair(0u, 1u)));
  // The two sheets of a thin wall, with nothing between.
  EXPECT_THAT(PairedFaces(Book({{0, true}, {0, false}, {180, true}, {180, false}})),
              UnorderedElementsAre(std::make_pair(0u, 3u), std::make_pair(1u, 2u)));
}

TEST(PairAroundEdge, EachOfTwoSolidsThatTouchKeepsItsFaces) {
  // Material between 0 and 90 and between 180 and 270 degrees; forward faces have theirs at the smaller angles.
  EXPECT_THAT(PairedFaces(Book({{0, false}, {90, true}, {180, false}, {270, true}})),
              UnorderedElementsAre(std::make_pair(0u, 1u), std::make_pair(2u, 3u)));
  // Inside out: material between 90 and 180 and between 270 and 360 degrees.
  EXPECT_THAT(PairedFaces(Book({{0, true}, {90, false}, {180, true}, {270, false}})),
              UnorderedElementsAre(std::make_pair(1u, 2u), std::make_pair(0u, 3u)));
}

TEST(PairAroundEdge, FacesWithoutAreaArePairedLast) {
  TriangleMesh mesh = Book({{0, true}, {180, false}, {90, true}, {90, false}});
  mesh.positions[4] = {0, 0, 0.25f};
  mesh.positions[5] = {0, 0, 0.75f};
  EXPECT_THAT(PairedFaces(mesh), UnorderedElementsAre(std::make_pair(0u, 1u), std::make_pair(2u, 3u)));
}

TEST(PairAroundEdge, AnEdgeOfManyFacesIsPairedAsWell) {
  std::vector<Leaf> leaves;
  for (int i = 0; i < 2000; ++i) leaves.push_back({0.09 * i, true});
  for (int i = 0; i < 2000; ++i) leaves.push_back({180 + 0.09 * i, false});
  const auto pairs = PairedFaces(Book(leaves));
  EXPECT_EQ(pairs.size(), 2000u);
  for (const auto& [f, g] : pairs) EXPECT_EQ(f + 2000, g);
}

TEST(SameVertices, WhateverTheOrder) {
  EXPECT_TRUE(SameVertices({1, 2, 3}, {3, 2, 1}));
  EXPECT_TRUE(SameVertices({1, 2, 3}, {2, 3, 1}));
  EXPECT_FALSE(SameVertices({1, 2, 3}, {1, 2, 4}));
}

}  // namespace
}  // namespace lacerta
