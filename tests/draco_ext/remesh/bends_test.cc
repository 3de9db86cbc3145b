#include "remesh/bends.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "draco_ext/remesh/profiles.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

Topology TopologyOf(const TriangleMesh& mesh) {
  StatusOr<Topology> topology = BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles);
  EXPECT_TRUE(topology.ok()) << topology.status().message();
  return std::move(topology).value();
}

uint32_t EdgeBetween(const Topology& t, uint32_t a, uint32_t b) {
  const auto at = std::find_if(t.edges.begin(), t.edges.end(),
                               [&](const auto& e) { return (e[0] == a && e[1] == b) || (e[0] == b && e[1] == a); });
  EXPECT_TRUE(at != t.edges.end());
  return static_cast<uint32_t>(at - t.edges.begin());
}

TEST(EdgeBends, AreTheTurnsOfTheProfile) {
  const std::vector<double> turns = {0, 30, -50, 120, 0};
  const TriangleMesh mesh = testing::DrawnOut(turns, 3);
  const Topology topology = TopologyOf(mesh);
  const std::vector<double> bends = EdgeBends(mesh, topology);
  double sum = 0;
  for (uint32_t c = 0; c < turns.size(); ++c) {
    for (uint32_t r = 0; r < 3; ++r) {
      const double bend = bends[EdgeBetween(topology, r * 7 + c + 1, (r + 1) * 7 + c + 1)];
      EXPECT_NEAR(bend, std::abs(turns[c]) * kDegree, 1e-5);
      sum += bend;
    }
  }
  double all = 0;
  for (const double bend : bends) all += bend;
  EXPECT_NEAR(all, sum, 1e-4);  // diagonals, edges across and the border do not bend
}

TEST(BendBeside, SeesTheNextRowAndNoFarther) {
  // Turns two sides apart are out of reach, turns one side apart are not.
  const TriangleMesh mesh = testing::DrawnOut({0, 40, 0, 30, 20, 0, 0, 60, 0}, 9);
  const Topology topology = TopologyOf(mesh);
  const std::vector<double> bends = EdgeBends(mesh, topology);
  const auto beside = [&](uint32_t column) {
    return BendBeside(mesh, topology, bends, EdgeBetween(topology, 4 * 11 + column, 5 * 11 + column)) / kDegree;
  };
  EXPECT_NEAR(beside(2), 0, 1e-3);
  EXPECT_NEAR(beside(3), 70, 1e-3);
  EXPECT_NEAR(beside(4), 20, 1e-3);
  EXPECT_NEAR(beside(5), 30, 1e-3);
  EXPECT_NEAR(beside(8), 0, 1e-3);
}

TEST(BendBeside, IsSeveralBendsOnASmoothSurface) {
  const TriangleMesh mesh = shapes::Icosphere(3);
  const Topology topology = TopologyOf(mesh);
  const std::vector<double> bends = EdgeBends(mesh, topology);
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    const double ratio = BendBeside(mesh, topology, bends, e) / bends[e];
    EXPECT_GT(ratio, 1.0);
    EXPECT_LT(ratio, 8.0);
  }
}

}  // namespace
}  // namespace lacerta
