#include "draco/component_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "shapes/shapes.h"

namespace lacerta {
namespace {

using ::testing::ElementsAre;

// Two triangles beside each other at that place, without a common vertex; `apart` leaves a gap between them.
void AddSquare(const Vec3f& place, bool apart, TriangleMesh* mesh) {
  const auto v = static_cast<uint32_t>(mesh->positions.size());
  const float gap = apart ? 0.1f : 0.0f;
  for (const Vec3f& p : {Vec3f{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, gap, 0}, {1, 1 + gap, 0}, {0, 1 + gap, 0}}) mesh->positions.push_back(place + p);
  mesh->triangles.insert(mesh->triangles.end(), {{v, v + 1, v + 2}, {v + 3, v + 4, v + 5}});
}

std::vector<float> PlacesOf(const TriangleMesh& mesh, const std::vector<Triangle>& triangles) {
  std::vector<float> places;
  places.reserve(triangles.size());
  for (const Triangle& t : triangles) places.push_back(mesh.positions[t[0]].x);
  return places;
}

TEST(ComponentOrder, EachGoesAfterTheNearest) {
  TriangleMesh mesh;
  for (const float x : {20.0f, 50.0f, 10.0f, 40.0f, 31.0f}) AddSquare({x, 0, 0}, false, &mesh);
  EXPECT_THAT(PlacesOf(mesh, ByNearestComponents(mesh)), ElementsAre(20, 20, 10, 10, 31, 31, 40, 40, 50, 50));
}

TEST(ComponentOrder, EqualPositionsHoldTogetherWhatIsFarFromEachOtherInTheList) {
  TriangleMesh mesh;
  for (const float x : {20.0f, 50.0f, 10.0f}) AddSquare({x, 0, 0}, false, &mesh);
  std::rotate(mesh.triangles.begin(), mesh.triangles.begin() + 1, mesh.triangles.end());  // one of the first square goes last
  EXPECT_THAT(PlacesOf(mesh, ByNearestComponents(mesh)), ElementsAre(20, 20, 10, 10, 50, 50));
  TriangleMesh loose;
  for (const float x : {20.0f, 50.0f, 10.0f}) AddSquare({x, 0, 0}, true, &loose);
  std::rotate(loose.triangles.begin(), loose.triangles.begin() + 2, loose.triangles.end());
  EXPECT_THAT(PlacesOf(loose, ByNearestComponents(loose)), ElementsAre(50, 50, 20, 20, 10, 10));
}

TEST(ComponentOrder, OneComponentStaysAsItIsAndNothingIsLost) {
  const TriangleMesh torus = shapes::Torus(8, 12);
  EXPECT_EQ(ByNearestComponents(torus), torus.triangles);
  EXPECT_TRUE(ByNearestComponents({}).empty());
  for (const int count : {3000, 9000}) {
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) AddSquare({static_cast<float>(i * 7919 % count) * 3, 0, 0}, false, &mesh);
    std::vector<Triangle> ordered = ByNearestComponents(mesh);
    EXPECT_EQ(ordered == mesh.triangles, count == 9000) << "too many to be compared with each other";
    std::sort(ordered.begin(), ordered.end());
    EXPECT_EQ(ordered, mesh.triangles);
  }
}

}  // namespace
}  // namespace lacerta
