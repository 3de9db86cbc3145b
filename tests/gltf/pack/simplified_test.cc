#include "pack/simplified.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "decoder/smooth_normals.h"
#include "gltf/test_assets.h"
#include "lacerta/surface_distance.h"

namespace lacerta {
namespace {

// One half of a ball, z above or below the equator's ring; both halves have the vertices of that ring.
Primitive Half(const TriangleMesh& ball, bool upper) {
  TriangleMesh half = ball;
  half.triangles.clear();
  for (const Triangle& t : ball.triangles) {
    const float z = ball.positions[t[0]].z + ball.positions[t[1]].z + ball.positions[t[2]].z;
    if ((z > 0.0f) == upper) half.triangles.push_back(t);
  }
  Primitive primitive;
  primitive.num_vertices = half.positions.size();
  primitive.triangles = half.triangles;
  std::vector<float> texture;
  for (const Vec3f& p : half.positions) texture.insert(texture.end(), {0.5f + 0.4f * p.x, 0.5f + 0.4f * p.y});
  primitive.attributes = {{"POSITION", MakeFloatAccessor(half.positions)},
                          {"NORMAL", MakeFloatAccessor(SmoothNormals(ball.positions, ball.triangles))},
                          {"TEXCOORD_0", MakeFloatAccessor(texture, 2)}};
  return primitive;
}

std::set<std::tuple<float, float, float>> Border(const Primitive& primitive) {
  const TriangleMesh mesh = Surface(primitive);
  std::map<std::pair<std::tuple<float, float, float>, std::tuple<float, float, float>>, int> edges;
  const auto at = [&](uint32_t v) { return std::make_tuple(mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z); };
  for (const Triangle& t : mesh.triangles) {
    for (size_t i = 0; i < 3; ++i) ++edges[std::minmax(at(t[i]), at(t[(i + 1) % 3]))];
  }
  std::set<std::tuple<float, float, float>> border;
  for (const auto& [edge, count] : edges) {
    if (count == 1) border.insert({edge.first, edge.second});
  }
  return border;
}

TEST(Simplified, HalvesStayJoinedAndMeetTheErrors) {
  const TriangleMesh ball = testing::WavySphere(40, 64);
  const Primitive upper = Half(ball, true);
  const Primitive lower = Half(ball, false);
  const double error = DistanceOfPsnr(55.0, BoundingBoxDiagonal(ball));
  const FamilyMeter meter({&upper, &lower}, error, {}, 1024, [](size_t, uint64_t) { return 1024.0; });
  const auto family = SimplifyFamily(meter);
  ASSERT_TRUE(family.ok()) << family.status().message();
  ASSERT_EQ(family.value().members.size(), 2u);
  EXPECT_LE(family.value().error, error);
  EXPECT_GT(family.value().error, error / 4);
  const Primitive& a = family.value().members[0].decoded;
  const Primitive& b = family.value().members[1].decoded;
  EXPECT_LT(a.triangles.size() * 2, upper.triangles.size());
  EXPECT_FALSE(Border(a).empty());
  EXPECT_EQ(Border(a), Border(b));  // bit by bit
  for (const auto& reports : family.value().reports) {
    for (const AttributeReport& report : reports) {
      EXPECT_LE(report.error, report.unit == "texels" ? AttributeTargets().uv_texels : AttributeTargets().normal_degrees);
      EXPECT_GT(report.bits, 0) << report.name;
    }
  }
}

TEST(Simplified, BestEffortKeepsTheSmallestOfSeveralShares) {
  const TriangleMesh ball = testing::WavySphere(40, 64);
  const Primitive upper = Half(ball, true);
  int num_smaller = 0;
  for (const double psnr : {52.0, 55.0, 58.0, 61.0}) {
    const double error = DistanceOfPsnr(psnr, BoundingBoxDiagonal(ball));
    const FamilyMeter meter({&upper}, error, {}, 1024, [](size_t, uint64_t) { return 1024.0; });
    const auto usual = SimplifyFamily(meter), best = SimplifyFamily(meter, {}, Effort::kBest);
    ASSERT_TRUE(usual.ok() && best.ok());
    const size_t bytes = usual.value().members[0].bytes.size(), fewest = best.value().members[0].bytes.size();
    EXPECT_LE(fewest, bytes);
    EXPECT_GT(static_cast<double>(fewest), 0.8 * static_cast<double>(bytes));
    EXPECT_LE(best.value().error, error);
    num_smaller += fewest < bytes;
  }
  EXPECT_GT(num_smaller, 0);
}

TEST(Simplified, WhatLeavesRoundingNoRoomIsKeptCloser) {
  const TriangleMesh ball = testing::WavySphere(40, 64);
  const Primitive upper = Half(ball, true);
  const double error = DistanceOfPsnr(55.0, BoundingBoxDiagonal(ball));
  const FamilyMeter meter({&upper}, error, {}, 1024, [](size_t, uint64_t) { return 1024.0; });
  std::vector<double> worst;
  std::vector<size_t> sizes;
  StatusCode code = StatusCode::kUnsupported;
  const auto refuse = [&](const SimplifiedFamily& simplified) -> StatusOr<RoundedFamily> {
    worst.push_back(WorstRatio(simplified.errors, meter.targets()));
    sizes.push_back(simplified.primitives[0].triangles.size());
    if (worst.back() > 0.6) return Status(code, "too far off");
    return RoundFamily(PointersTo(simplified.primitives), meter, &simplified.errors);
  };
  const auto family = SimplifyAndRound(meter, {}, refuse);
  ASSERT_TRUE(family.ok()) << family.status().message();
  EXPECT_LE(family.value().error, error);
  ASSERT_EQ(worst.size(), 3u);
  for (size_t i = 1; i < worst.size(); ++i) {
    EXPECT_LT(worst[i], 0.9 * worst[i - 1]);
    EXPECT_GT(sizes[i], sizes[i - 1]);
  }
  EXPECT_GT(worst.back(), 0.3);
  worst.clear();
  code = StatusCode::kInternal;  // nothing that more room would mend
  EXPECT_EQ(SimplifyAndRound(meter, {}, refuse).status().code(), code);
  EXPECT_EQ(worst.size(), 1u);
}

TEST(Simplified, DenseSurfacesAreHeldToThemselvesNotToTheirProxy) {
  const TriangleMesh ball = testing::WavySphere(230, 450);
  const Primitive upper = Half(ball, true);
  const Primitive lower = Half(ball, false);
  const double error = DistanceOfPsnr(70.0, BoundingBoxDiagonal(ball));
  FamilyMeter meter({&upper, &lower}, error, {}, 1024, [](size_t, uint64_t) { return 1024.0; });
  EXPECT_EQ(meter.simplifiable().surface.triangles.size(), meter.original().surface.triangles.size());
  ASSERT_TRUE(meter.UseProxy().ok());
  ASSERT_TRUE(meter.has_proxy());
  EXPECT_LE(meter.simplifiable().surface.triangles.size(), 100'000u);
  EXPECT_GE(meter.simplifiable().surface.triangles.size(), 99'900u);
  const auto family = SimplifyFamily(meter);
  ASSERT_TRUE(family.ok()) << family.status().message();
  EXPECT_LE(family.value().error, error);
  EXPECT_GT(family.value().error, error / 4);
  EXPECT_EQ(Border(family.value().members[0].decoded), Border(family.value().members[1].decoded));
}

// Waves of an amplitude of 50 over the surface, and how far `family` has them off, at the vertices that it keeps.
float HeatAt(const Vec3f& p) { return 50.0f * std::sin(4.0f * p.x) * std::cos(3.0f * p.y) + p.z; }

Primitive WithHeat(const TriangleMesh& ball) {
  Primitive primitive = Half(ball, true);
  std::vector<float> heat;
  for (const Vec3f& p : ball.positions) heat.push_back(HeatAt(p));
  primitive.attributes.push_back({"_HEAT", MakeFloatAccessor(heat, 1)});
  return primitive;
}

TEST(Simplified, ApplicationAttributesKeepTheirOwnTarget) {
  const Primitive primitive = WithHeat(testing::WavySphere(40, 64));
  size_t fewest = 0;
  for (const double custom : {0.01, 0.001}) {
    AttributeTargets targets;
    targets.custom = custom;
    const FamilyMeter meter({&primitive}, 0.03, targets, 1024, [](size_t, uint64_t) { return 1024.0; });
    EXPECT_EQ(meter.custom(), std::set<std::string>{"_HEAT"});
    const auto family = SimplifyFamily(meter);
    ASSERT_TRUE(family.ok()) << family.status().message();
    const Primitive& decoded = family.value().members[0].decoded;
    const Attribute* heat = decoded.Find("_HEAT");
    ASSERT_NE(heat, nullptr);
    // Those on the open border lie on it, where the function is known.
    double squares = 0.0;
    const TriangleMesh surface = Surface(decoded);
    for (uint64_t v = 0; v < decoded.num_vertices; ++v) {
      const double off = heat->data.Float(v, 0) - HeatAt(surface.positions[v]);
      squares += off * off;
    }
    const double range = 100.0, rms = std::sqrt(squares / static_cast<double>(decoded.num_vertices));
    EXPECT_LT(rms, 2.0 * custom * range);
    EXPECT_GT(rms, 0.05 * custom * range);
    EXPECT_LT(decoded.triangles.size(), primitive.triangles.size());
    EXPECT_GT(decoded.triangles.size(), fewest);
    fewest = decoded.triangles.size();
    const auto report = std::find_if(family.value().reports[0].begin(), family.value().reports[0].end(),
                                     [](const AttributeReport& r) { return r.name == "_HEAT"; });
    ASSERT_NE(report, family.value().reports[0].end());
    EXPECT_LE(report->error, custom * range * 1.02);
    EXPECT_GT(report->bits, 0);
  }
}

TEST(Simplified, WhatMayBeANameStaysExact) {
  Primitive primitive = WithHeat(testing::WavySphere(8, 12));
  const auto custom = [](const Primitive& p) { return CustomAttributesOf({&p}); };
  EXPECT_EQ(custom(primitive), std::set<std::string>{"_HEAT"});
  Primitive whole = primitive, other = primitive, bytes = primitive;
  whole.attributes.back().data = MakeFloatAccessor(std::vector<float>(whole.num_vertices, 7.0f), 1);
  EXPECT_TRUE(custom(whole).empty());
  bytes.attributes.back().data.type = ComponentType::kUint8;
  EXPECT_TRUE(custom(bytes).empty());
  EXPECT_TRUE(CustomAttributesOf({&primitive, &bytes}).empty());
  other.attributes.back().name = "HEAT";
  EXPECT_TRUE(custom(other).empty());
  AttributeTargets exact;
  exact.custom = 0.0;
  EXPECT_TRUE(FamilyMeter({&primitive}, 0.01, exact, 1024, [](size_t, uint64_t) { return 1024.0; }).leaves_out());
}

TEST(Simplified, RefusesWhatCannotBeInterpolated) {
  Primitive primitive = Half(testing::WavySphere(8, 12), true);
  primitive.attributes.push_back({"_MINE", MakeFloatAccessor(std::vector<float>(primitive.num_vertices, 3.0f), 1)});
  const auto family = SimplifyFamily(FamilyMeter({&primitive}, 0.01, {}, 1024, [](size_t, uint64_t) { return 1024.0; }));
  EXPECT_EQ(family.status().code(), StatusCode::kUnsupported);
}

}  // namespace
}  // namespace lacerta
