#include "lacerta/attribute_distance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <utility>
#include <vector>

#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

using ::testing::AllOf;
using ::testing::DoubleNear;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::Le;

constexpr size_t kTexture = 0, kNormal = 1;

AttributedMesh Weld(const std::vector<VertexSoup>& soups) {
  auto mesh = WeldSoups(soups);
  EXPECT_TRUE(mesh.ok()) << mesh.status().message();
  return std::move(mesh).value();
}

AttributeDistance Distance(const AttributedMesh& a, const AttributedMesh& b, const AttributeDistanceOptions& options = {}) {
  const auto meter = AttributeDistanceMeter::Create(a);
  EXPECT_TRUE(meter.ok()) << meter.status().message();
  auto distance = meter.value().Measure(b, options);
  EXPECT_TRUE(distance.ok()) << distance.status().message();
  return std::move(distance).value();
}

TEST(AttributeDistanceTest, IsNearZeroBetweenAMeshAndItself) {
  for (const VertexSoup& soup : {shapes::Cylinder(40, 10), shapes::TexturedBox(3), shapes::TexturedGrid(7, 5, 0.3f)}) {
    const AttributedMesh mesh = Weld({soup});
    const AttributeDistance distance = Distance(mesh, mesh);
    for (const std::vector<AttributeError>* side : {&distance.forward, &distance.backward}) {
      EXPECT_LT((*side)[kTexture].max, 0.01);  // texels: rounding of positions to float
      EXPECT_LT((*side)[kNormal].max, 0.01);
      EXPECT_EQ((*side)[kTexture].share, 1.0);
    }
  }
}

TEST(AttributeDistanceTest, ShiftedTextureIsAsManyTexelsOff) {
  const VertexSoup soup = shapes::TexturedGrid(6, 6);
  VertexSoup shifted = soup;
  for (size_t i = 0; i < shifted.attributes[kTexture].values.size(); i += 2) shifted.attributes[kTexture].values[i] += 3.0f / 1024;
  const AttributeError error = Distance(Weld({soup}), Weld({shifted})).Worst(kTexture);
  EXPECT_NEAR(error.rms_99, 3, 1e-3);
  EXPECT_NEAR(error.rms, 3, 1e-3);
  EXPECT_NEAR(error.max, 3, 1e-3);
  AttributeDistanceOptions coarse;
  coarse.texture_size = 256;
  EXPECT_NEAR(Distance(Weld({soup}), Weld({shifted}), coarse).Worst(kTexture).rms, 0.75, 1e-3);
}

TEST(AttributeDistanceTest, StretchedTextureIsOffByTheIntegral) {
  // u becomes 1.01 u on the unit square: the error is 0.01 u, its mean square 1e-4 / 3.
  const VertexSoup soup = shapes::TexturedGrid(6, 6);
  VertexSoup stretched = soup;
  for (size_t i = 0; i < stretched.attributes[kTexture].values.size(); i += 2) stretched.attributes[kTexture].values[i] *= 1.01f;
  const AttributeError error = Distance(Weld({soup}), Weld({stretched})).forward[kTexture];
  EXPECT_NEAR(error.rms, 10.24 / std::sqrt(3.0), 0.01);
  // Over u up to 0.99: root of 0.99^3 / 3 / 0.99.
  EXPECT_NEAR(error.rms_99, 10.24 * 0.99 / std::sqrt(3.0), 0.01);
  EXPECT_NEAR(error.max, 10.24, 0.02);
}

TEST(AttributeDistanceTest, TurnedNormalsAreAsManyDegreesOff) {
  const VertexSoup soup = shapes::TexturedGrid(6, 6);
  VertexSoup turned = soup;
  constexpr double kAngle = 5 / 57.29577951308232;
  std::vector<float>& normals = turned.attributes[kNormal].values;
  for (size_t i = 0; i < normals.size(); i += 3) {
    normals[i] = static_cast<float>(std::sin(kAngle));
    normals[i + 2] = static_cast<float>(std::cos(kAngle));
  }
  const AttributeError error = Distance(Weld({soup}), Weld({turned})).Worst(kNormal);
  EXPECT_NEAR(error.rms, 5, 1e-4);
  EXPECT_NEAR(error.max, 5, 1e-4);
}

TEST(AttributeDistanceTest, TangentsOfTheOtherSignAreOpposite) {
  VertexSoup soup = shapes::TexturedGrid(2, 2);
  soup.attributes = {{"TANGENT", AttributeKind::kTangent, 4, {}}};
  VertexSoup other = soup;
  for (size_t v = 0; v < soup.positions.size(); ++v) {
    soup.attributes[0].values.insert(soup.attributes[0].values.end(), {1, 0, 0, 1});
    other.attributes[0].values.insert(other.attributes[0].values.end(), {1, 0, 0, -1});
  }
  EXPECT_EQ(Distance(Weld({soup}), Weld({other})).Worst(0).rms, 180);
}

TEST(AttributeDistanceTest, ColorsAreCompared) {
  VertexSoup soup = shapes::TexturedGrid(2, 2);
  soup.attributes = {{"COLOR_0", AttributeKind::kColor, 3, std::vector<float>(27, 0.5f)}};
  VertexSoup other = soup;
  for (float& x : other.attributes[0].values) x += 0.1f;
  EXPECT_NEAR(Distance(Weld({soup}), Weld({other})).Worst(0).rms, 0.1 * std::sqrt(3.0), 1e-6);
}

TEST(AttributeDistanceTest, ASeamThatMovedALittleIsNoError) {
  // Two halves of the plane with textures far apart; the seam of the other surface lies 0.0005 further.
  const auto halves = [](float border) {
    VertexSoup soup;
    soup.attributes = {{"TEXCOORD_0", AttributeKind::kTextureCoordinates, 2, {}}};
    for (const float shift : {0.0f, 10.0f}) {
      const float x0 = shift == 0 ? 0 : border, x1 = shift == 0 ? border : 1;
      const auto first = static_cast<uint32_t>(soup.positions.size());
      for (const Vec3f& p : {Vec3f{x0, 0, 0}, Vec3f{x1, 0, 0}, Vec3f{x1, 1, 0}, Vec3f{x0, 1, 0}}) {
        soup.positions.push_back(p);
        soup.attributes[0].values.insert(soup.attributes[0].values.end(), {p.x + shift, p.y});
      }
      soup.triangles.push_back({first, first + 1, first + 2});
      soup.triangles.push_back({first, first + 2, first + 3});
    }
    return Weld({soup});
  };
  const AttributedMesh mesh = halves(0.5f), moved = halves(0.5005f);
  // The strip is compared with the point of its own side, up to 0.0005 away: 0.5 texels.
  const AttributeError error = Distance(mesh, moved).Worst(kTexture);
  EXPECT_THAT(error.max, AllOf(Ge(0.4), Le(0.55)));
  EXPECT_THAT(error.rms, Le(0.55 * std::sqrt(0.0005)));
  // Further than said: the share of the strip comes to count, and more than one per cent of it even among the best 99 %.
  const AttributeError far = Distance(mesh, halves(0.52f)).Worst(kTexture);
  EXPECT_THAT(far.rms, DoubleNear(10240 * std::sqrt(0.02 - 1e-3 * std::sqrt(2.0)), 30));
  EXPECT_THAT(far.rms_99, Ge(0.9 * 10240 * std::sqrt(0.01 - 1e-3 * std::sqrt(2.0))));
}

TEST(AttributeDistanceTest, AStretchAlongTheSurfaceIsNotMistakenForASeam) {
  // The texture slides by half the distance within which seams are looked across.
  const VertexSoup soup = shapes::TexturedGrid(200, 200);
  VertexSoup shifted = soup;
  for (size_t i = 0; i < shifted.attributes[kTexture].values.size(); i += 2) shifted.attributes[kTexture].values[i] += 0.0005f;
  AttributeDistanceOptions options;
  options.seam_distance = 5e-3;  // of several triangles
  EXPECT_NEAR(Distance(Weld({soup}), Weld({shifted}), options).Worst(kTexture).rms, 0.512, 1e-3);
}

// A square of so many times so many quads, with another one on its back that has a texture of its own.
AttributedMesh Sheet(uint32_t quads) {
  VertexSoup soup = shapes::TexturedGrid(quads, quads), back = soup;
  for (Triangle& t : back.triangles) std::swap(t[1], t[2]);
  for (float& x : back.attributes[kTexture].values) x += 5;
  for (float& x : back.attributes[kNormal].values) x = -x;
  const auto num_front = static_cast<uint32_t>(soup.positions.size());
  for (const Triangle& t : back.triangles) soup.triangles.push_back({t[0] + num_front, t[1] + num_front, t[2] + num_front});
  soup.positions.insert(soup.positions.end(), back.positions.begin(), back.positions.end());
  for (size_t a = 0; a < 2; ++a) {
    soup.attributes[a].values.insert(soup.attributes[a].values.end(), back.attributes[a].values.begin(), back.attributes[a].values.end());
  }
  return Weld({soup});
}

TEST(AttributeDistanceTest, BackAndFrontOfASheetAreToldApart) {
  const AttributedMesh mesh = Sheet(4);
  EXPECT_LT(Distance(mesh, mesh).Worst(kTexture).max, 0.01);
  EXPECT_LT(Distance(mesh, mesh).Worst(kNormal).max, 0.01);
  EXPECT_EQ(Distance(mesh, mesh).backward_turned, 0);
}

TEST(AttributeDistanceTest, BackAndFrontAreToldApartHoweverSmallTheTriangles) {
  const AttributedMesh mesh = Sheet(60);
  AttributeDistanceOptions options;
  options.seam_distance = 0.1;  // within which there are hundreds of triangles
  const AttributeDistance distance = Distance(mesh, mesh, options);
  EXPECT_LT(distance.Worst(kTexture).max, 0.01);
  EXPECT_LT(distance.Worst(kNormal).max, 0.01);
  EXPECT_EQ(distance.backward_turned, 0);
}

TEST(AttributeDistanceTest, AreaThatLooksAwayIsCounted) {
  const VertexSoup soup = shapes::TexturedGrid(10, 10);
  VertexSoup turned = soup;
  for (size_t f = 0; f < 20; ++f) std::swap(turned.triangles[f][1], turned.triangles[f][2]);  // the first of ten rows
  const AttributeDistance distance = Distance(Weld({soup}), Weld({turned}));
  // What lies under the row and within 0.001 diagonals of the next one finds a face there.
  EXPECT_NEAR(distance.forward_turned, 0.1 - 1e-3 * std::sqrt(2.0), 2e-4);
  EXPECT_NEAR(distance.backward_turned, 0.1, 2e-4);
}

TEST(AttributeDistanceTest, ASheetWhoseBackCameBeforeItsFrontIsCounted) {
  constexpr float kThickness = 4e-4f;
  const AttributedMesh sheet = shapes::ThickSheet(kThickness);
  EXPECT_EQ(Distance(sheet, sheet).forward_swapped, 0);
  EXPECT_EQ(Distance(sheet, shapes::ThickSheet(0.2f * kThickness)).forward_swapped, 0);
  EXPECT_EQ(Distance(sheet, shapes::ThickSheet(0.05f * kThickness)).forward_swapped, 1);
  EXPECT_EQ(Distance(sheet, shapes::ThickSheet(0)).forward_swapped, 1);
  const AttributeDistance swapped = Distance(sheet, shapes::ThickSheet(-kThickness));
  EXPECT_EQ(swapped.forward_swapped, 1);
  EXPECT_EQ(swapped.forward_turned, 0);  // a face near looks the right way
  // A gap between two sheets is none, and a sheet too thin to be told apart is not looked at.
  const AttributeDistance back = Distance(shapes::ThickSheet(-kThickness), sheet);
  EXPECT_EQ(back.forward_swapped, 0);
  EXPECT_EQ(back.backward_swapped, 1);
  EXPECT_EQ(Distance(shapes::ThickSheet(1e-5f), shapes::ThickSheet(-1e-5f)).forward_swapped, 0);
}

TEST(AttributeDistanceTest, SidesThatAreUprightByAHairAreNoBack) {
  // A stick of 2000 times its thickness: its sides lean out by 1e-4 of their height at one end, in at the other.
  const auto stick = [](float lean) {
    VertexSoup soup = shapes::TexturedBox(4);
    for (Vec3f& p : soup.positions) p = {p.x, 5e-4f * (p.y - 0.5f) * (1 + lean * p.z), 5e-4f * p.z};
    return Weld({soup});
  };
  AttributeDistanceOptions options;
  options.num_samples = 10'000;
  EXPECT_EQ(Distance(stick(-1e-4f), stick(1e-4f), options).forward_swapped, 0);
  EXPECT_EQ(Distance(stick(1e-4f), stick(-1e-4f), options).forward_swapped, 0);
}

TEST(AttributeDistanceTest, GroupsAreComparedWithThemselves) {
  // The same square twice, as two groups of different colors: of every group only its own may count, and only part has the texture.
  VertexSoup red = shapes::TexturedGrid(2, 2), blue = red;
  red.attributes = {{"COLOR_0", AttributeKind::kColor, 3, std::vector<float>(27, 0.25f)}};
  blue.attributes = {{"COLOR_0", AttributeKind::kColor, 3, std::vector<float>(27, 0.75f)}, blue.attributes[kTexture]};
  const AttributedMesh mesh = Weld({red, blue});
  const AttributeDistance distance = Distance(mesh, mesh);
  EXPECT_LT(distance.Worst(0).max, 1e-6);
  EXPECT_NEAR(distance.Worst(1).share, 0.5, 1e-3);
  const auto meter = AttributeDistanceMeter::Create(mesh);
  AttributedMesh one_group = mesh;
  one_group.groups.assign(one_group.groups.size(), 1);
  one_group.attributes[1].corners = one_group.attributes[0].corners;
  EXPECT_FALSE(meter.value().Measure(one_group).ok());
}

TEST(AttributeDistanceTest, RefusesOtherAttributesAndBadOptions) {
  const AttributedMesh mesh = Weld({shapes::TexturedGrid(2, 2)});
  const auto meter = AttributeDistanceMeter::Create(mesh);
  AttributedMesh other = mesh;
  other.attributes[0].name = "TEXCOORD_1";
  EXPECT_THAT(meter.value().Measure(other).status().message(), HasSubstr("TEXCOORD_0 of the original but TEXCOORD_1"));
  const auto renamed = meter.value().WithNames({"TEXCOORD_1", "NORMAL"}).Measure(other);
  ASSERT_TRUE(renamed.ok());
  EXPECT_EQ(renamed.value().Worst(0).rms, meter.value().Measure(mesh).value().Worst(0).rms);
  EXPECT_FALSE(meter.value().WithNames({"TEXCOORD_1", "NORMAL"}).Measure(mesh).ok());
  other.attributes.pop_back();
  EXPECT_FALSE(meter.value().Measure(other).ok());
  AttributeDistanceOptions options;
  options.num_samples = 0;
  EXPECT_EQ(meter.value().Measure(mesh, options).status().code(), StatusCode::kInvalidArgument);
  AttributedMesh flat = mesh;
  for (Vec3f& p : flat.surface.positions) p = {};
  EXPECT_EQ(AttributeDistanceMeter::Create(flat).status().code(), StatusCode::kInvalidData);
}

TEST(AttributeDistanceTest, DoesNotDependOnTheNumberOfThreads) {
  const AttributedMesh a = Weld({shapes::Cylinder(40, 10)}), b = Weld({shapes::Cylinder(23, 7)});
  const AttributeDistance many = Distance(a, b);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  const AttributeDistance one = Distance(a, b);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(many.Worst(i).rms, one.Worst(i).rms);
    EXPECT_EQ(many.Worst(i).rms_99, one.Worst(i).rms_99);
    EXPECT_EQ(many.Worst(i).max, one.Worst(i).max);
  }
  // Normals of both are interpolated between true ones: off by less than their turn over an edge.
  EXPECT_THAT(many.Worst(kNormal).max, AllOf(Ge(0.01), Le(360.0 / 23)));
}

}  // namespace
}  // namespace lacerta
