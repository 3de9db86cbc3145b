#include "pack/simplified.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
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

TEST(Simplified, RefusesWhatCannotBeInterpolated) {
  Primitive primitive = Half(testing::WavySphere(8, 12), true);
  primitive.attributes.push_back({"_MINE", primitive.attributes[0].data});
  const auto family = SimplifyFamily(FamilyMeter({&primitive}, 0.01, {}, 1024, [](size_t, uint64_t) { return 1024.0; }));
  EXPECT_EQ(family.status().code(), StatusCode::kUnsupported);
}

}  // namespace
}  // namespace lacerta
