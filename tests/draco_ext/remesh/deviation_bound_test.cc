#include "remesh/deviation_bound.h"

#include <gtest/gtest.h>

#include <memory>
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
    auto samples = std::make_shared<const DeviationSamples>(positions, triangles, groups, farthest);
    return DeviationBound(std::move(samples), triangles.size(), std::move(groups));
  }
  // Of the strip as it was `below` itself.
  DeviationBound BoundOfLower(double farthest, float below) const {
    TriangleMesh lower{{}, triangles};
    for (const Vec3d& p : positions) lower.positions.push_back(Vec3Cast<float>(p) - Vec3f{0, 0, below});
    return DeviationBound(std::make_shared<const DeviationSamples>(positions, triangles, std::vector<uint32_t>(), farthest), lower);
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

TEST(DeviationBoundTest, WhatIsFarFromTheOriginalMayStayButGoNoFarther) {
  const Strip strip(2);
  const auto allows = [&](double farthest, float below, double to) {
    Faces faces = Joined(strip);
    for (DeviationBound::Face& face : faces) face.a.z = face.b.z = -static_cast<double>(below);
    return strip.BoundOfLower(farthest, below).Allows({2, 0, to}, faces);
  };
  EXPECT_TRUE(allows(0.3, 0.25f, -0.25));
  EXPECT_TRUE(allows(0.3, 0.25f, -0.29));
  EXPECT_FALSE(allows(0.3, 0.25f, -0.4));
  // Triangles as large as those are looked at, too, and are too far off.
  EXPECT_FALSE(allows(0.2, 0.25f, -0.25));
  constexpr double kSmall = 4;  // bounds, which no side is longer than
  EXPECT_TRUE(allows(kSmall, 4.5f, -4.5));
  EXPECT_FALSE(allows(kSmall, 4.5f, -5.5));
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
