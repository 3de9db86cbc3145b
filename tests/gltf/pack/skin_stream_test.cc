// Skinned surfaces as progressive streams: smaller than simplified ones, within the error in poses, legal at every
// level.
#include <gtest/gtest.h>

#include <cmath>

#include "gltf/halved_stream.h"
#include "gltf/skinned_asset.h"
#include "lacerta/surface_distance.h"

namespace lacerta {
namespace {

using testing::BytesOfHalves;
using testing::PackFast;
using testing::PosedAt;

// Bumps along the arm, no two alike, and no normals.
Bytes BumpyArm(bool halved) {
  shapes::SkinnedSoup arm = shapes::SkinnedCylinder(96, 112);
  for (Vec3f& p : arm.soup.positions) {
    const float angle = std::atan2(p.y, p.x);
    const float scale =
        1 + 0.1f * std::sin(p.z) + 0.03f * std::sin(5 * angle + 2 * p.z) + 0.02f * std::sin(9 * angle - 7 * p.z);
    p = {p.x * scale, p.y * scale, p.z};
  }
  testing::DropNormals(&arm.soup);
  return testing::SkinnedCylinderAsset(arm, 60.0, halved);
}

const Bytes& Arm() {
  static const Bytes* const kArm = new Bytes(BumpyArm(true));
  return *kArm;
}

const PackResult& Packed() {
  static const PackResult* const kPacked = new PackResult(PackFast(Arm(), LevelChoice::kWhereTheyPay));
  return *kPacked;
}

Bytes Unpacked(std::optional<int> level = std::nullopt) { return testing::UnpackedAt(Packed().glb, level); }

TriangleMesh BothHalves(const Bytes& plain, size_t animation, double time) {
  return testing::Both(PosedAt(plain, animation, time, 0), PosedAt(plain, animation, time, 1));
}

TEST(SkinStream, TakesFarLessThanSimplified) {
  for (const PrimitiveReport& primitive : Packed().report.primitives)
    EXPECT_EQ(primitive.storage, PrimitiveStorage::kProgressive) << primitive.reason;
  const uint64_t bytes = BytesOfHalves(Packed()), simplified = BytesOfHalves(PackFast(Arm(), LevelChoice::kNever));
  EXPECT_LT(5 * bytes, 3 * simplified) << bytes << " / " << simplified;
  EXPECT_LT(bytes, 3400u);
  EXPECT_GT(8 * bytes, simplified) << bytes << " / " << simplified;
}

TEST(SkinStream, HoldsItsErrorInPoses) {
  const Bytes unpacked = Unpacked();
  double worst = 1000;
  for (const double time : {0.0, 0.29, 0.5, 0.83, 1.0}) {
    const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(BothHalves(Arm(), 0, time)).value();
    worst = std::min(worst, Psnr(meter.Measure(BothHalves(unpacked, 0, time)).value().Rms(), meter.diagonal()));
  }
  EXPECT_GT(worst, 69.9);
  EXPECT_LT(worst, 72.0);
}

// Vertices of the halves' border are the same in every pose, bit by bit.
TEST(SkinStream, NoLevelCracksInPoses) {
  const int num_levels = static_cast<int>(Packed().report.primitives[0].encode.levels.size()) - 1;
  ASSERT_GE(num_levels, 2);
  size_t before = 0;
  for (int level = 0; level <= num_levels; ++level) {
    const Bytes plain = Unpacked(level);
    const auto num_shared = [&](double time) {
      return testing::NumSharedPoints(PosedAt(plain, 0, time, 0), PosedAt(plain, 0, time, 1));
    };
    EXPECT_EQ(num_shared(0.0), num_shared(0.7));
    EXPECT_GT(num_shared(0.7), before);
    before = num_shared(0.7);
  }
}

void ExpectLegalWeights(const Primitive& primitive) {
  const Attribute *joints = primitive.Find("JOINTS_0"), *weights = primitive.Find("WEIGHTS_0");
  ASSERT_TRUE(joints != nullptr && weights != nullptr);
  EXPECT_EQ(joints->data.type, ComponentType::kUint8);
  for (uint64_t v = 0; v < primitive.num_vertices; ++v) {
    float sum = 0.0f;
    for (uint32_t c = 0; c < 4; ++c) {
      sum += weights->data.Float(v, c);
      EXPECT_GE(weights->data.Float(v, c), 0.0f);
      EXPECT_LT(joints->data.Uint(v, c), weights->data.Float(v, c) > 0.0f ? 3u : 1u);
    }
    EXPECT_NEAR(sum, 1.0f, 1e-6f) << v;
  }
}

TEST(SkinStream, EveryLevelAndTheFallbackAreLegal) {
  for (const Bytes& glb :
       {Packed().glb, Unpacked(0), Unpacked(1), Unpacked()}) {  // the first as readers without the extension see it
    const GltfDocument document = ParseGltf(glb, "").value();
    for (uint64_t half = 0; half < 2; ++half) {
      ExpectLegalWeights(ReadPrimitive(document, PrimitiveAt(document, {0, half}), {}).value());
    }
  }
  EXPECT_TRUE(ValidateGltf(Packed().glb, {}).IsValid());
}

TEST(SkinStream, LoadersGetJointsAsIntegers) {
  const std::vector<RefinedGeometry> geometries = testing::RefinedBy(Packed().glb);
  ASSERT_EQ(geometries.size(), 2u);
  for (const RefinedAttribute& attribute : geometries[0].attributes) {
    EXPECT_EQ(attribute.component_type, attribute.name == "JOINTS_0" ? 5121u : 5126u) << attribute.name;
    EXPECT_EQ(attribute.values.size(),
              attribute.components * geometries[0].num_vertices * (attribute.name == "JOINTS_0" ? 1 : sizeof(float)));
  }
}

TEST(SkinStream, AnotherTableOfJointsIsNoticed) {
  const auto note_with = [&](const Json& joints) {
    GltfDocument document = ParseGltf(Packed().glb, "").value();
    Json& stream = document.json["extensions"]["LACERTA_mesh_progressive"]["streams"][0u];
    EXPECT_EQ(stream["joints"], Json::array({0, 1, 2}));
    if (joints.is_null())
      stream.erase("joints");
    else
      stream["joints"] = joints;
    const std::vector<ProgressiveSurface> surfaces = ReadProgressive(FormatGlb(document), {}).value();
    EXPECT_TRUE(surfaces[0].from_fallback);
    EXPECT_FALSE(surfaces[0].surface.triangles.empty());
    return surfaces[0].note;
  };
  EXPECT_NE(note_with({0, 1, 3}).find("joint 2"), std::string::npos);
  EXPECT_NE(note_with({0, 1, 1}).find("joints"), std::string::npos);
  EXPECT_NE(note_with({0, 1, 70'000}).find("joints"), std::string::npos);
  EXPECT_NE(note_with(Json::array()).find("joints"), std::string::npos);
  EXPECT_FALSE(note_with({0, 1, 2, 3}).empty());
  EXPECT_FALSE(note_with(nullptr).empty());
}

}  // namespace
}  // namespace lacerta
