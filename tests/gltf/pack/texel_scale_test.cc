#include "pack/texel_scale.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "document/primitive.h"

namespace lacerta {
namespace {

constexpr uint64_t kSide = 1024;

// Mesh 0 of a material with a texture on TEXCOORD_0, repeated `repeats` times, mesh 1 of one without textures.
GltfDocument TwoMeshes(const std::string& repeats = "1") {
  GltfDocument document;
  document.json = Json::parse(R"({"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [1, )" + repeats +
                              R"(]}}}}}, {"name": "plain"}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]},
                                {"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 1}]}]})");
  return document;
}

// A triangle whose coordinates of both sets are from `low` to `high` in v and from 0 to 1 in u.
Primitive Triangle(float low, float high) {
  Primitive primitive;
  primitive.num_vertices = 3;
  primitive.triangles = {{0, 1, 2}};
  for (const char* name : {"TEXCOORD_0", "TEXCOORD_1"}) primitive.attributes.push_back({name, MakeFloatAccessor({0, low, 1, high, 0.5f, low}, 2)});
  return primitive;
}

// Of members in those meshes.
TexelScale ScaleOf(const GltfDocument& document, const std::vector<std::pair<uint64_t, Primitive>>& members) {
  std::vector<std::vector<Place>> places(members.size());
  for (size_t m = 0; m < members.size(); ++m) places[m] = {{members[m].first, 0}};
  std::vector<PlacedPrimitive> placed;
  for (size_t m = 0; m < members.size(); ++m) placed.push_back({&places[m], &members[m].second});
  return TexelScaleOf(document, placed, kSide);
}

TEST(TexelScale, IsTheTextureRepeatedAsOftenAsItsTransformSays) {
  EXPECT_EQ(ScaleOf(TwoMeshes("7"), {{0, Triangle(0, 1)}})(0, 0), 7 * 1024);
  EXPECT_EQ(ScaleOf(TwoMeshes("-7"), {{0, Triangle(0, 1)}})(0, 0), 7 * 1024);
  EXPECT_EQ(ScaleOf(TwoMeshes("0.1"), {{0, Triangle(0, 1)}})(0, 0), 1024);
  EXPECT_EQ(ScaleOf(TwoMeshes("1e30"), {{0, Triangle(0, 1)}})(0, 0), 1e4 * 1024);
}

TEST(TexelScale, OfWhatIsSeenDoesNotDependOnItsValues) { EXPECT_EQ(ScaleOf(TwoMeshes(), {{0, Triangle(-300, 700)}})(0, 0), 1024); }

TEST(TexelScale, OfWhatNobodySeesHasFourTexturesOverTheRangeOfItsValues) {
  const GltfDocument document = TwoMeshes();
  EXPECT_EQ(ScaleOf(document, {{1, Triangle(0, 1)}})(0, 0), 1024);
  EXPECT_EQ(ScaleOf(document, {{1, Triangle(-1, 3)}})(0, 0), 1024);
  EXPECT_EQ(ScaleOf(document, {{1, Triangle(-300, 700)}})(0, 0), 1024 * 4 / 1000.0);
  EXPECT_EQ(ScaleOf(document, {{0, Triangle(-300, 700)}})(0, 1), 1024 * 4 / 1000.0);  // the other set of a textured one
  EXPECT_EQ(ScaleOf(document, {{1, Triangle(0, 1e30f)}})(0, 0), 1024 * 1e-6);
}

TEST(TexelScale, IsOneForAFamily) {
  const GltfDocument document = TwoMeshes();
  const TexelScale unseen = ScaleOf(document, {{1, Triangle(0, 1)}, {1, Triangle(7, 8)}});
  EXPECT_EQ(unseen(0, 0), 512);  // eight units from the least to the most
  EXPECT_EQ(unseen(1, 0), 512);
  const TexelScale seen = ScaleOf(document, {{0, Triangle(0, 1)}, {1, Triangle(0, 8)}});  // the first shows it
  EXPECT_EQ(seen(0, 0), 1024);
  EXPECT_EQ(seen(1, 0), 1024);
}

}  // namespace
}  // namespace lacerta
