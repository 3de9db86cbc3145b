#include "pack/family.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gltf/test_assets.h"

namespace lacerta {
namespace {

struct Scene {
  testing::AssetBuilder builder;
  std::vector<std::vector<Place>> places;
  std::vector<TriangleMesh> meshes;

  void Add(const TriangleMesh& mesh) {
    places.push_back({{places.size(), 0}});
    builder.AddMesh("m", Json::array({builder.Primitive(mesh)}));
    meshes.push_back(mesh);
  }
  Families Find() {
    std::vector<PlacedSurface> surfaces;
    for (size_t i = 0; i < meshes.size(); ++i) surfaces.push_back({&places[i], meshes[i]});
    return FindFamilies(builder.document(), surfaces).value();
  }
};

TEST(Family, TouchingMeshesThatStandAlikeAreOne) {
  Scene scene;
  const TriangleMesh ball = testing::WavySphere(6, 8);
  TriangleMesh cap = ball;  // shares its first vertex with the ball, nothing else
  for (size_t v = 1; v < cap.positions.size(); ++v) cap.positions[v] += Vec3f{0, 0, 3};
  scene.Add(ball);
  scene.Add(testing::WavySphere(6, 8, {5, 0, 0}));
  scene.Add(cap);
  const Families apart = scene.Find();
  EXPECT_EQ(apart.families.size(), 2u);
  EXPECT_EQ(apart.of_surface[0], apart.of_surface[2]);
  EXPECT_NE(apart.of_surface[0], apart.of_surface[1]);
  EXPECT_EQ(apart.families[apart.of_surface[0]].num_meshes, 2u);
  scene.builder.document().json["nodes"][2]["translation"] = {0, 1, 0};  // moved away in the world
  EXPECT_EQ(scene.Find().families.size(), 3u);
}

TEST(Family, ErrorsAreThoseOfTheScene) {
  Scene scene;
  const TriangleMesh ball = testing::WavySphere(6, 8);
  scene.Add(ball);
  scene.Add(testing::WavySphere(6, 8, {100, 0, 0}));
  scene.builder.document().json["nodes"][1]["scale"] = {2, 2, 2};
  const Families families = scene.Find();
  EXPECT_NEAR(families.scene_diagonal, 203.1, 1.0);
  const size_t plain = families.of_surface[0], scaled = families.of_surface[1];
  const double error = families.scene_diagonal * 1e-4;
  EXPECT_NEAR(FamilyError(families, plain, 80.0), error, 1e-9);
  EXPECT_NEAR(FamilyError(families, scaled, 80.0), error / 2, 1e-9);
  // At 50 dB of the scene the ball would be lost: it keeps 40 dB of its own.
  EXPECT_NEAR(FamilyError(families, plain, 50.0), families.families[plain].diagonal * 0.01, 1e-9);
  EXPECT_NEAR(FamilyError(families, plain, 20.0), families.families[plain].diagonal * 0.1, 1e-9);
}

TEST(Family, ASkinPutsItsMeshWhereItsJointsAre) {
  Scene scene;
  scene.Add(testing::WavySphere(6, 8));
  scene.Add(testing::WavySphere(6, 8));
  Json& json = scene.builder.document().json;
  json["nodes"][1]["translation"] = {1000, 0, 0};  // glTF ignores it
  json["nodes"][1]["skin"] = 0;
  const uint64_t joint = json["nodes"].size();
  json["nodes"].push_back({{"translation", {10, 0, 0}}, {"scale", {3, 3, 3}}});
  json["scenes"][0]["nodes"].push_back(joint);
  json["skins"] = Json::array({{{"joints", {joint}}}});
  const Families families = scene.Find();
  const Family& skinned = families.families[families.of_surface[1]];
  EXPECT_NEAR(skinned.stretch, 3.0, 1e-9);
  EXPECT_GT(families.scene_diagonal, 10.0);
  EXPECT_LT(families.scene_diagonal, 20.0);
  json["skins"][0]["joints"] = {joint + 1};  // does not exist: the node's place is all that is known
  EXPECT_GT(scene.Find().scene_diagonal, 990.0);
}

TEST(Family, WhatTheSceneDoesNotShowCountsByItself) {
  Scene scene;
  scene.Add(testing::WavySphere(6, 8));
  scene.builder.document().json["scenes"][0]["nodes"] = Json::array();
  const Families families = scene.Find();
  EXPECT_FALSE(families.families[0].in_scene);
  EXPECT_NEAR(FamilyError(families, 0, 60.0), families.families[0].diagonal * 1e-3, 1e-9);
}

}  // namespace
}  // namespace lacerta
