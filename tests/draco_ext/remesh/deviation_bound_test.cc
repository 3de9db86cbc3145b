#include "remesh/deviation_bound.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace lacerta {
namespace {

// A strip of squares of side 1 along x, two triangles each: vertex 2 i at (i, 0, 0) and 2 i + 1 at (i, 1, 0).
struct Strip {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;

  explicit Strip(uint32_t num_squares) {
    for (uint32_t i = 0; i <= num_squares; ++i) {
      positions.push_back({static_cast<double>(i), 0, 0});
      positions.push_back({static_cast<double>(i), 1, 0});
    }
    for (uint32_t i = 0; i < 2 * num_squares; i += 2) {
      triangles.push_back({i, i + 2, i + 1});
      triangles.push_back({i + 1, i + 2, i + 3});
    }
  }
  DeviationBound Bound(double farthest, std::vector<uint32_t> groups = {}) const {
    groups.resize(triangles.size(), 0);
    return DeviationBound(positions, triangles, std::move(groups), farthest);
  }
};

using Faces = std::vector<DeviationBound::Face>;

// Of two squares: vertex 2, at (1, 0, 0), comes together with vertex 4, at (2, 0, 0), somewhere.
Faces Joined(const Strip& strip) {
  const std::vector<Vec3d>& p = strip.positions;
  return {{0, true, p[1], p[0]}, {1, true, p[3], p[1]}, {2, false, {}, {}}, {3, true, p[5], p[3]}};
}

TEST(DeviationBoundTest, WithinThePlaneAnythingGoesThatLeavesNothingOpen) {
  const Strip strip(2);
  EXPECT_TRUE(strip.Bound(1e-3).Allows({2, 0, 0}, Joined(strip)));
  // The corner at (2, 0, 0) stays behind.
  EXPECT_FALSE(strip.Bound(0.2).Allows({1, 0, 0}, Joined(strip)));
  EXPECT_TRUE(strip.Bound(1.01).Allows({1, 0, 0}, Joined(strip)));
}

TEST(DeviationBoundTest, SidesThatComeToLieOutsideAreSeenToo) {
  const Strip strip(2);
  // Nothing of the strip is left behind: the triangles reach out below it.
  EXPECT_FALSE(strip.Bound(0.2).Allows({2, -0.5, 0}, Joined(strip)));
  EXPECT_TRUE(strip.Bound(0.6).Allows({2, -0.5, 0}, Joined(strip)));
}

TEST(DeviationBoundTest, DistancesAreThoseFromTheOriginal) {
  const Strip strip(2);
  DeviationBound bound = strip.Bound(0.25);
  // Steps of less than the bound, which come to more.
  int num_steps = 0;
  for (; num_steps < 10 && bound.Allows({2, 0, 0.1 * (num_steps + 1)}, Joined(strip)); ++num_steps) bound.Accept();
  EXPECT_EQ(num_steps, 2);
  // What was not accepted changes nothing.
  EXPECT_TRUE(bound.Allows({2, 0, 0}, Joined(strip)));
}

TEST(DeviationBoundTest, GroupsCoverThemselves) {
  const Strip strip(3);
  // The border between the groups is the line x = 1; vertices 2 and 4 and then 3 and 5 come together at x = 2.
  const std::vector<Vec3d>& p = strip.positions;
  const auto moves = [&](DeviationBound bound) {
    if (!bound.Allows(p[4], {{0, true, p[1], p[0]}, {1, true, p[3], p[1]}, {2, false, {}, {}}, {3, true, p[5], p[3]}, {4, true, p[6], p[5]}})) return false;
    bound.Accept();
    return bound.Allows(p[5], {{1, true, p[1], p[4]}, {3, false, {}, {}}, {4, true, p[4], p[6]}, {5, true, p[6], p[7]}});
  };
  EXPECT_TRUE(moves(strip.Bound(0.1)));
  EXPECT_FALSE(moves(strip.Bound(0.1, {0, 0, 1, 1, 1, 1})));
  EXPECT_TRUE(moves(strip.Bound(1.1, {0, 0, 1, 1, 1, 1})));
}

}  // namespace
}  // namespace lacerta
