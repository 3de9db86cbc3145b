#include "common/length_classes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "common/coefficient_coding.h"
#include "shapes/base_meshes.h"

namespace lacerta {
namespace {

using Lattice = std::vector<std::array<int32_t, 3>>;

// Two triangles over a long edge: 0-1 of squared length 4 s^2, the others of 2 s^2 or less.
const std::vector<Triangle> kTriangles = {{0, 1, 2}, {1, 0, 3}};
Lattice Kite(int32_t s) { return {{-s, 0, 0}, {s, 0, 0}, {0, s, 0}, {0, -s / 8, 0}}; }

uint8_t ClassOf(const Topology& t, const std::vector<uint8_t>& classes, uint32_t a, uint32_t b) {
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    const auto& ends = t.edges[e];
    if ((ends[0] == a && ends[1] == b) || (ends[0] == b && ends[1] == a)) return classes[e];
  }
  ADD_FAILURE() << "no edge " << a << " " << b;
  return 0;
}

TEST(LengthClasses, TellShortAndLongEdges) {
  // Squares in units of s^2: 4, 2, 2, 65/64, 65/64; the mean is about 2.
  const Topology t = BuildTopology(4, kTriangles).value();
  for (const int32_t s : {8, 1000, 8000000, (1 << 24) - 8}) {  // up to the largest lattice
    const std::vector<uint8_t> classes = LengthClasses(t, Kite(s));
    ASSERT_EQ(classes.size(), t.num_edges());
    EXPECT_EQ(ClassOf(t, classes, 0, 1), kLongLength) << s;
    EXPECT_EQ(ClassOf(t, classes, 1, 2), kUsualLength) << s;
    EXPECT_EQ(ClassOf(t, classes, 0, 3), kUsualLength) << s;
  }
  Lattice lattice = Kite(1000);
  lattice[3] = {-900, 0, 0};
  EXPECT_EQ(ClassOf(t, LengthClasses(t, lattice), 0, 3), kShortLength);
}

TEST(LengthClasses, AreUsualWhereAllEdgesAreAlike) {
  const TriangleMesh mesh = shapes::Icosahedron();
  const Topology t = shapes::TopologyOf(mesh);
  Lattice lattice;
  for (const Vec3f& p : mesh.positions) {
    lattice.push_back({static_cast<int32_t>(std::lround(100 * p.x)), static_cast<int32_t>(std::lround(100 * p.y)), static_cast<int32_t>(std::lround(100 * p.z))});
  }
  const std::vector<uint8_t> classes = LengthClasses(t, lattice);
  EXPECT_EQ(std::count(classes.begin(), classes.end(), kUsualLength), 30);
}

TEST(LengthClasses, AreUsualOfPointsInOnePlace) {
  const Topology t = BuildTopology(4, kTriangles).value();
  EXPECT_EQ(LengthClasses(t, Lattice(4)), std::vector<uint8_t>(t.num_edges(), kUsualLength));
}

TEST(HandDown, GivesHalvesAndParallelEdgesTheClassOfTheirParent) {
  // Where vertices are the sums of the ends of their edges, edges of a refined plane mesh are half of, and parallel to, their parents.
  const Lattice points = {{0, 0, 0}, {10, 0, 0}, {3, 7, 0}, {4, -5, 0}};
  const Topology t = BuildTopology(4, kTriangles).value();
  std::vector<uint32_t> numbers(t.num_edges());
  for (uint32_t e = 0; e < t.num_edges(); ++e) numbers[e] = e;
  const Topology finer = Refine(t);
  const std::vector<uint32_t> parents = HandDown(t, numbers);
  ASSERT_EQ(parents.size(), finer.num_edges());
  const auto at = [&](uint32_t v) {
    std::array<int32_t, 2> p = {0, 0};
    for (size_t k = 0; k < 2; ++k) {
      p[k] = v < t.num_vertices ? 2 * points[v][k] : points[t.edges[v - t.num_vertices][0]][k] + points[t.edges[v - t.num_vertices][1]][k];
    }
    return p;
  };
  for (uint32_t e = 0; e < finer.num_edges(); ++e) {
    const auto a = at(finer.edges[e][0]), b = at(finer.edges[e][1]);
    const auto& c = points[t.edges[parents[e]][0]];
    const auto& d = points[t.edges[parents[e]][1]];
    EXPECT_EQ(std::abs(b[0] - a[0]), std::abs(d[0] - c[0])) << e;
    EXPECT_EQ(std::abs(b[1] - a[1]), std::abs(d[1] - c[1])) << e;
  }
}

}  // namespace
}  // namespace lacerta
