// Skinned meshes through the whole packer: what a viewer shows of them in poses stays within the error.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <tuple>

#include "gltf/skinned_asset.h"
#include "lacerta/file_io.h"
#include "lacerta/surface_distance.h"

namespace lacerta {
namespace {

using testing::PosedAt;
using testing::SkinnedCylinderAsset;

double PosedPsnr(const Bytes& original, const Bytes& unpacked, size_t animation, double time) {
  const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(PosedAt(original, animation, time)).value();
  return Psnr(meter.Measure(PosedAt(unpacked, animation, time)).value().Rms(), meter.diagonal());
}

// The least over times of which some are, others are not among those that the packer looks at.
double WorstPsnr(const Bytes& original, const Bytes& unpacked) {
  const std::vector<Animation> animations = ReadAnimations(ParseGltf(original, "").value());
  double worst = PosedPsnr(original, unpacked, animations.size(), 0.0);
  for (size_t a = 0; a < animations.size(); ++a) {
    for (const double share : {0.0, 0.29, 0.5, 0.83, 1.0}) {
      const double time = animations[a].begin + share * (animations[a].end - animations[a].begin);
      worst = std::min(worst, PosedPsnr(original, unpacked, a, time));
    }
  }
  return worst;
}

PackResult Pack(const Bytes& asset, bool simplify = true) {
  PackOptions options;
  options.simplify = simplify;
  return PackGltf(asset, options).value();
}

Bytes Unpacked(const PackResult& packed) { return UnpackGltf(packed.glb, {}).value().glb; }

Bytes BentCylinder() { return SkinnedCylinderAsset(shapes::SkinnedCylinder(48, 104), 60.0); }

const PackResult& PackedBentCylinder() {
  static const PackResult* const kResult = new PackResult(Pack(BentCylinder()));
  return *kResult;
}

TEST(Skin, SlotsWithoutWeightAreUnpackedAsJointZero) {
  const GltfDocument document = ParseGltf(Unpacked(PackedBentCylinder()), "").value();
  const Primitive primitive = ReadPrimitive(document, PrimitiveAt(document, {0, 0}), {}).value();
  const Attribute *joints = primitive.Find("JOINTS_0"), *weights = primitive.Find("WEIGHTS_0");
  ASSERT_TRUE(joints != nullptr && weights != nullptr);
  uint64_t without = 0, others = 0;
  for (uint64_t v = 0; v < primitive.num_vertices; ++v) {
    for (uint32_t c = 0; c < 4; ++c) {
      const bool weightless = weights->data.Float(v, c) == 0.0f;
      without += weightless;
      others += !weightless && joints->data.Float(v, c) != 0.0f;
      ASSERT_TRUE(!weightless || joints->data.Float(v, c) == 0.0f) << "vertex " << v << ", slot " << c;
    }
  }
  EXPECT_GT(without, 0u);
  EXPECT_GT(others, 0u);
}

// Vertices moved around the axis, with their texture and normals, by up to a sixteenth of their distance: all of a regular grid takes hardly more bytes than
// what simplification leaves of it.
shapes::SkinnedSoup Uneven(shapes::SkinnedSoup skinned) {
  std::vector<VertexSoup::Attribute>& attributes = skinned.soup.attributes;
  for (size_t v = 0; v < skinned.soup.positions.size(); ++v) {
    Vec3f& p = skinned.soup.positions[v];
    const float angle = std::atan2(p.y, p.x), by = 0.008f * std::sin(17 * angle + 23 * p.z);
    const float x = std::cos(angle + by), y = std::sin(angle + by);
    p = {x, y, p.z};
    for (VertexSoup::Attribute& a : attributes) {
      if (a.kind == AttributeKind::kTextureCoordinates) a.values[2 * v] += by / 6.2831853f;
      if (a.kind == AttributeKind::kNormal) std::copy_n(std::array<float, 3>{x, y, 0}.begin(), 3, &a.values[3 * v]);
    }
  }
  return skinned;
}

TEST(Skin, BentCylinderIsSimplifiedAndHoldsItsErrorInPoses) {
  const Bytes asset = SkinnedCylinderAsset(Uneven(shapes::SkinnedCylinder(48, 128)), 60.0);
  const PackResult all = Pack(asset, false), simplified = Pack(asset);
  const uint64_t bytes_of_all = all.report.primitives[0].bytes_after,
                 bytes = simplified.report.primitives[0].bytes_after;
  EXPECT_GT(10 * bytes_of_all, 15 * bytes) << bytes_of_all << " / " << bytes;
  EXPECT_LT(bytes_of_all, 3 * bytes) << bytes_of_all << " / " << bytes;
  EXPECT_GT(WorstPsnr(asset, Unpacked(all)), 69.9);
  EXPECT_GT(WorstPsnr(asset, Unpacked(simplified)), 69.9);
  EXPECT_LT(WorstPsnr(asset, Unpacked(simplified)), 73.0);
  EXPECT_NE(simplified.report.primitives[0].reason.find("simplified from 12288"), std::string::npos);
}

TEST(Skin, WithoutAnimationItIsLookedAtInTurnedPoses) {
  const shapes::SkinnedSoup cylinder = shapes::SkinnedCylinder(48, 104);
  const Bytes still = SkinnedCylinderAsset(cylinder, 0.0), bent = SkinnedCylinderAsset(cylinder, 30.0);
  const Bytes unpacked = Unpacked(Pack(still));
  // The same nodes and skin with an animation that was not in the file.
  GltfDocument document = ParseGltf(unpacked, "").value();
  const GltfDocument animated = ParseGltf(bent, "").value();
  Json animations = animated.json["animations"];
  for (Json& sampler : animations[0]["samplers"]) {
    for (const char* key : {"input", "output"}) {
      const AccessorData data = ReadAccessor(animated, sampler[key].get<uint64_t>()).value();
      sampler[key] = AddAccessor(MakeAccessor(data, AccessorUse::kAttribute, false, &document), &document);
    }
  }
  document.json["animations"] = animations;
  ASSERT_TRUE(MergeBuffers(&document).ok());
  EXPECT_GT(WorstPsnr(bent, FormatGlb(document)), 69.5);
  const Primitive primitive = ReadPrimitive(document, PrimitiveAt(document, {0, 0}), {}).value();
  EXPECT_LT(primitive.triangles.size(), 9984u / 4);
  EXPECT_GT(primitive.triangles.size(), 9984u / 16);
}

TEST(Skin, WeightsAddUpToOne) {
  const Bytes unpacked = Unpacked(PackedBentCylinder());
  const GltfDocument document = ParseGltf(unpacked, "").value();
  const Primitive primitive = ReadPrimitive(document, PrimitiveAt(document, {0, 0}), {}).value();
  EXPECT_EQ(primitive.Find("JOINTS_0")->data.type, ComponentType::kUint8);
  EXPECT_EQ(primitive.Find("JOINTS_1"), nullptr);
  const AccessorData &joints = primitive.Find("JOINTS_0")->data, &weights = primitive.Find("WEIGHTS_0")->data;
  uint64_t blended = 0;
  for (uint64_t v = 0; v < primitive.num_vertices; ++v) {
    float sum = 0.0f;
    for (uint32_t c = 0; c < 4; ++c) {
      sum += weights.Float(v, c);
      EXPECT_LT(joints.Uint(v, c), 3u);
      blended += weights.Float(v, c) > 0.0f && weights.Float(v, c) < 1.0f;
    }
    EXPECT_NEAR(sum, 1.0f, 1e-6f) << v;
  }
  EXPECT_GT(blended, 100u);
}

TEST(Skin, PrimitivesStayJoinedInPoses) {
  const Bytes asset = SkinnedCylinderAsset(Uneven(shapes::SkinnedCylinder(48, 60)), 60.0, true);
  const PackResult packed = Pack(asset);
  EXPECT_NE(packed.report.primitives[0].reason.find("simplified from 2880"), std::string::npos)
      << packed.report.primitives[0].reason;
  const Bytes unpacked = Unpacked(packed);
  const auto points = [&](const Bytes& plain, uint64_t primitive, double time) {
    std::set<std::tuple<float, float, float>> result;
    const TriangleMesh mesh = PosedAt(plain, 0, time, primitive);
    for (const Triangle& t : mesh.triangles) {
      for (const uint32_t v : t) result.insert({mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z});
    }
    return result;
  };
  const auto num_shared = [&](const Bytes& plain, double time) {
    const auto a = points(plain, 0, time), b = points(plain, 1, time);
    return std::count_if(a.begin(), a.end(), [&](const auto& p) { return b.count(p) > 0; });
  };
  EXPECT_GT(num_shared(unpacked, 0.0), 10);
  EXPECT_EQ(num_shared(unpacked, 0.0), num_shared(unpacked, 0.7));  // bit by bit
}

// Every triangle with vertices of its own, whose weights are off by as much as a tool's arithmetic leaves.
shapes::SkinnedSoup WithNoisyWedges(const shapes::SkinnedSoup& skinned) {
  shapes::SkinnedSoup result{shapes::Unwelded(skinned.soup, 0.0f), {}, {}};
  uint32_t state = 1;
  for (const Triangle& t : skinned.soup.triangles) {
    for (const size_t v : t) {
      for (size_t c = 0; c < 4; ++c) {
        state = state * 1664525 + 1013904223;
        result.joints.push_back(skinned.joints[4 * v + c]);
        result.weights.push_back(skinned.weights[4 * v + c] * (1.0f + 1e-9f * static_cast<float>(state >> 22)));
      }
    }
  }
  return result;
}

TEST(Skin, NoiseBetweenWedgesIsNoSeam) {
  uint64_t bytes = 0, wanted = 0;  // of more than one bend: what share of the error goes to weights is a matter of chance
  for (const double bend : {30.0, 45.0, 60.0}) {
    const Bytes noisy = SkinnedCylinderAsset(WithNoisyWedges(shapes::SkinnedCylinder(48, 52)), bend);
    const PackResult packed = Pack(noisy);
    bytes += packed.report.primitives[0].bytes_after;
    wanted += Pack(SkinnedCylinderAsset(shapes::SkinnedCylinder(48, 52), bend)).report.primitives[0].bytes_after;
    EXPECT_GT(WorstPsnr(noisy, Unpacked(packed)), 69.9);
  }
  EXPECT_LT(100 * bytes, 110 * wanted) << bytes << " / " << wanted;
  EXPECT_GT(100 * bytes, 90 * wanted) << bytes << " / " << wanted;
}

// Adds a second arm: the same mesh by a skin of its own, whose joints the animation turns about another axis.
Bytes WithSecondArm(const Bytes& asset) {
  GltfDocument document = ParseGltf(asset, "").value();
  Json& json = document.json;
  const size_t first = json["nodes"].size();
  for (const size_t node : {size_t{1}, size_t{2}, size_t{3}}) {
    Json copy = json["nodes"][node];
    if (copy.contains("children")) copy["children"] = {first + node};
    json["nodes"].push_back(copy);
  }
  json["nodes"].push_back({{"mesh", 0}, {"skin", 1}});
  json["scenes"][0]["nodes"].push_back(first);
  json["scenes"][0]["nodes"].push_back(first + 3);
  Json skin = json["skins"][0];
  skin["joints"] = {first, first + 1, first + 2};
  json["skins"].push_back(skin);
  const std::vector<float> turns{0, 0, 0, 1, 0, 0.5f, 0, std::sqrt(0.75f)};
  Json& animation = json["animations"][0];
  Json sampler = animation["samplers"][0];
  sampler["output"] = AddAccessor(MakeAccessor(MakeFloatAccessor(turns, 4), AccessorUse::kAttribute, false, &document), &document);
  animation["samplers"].push_back(sampler);
  for (const size_t node : {first + 1, first + 2}) {
    animation["channels"].push_back({{"sampler", 1}, {"target", {{"node", node}, {"path", "rotation"}}}});
  }
  EXPECT_TRUE(MergeBuffers(&document).ok());
  return FormatGlb(document);
}

// Node 0 by this skin, as PosedAt shows it.
Bytes BySkin(const Bytes& asset, uint64_t skin) {
  GltfDocument document = ParseGltf(asset, "").value();
  document.json["nodes"][0]["skin"] = skin;
  return FormatGlb(document);
}

TEST(Skin, ByTwoSkinsItHoldsItsErrorInPosesOfBoth) {
  const Bytes asset = WithSecondArm(BentCylinder());
  const PackResult packed = Pack(asset);
  const Bytes unpacked = Unpacked(packed);
  for (const uint64_t skin : {uint64_t{0}, uint64_t{1}}) EXPECT_GT(WorstPsnr(BySkin(asset, skin), BySkin(unpacked, skin)), 69.9) << skin;
  const uint64_t bytes = packed.report.primitives[0].bytes_after, by_one = PackedBentCylinder().report.primitives[0].bytes_after;
  EXPECT_LT(100 * bytes, 120 * by_one) << bytes << " / " << by_one << " " << packed.report.primitives[0].reason;
}

TEST(Skin, SkinsOfEqualJointsAreOne) {
  GltfDocument document = ParseGltf(BentCylinder(), "").value();
  document.json["skins"].push_back(document.json["skins"][0]);
  document.json["nodes"].push_back({{"mesh", 0}, {"skin", 1}});
  const PackResult packed = Pack(FormatGlb(document));
  EXPECT_EQ(packed.report.primitives[0].bytes_after, PackedBentCylinder().report.primitives[0].bytes_after);
}

TEST(Skin, WhatOtherSkinsMoveIsNotSimplifiedTogether) {
  GltfDocument document = ParseGltf(WithSecondArm(BentCylinder()), "").value();
  document.json["meshes"].push_back(document.json["meshes"][0]);
  document.json["nodes"][7]["mesh"] = 1;
  EXPECT_NE(Pack(FormatGlb(document)).report.primitives[0].reason.find("what another skin moves"), std::string::npos);
}

TEST(Skin, WhatCannotBePosedIsNotSimplified) {
  const Bytes asset = SkinnedCylinderAsset(shapes::SkinnedCylinder(24, 52), 60.0);
  GltfDocument document = ParseGltf(asset, "").value();
  document.json["nodes"][0].erase("skin");
  const auto pack = [](const GltfDocument& changed) {
    return PackGltf(FormatGlb(changed), {}).value().report.primitives[0];
  };
  EXPECT_NE(pack(document).reason.find("node 0 shows it without a skin"), std::string::npos);
  document = ParseGltf(asset, "").value();
  document.json["skins"][0]["joints"] = {1, 2};
  EXPECT_NE(pack(document).reason.find("joint 2, which its skin has not got"), std::string::npos);
  EXPECT_EQ(pack(document).storage, PrimitiveStorage::kDraco);
  document.json["skins"][0]["joints"] = std::vector<int>(70'000, 1);  // a few bytes each that would take a matrix in every pose
  EXPECT_NE(pack(document).reason.find("more joints than an index can name"), std::string::npos);
}

class AnimatedAsset : public ::testing::TestWithParam<const char*> {};

TEST_P(AnimatedAsset, HoldsItsErrorInPoses) {
  const std::string path = std::string(LACERTA_TEST_DATA_DIR) + "/" + GetParam() + ".glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const Bytes asset = ReadFile(path).value();
  const double worst = WorstPsnr(asset, Unpacked(Pack(asset)));
  EXPECT_GT(worst, 69.9);
  EXPECT_LT(worst, 72.0);
}

INSTANTIATE_TEST_SUITE_P(DataSet, AnimatedAsset, ::testing::Values("CesiumMan", "Fox"));

}  // namespace
}  // namespace lacerta
