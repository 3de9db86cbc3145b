#include "remesh/reversal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>

#include "draco_ext/remesh/remeshing.h"

namespace lacerta {
namespace {

using lacerta::testing::BasePositions;
using lacerta::testing::TimeOf;
using lacerta::testing::TopologyOf;

TEST(IsReversed, ComparesWithTheNearestSheetThatAgrees) {
  const TriangleMesh sphere = shapes::Icosphere(3);
  const InputSurface on_sphere(sphere, TopologyOf(sphere));
  for (const Triangle& t : sphere.triangles) {
    const Vec3f &a = sphere.positions[t[0]], &b = sphere.positions[t[1]], &c = sphere.positions[t[2]];
    EXPECT_FALSE(IsReversed(on_sphere, {a, b, c}));
    EXPECT_TRUE(IsReversed(on_sphere, {a, c, b}));
  }
  // A triangle of the upper side that has sunk through to the lower one: long, it is still one of the upper side; short, it is not.
  const TriangleMesh plate = shapes::ThinPlate(16, 0.02f);
  const InputSurface on_plate(plate, TopologyOf(plate));
  Vec3f low = plate.positions[0], high = low;
  for (const Vec3f& p : plate.positions) {
    for (int c = 0; c < 3; ++c) low[c] = std::min(low[c], p[c]), high[c] = std::max(high[c], p[c]);
  }
  const Vec3f center = {0.5f * (low.x + high.x), 0.5f * (low.y + high.y), low.z + 0.001f};
  for (const float size : {0.2f, 0.002f}) {
    const std::array<Vec3f, 3> up = {center, center + Vec3f{size, 0, 0}, center + Vec3f{0, size, 0}};
    EXPECT_EQ(IsReversed(on_plate, up), size < 0.02f);
    EXPECT_FALSE(IsReversed(on_plate, {up[0], up[2], up[1]}));
  }
}

struct Attempt {
  uint32_t num_base_vertices;
  ReversedPart part;
  bool is_due;
};

Attempt RemeshWithout(const TriangleMesh& input, const CollapseHistory& history, uint32_t size, int levels, std::vector<uint32_t>* held) {
  const InputSurface surface(input, TopologyOf(input));
  const BaseDomain domain(history, history.CutWithout(*held, TimeOf(history, input, size)));
  PiercingOptions options;
  options.num_levels = levels;
  ReversedPart part = FindReversed(surface, Pierce(surface, domain, BasePositions(domain, input), options));
  const bool is_due = HoldReversed(part, domain, held);
  return {domain.num_vertices(), std::move(part), is_due};
}

TEST(FindReversed, FindsNothingOnSmoothShapes) {
  for (const TriangleMesh& input : {shapes::Icosphere(4), shapes::Torus(48, 24)}) {
    const CollapseHistory history = testing::Decimated(input, {60, 12, 0.2});
    std::vector<uint32_t> held;
    const Attempt attempt = RemeshWithout(input, history, 100, 3, &held);
    EXPECT_EQ(attempt.part.share, 0);
    EXPECT_TRUE(attempt.part.faces.empty());
    EXPECT_FALSE(attempt.is_due);
    EXPECT_TRUE(held.empty());
  }
}

TEST(FindReversed, CountsTheAreaOfTurnedTriangles) {
  const TriangleMesh input = shapes::Icosphere(4);
  NormalMesh mesh = testing::Remesh(input, 60, 2);
  const InputSurface surface(input, TopologyOf(input));
  // Two neighbors of the finest level change places: the triangles at them turn over.
  Topology t = BuildTopology(mesh.mesh.num_base_vertices, mesh.mesh.base_triangles).value();
  for (int level = 0; level < 2; ++level) t = Refine(t);
  const Triangle middle = t.triangles[3];
  std::swap(mesh.mesh.positions[middle[0]], mesh.mesh.positions[middle[1]]);
  const ReversedPart part = FindReversed(surface, mesh);
  EXPECT_GT(part.share, 0.5 / static_cast<double>(t.num_faces()));
  EXPECT_LT(part.share, 24.0 / static_cast<double>(t.num_faces()));
  ASSERT_FALSE(part.faces.empty());
  EXPECT_LE(part.faces.size(), 3u) << "around one edge";
  double sum = 0;
  for (size_t i = 0; i < part.faces.size(); ++i) {
    sum += part.faces[i].share;
    EXPECT_TRUE(i == 0 || part.faces[i].share <= part.faces[i - 1].share);
  }
  EXPECT_NEAR(sum, part.share, 1e-12);
}

// A few faces of a base that fold over what they stand for: split again, they no longer do.
TEST(HoldReversed, MendsAFewBadFacesWithAFewVertices) {
  struct Case {
    const char* name;
    TriangleMesh input;
    uint32_t size;
  };
  const Case cases[] = {{"short spikes", shapes::SpikySphere(4, 12, 1.0f), 16},
                        {"long spikes", shapes::SpikySphere(5, 6, 3.0f), 24},
                        {"bumps", shapes::BumpySphere(4, 0.4f, 0.035f), 16},
                        {"handles", shapes::TwoHoledPlate(8), 16},
                        {"ring", shapes::Torus(60, 16, 1.0f, 0.1f), 16}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const CollapseHistory history = testing::Decimated(c.input, {8, 12, 0.2});
    std::vector<uint32_t> held;
    const Attempt first = RemeshWithout(c.input, history, c.size, 3, &held);
    EXPECT_GT(first.part.share, kMostReversed);
    ASSERT_TRUE(first.is_due);
    Attempt last = first;
    for (int round = 1; round < kReversalRounds && last.is_due; ++round) last = RemeshWithout(c.input, history, c.size, 3, &held);
    EXPECT_LE(last.part.share, kMostReversed);
    EXPECT_GT(last.num_base_vertices, first.num_base_vertices);
    EXPECT_LE(last.num_base_vertices, first.num_base_vertices + 6);
  }
}

TEST(HoldReversed, LeavesABaseAloneThatIsTooCoarseAsAWhole) {
  const TriangleMesh input = shapes::SpikySphere(5, 40, 0.9f);
  const CollapseHistory history = testing::Decimated(input, {60, 12, 0.2});
  std::vector<uint32_t> held;
  const Attempt attempt = RemeshWithout(input, history, 60, 4, &held);
  EXPECT_GT(attempt.part.share, 10 * kMostReversed);
  EXPECT_GT(attempt.part.faces.size(), 116u / 32);
  EXPECT_FALSE(attempt.is_due);
  EXPECT_TRUE(held.empty());
}

}  // namespace
}  // namespace lacerta
