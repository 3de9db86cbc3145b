// Surfaces with morph targets as progressive streams: smaller than simplified ones, within the error with each target,
// with targets at every level.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gltf/halved_stream.h"
#include "gltf/morphed_asset.h"
#include "gltf/skinned_asset.h"
#include "lacerta/surface_distance.h"

namespace lacerta {
namespace {

using testing::BytesOfHalves;
using testing::MorphedSurface;
using testing::PackFast;

constexpr int kTargets = 4;

const Bytes& Ball() {
  static const Bytes* const kBall = new Bytes(testing::BallWithHills({44, 72, kTargets, true, true, 0.02f}));
  return *kBall;
}

const PackResult& Packed() {
  static const PackResult* const kPacked = new PackResult(PackFast(Ball(), LevelChoice::kWhereTheyPay));
  return *kPacked;
}

Bytes Unpacked(std::optional<int> level = std::nullopt) { return testing::UnpackedAt(Packed().glb, level); }

TriangleMesh BothHalves(const Bytes& plain, std::optional<uint64_t> target) {
  return testing::Both(MorphedSurface(plain, 0, target), MorphedSurface(plain, 1, target));
}

TEST(MorphStream, TakesLessThanHalfOfWhatSimplifiedDoes) {
  for (const PrimitiveReport& primitive : Packed().report.primitives)
    EXPECT_EQ(primitive.storage, PrimitiveStorage::kProgressive) << primitive.reason;
  const PackResult simplified = PackFast(Ball(), LevelChoice::kNever);
  EXPECT_LT(2 * BytesOfHalves(Packed()), BytesOfHalves(simplified)) << BytesOfHalves(Packed());
  EXPECT_GT(16 * BytesOfHalves(Packed()), BytesOfHalves(simplified)) << BytesOfHalves(Packed());
  EXPECT_LT(Packed().glb.size(), simplified.glb.size());
}

TEST(MorphStream, HoldsItsErrorWithEachTarget) {
  const Bytes unpacked = Unpacked();
  const double target_error = Packed().report.primitives[0].target_error;
  double worst = 0;
  for (std::optional<uint64_t> target; !target.has_value() || *target < kTargets;
       target = target.has_value() ? *target + 1 : 0) {
    worst =
        std::max(worst, MeasureSurfaceDistance(BothHalves(Ball(), target), BothHalves(unpacked, target)).value().Rms());
  }
  EXPECT_LT(worst, 1.02 * target_error);
  EXPECT_GT(worst, 0.6 * target_error);
}

TEST(MorphStream, HoldsItsErrorInMixesThatTheAssetShows) {
  const std::vector<float> mix(kTargets, 1.0f);
  const auto error_in_targets = [&](const std::vector<float>& shown) {
    const Bytes asset = testing::BallWithHills({44, 72, kTargets, false, true, 0.02f, true, shown});
    const PackResult packed = PackFast(asset, LevelChoice::kAlways);
    const Bytes unpacked = testing::UnpackedAt(packed.glb, std::nullopt);
    const auto both = [&](const Bytes& plain) { return testing::Both(testing::MixedSurface(plain, 0, mix), testing::MixedSurface(plain, 1, mix)); };
    return MeasureSurfaceDistance(both(asset), both(unpacked)).value().Rms() / packed.report.primitives[0].target_error;
  };
  EXPECT_LT(error_in_targets(mix), 1.02);
  EXPECT_GT(error_in_targets(mix), 0.3);
  EXPECT_GT(error_in_targets({}), 1.1);  // else they need not be looked at
}

TEST(MorphStream, NormalsOfTargetsAreHeld) {
  bool found = false;
  for (const AttributeReport& attribute : Packed().report.primitives[0].attributes) {
    if (attribute.name != "TARGETS_0_NORMAL") continue;
    found = true;
    EXPECT_LT(attribute.error, PackOptions().attributes.normal_degrees * 3.1416 / 180);
    EXPECT_GT(attribute.error, PackOptions().attributes.normal_degrees * 3.1416 / 180 / 10);
  }
  EXPECT_TRUE(found);
}

// Vertices of the halves' border are the same with every target, bit by bit.
TEST(MorphStream, NoLevelCracks) {
  const int num_levels = static_cast<int>(Packed().report.primitives[0].encode.levels.size()) - 1;
  ASSERT_GE(num_levels, 2);
  size_t before = 0;
  for (int level = 0; level <= num_levels; ++level) {
    const Bytes plain = Unpacked(level);
    const auto num_shared = [&](std::optional<uint64_t> target) {
      return testing::NumSharedPoints(MorphedSurface(plain, 0, target), MorphedSurface(plain, 1, target));
    };
    EXPECT_EQ(num_shared(std::nullopt), num_shared(1));
    EXPECT_GT(num_shared(1), before);
    before = num_shared(1);
  }
}

TEST(MorphStream, EveryLevelAndTheFallbackHaveTargets) {
  for (const Bytes& glb :
       {Packed().glb, Unpacked(0), Unpacked(1), Unpacked()}) {  // the first as readers without the extension see it
    const GltfDocument document = ParseGltf(glb, "").value();
    for (uint64_t half = 0; half < 2; ++half) {
      const Json& json = PrimitiveAt(document, {0, half});
      const Primitive primitive = ReadPrimitive(document, json, {}).value();
      ASSERT_EQ(json["targets"].size(), size_t{kTargets});
      EXPECT_EQ(primitive.Find("TARGETS_0_POSITION"), nullptr);
      float farthest = 0;
      for (const Json& target : json["targets"]) {
        for (const char* const name : {"POSITION", "NORMAL"}) {
          const AccessorData offsets = ReadAccessor(document, target[name].get<uint64_t>()).value();
          ASSERT_EQ(offsets.count, primitive.num_vertices);
          for (uint64_t v = 0; v < offsets.count && name[0] == 'P'; ++v)
            farthest = std::max(farthest, std::fabs(offsets.Float(v, 0)));
        }
      }
      EXPECT_GT(farthest, 0.01f);
      EXPECT_LT(farthest, 0.4f);
    }
  }
  EXPECT_TRUE(ValidateGltf(Packed().glb, {}).IsValid());
}

TEST(MorphStream, LoadersGetTargets) {
  const std::vector<RefinedGeometry> geometries = testing::RefinedBy(Packed().glb);
  ASSERT_EQ(geometries.size(), 2u);
  for (const RefinedGeometry& geometry : geometries) {
    EXPECT_TRUE(geometry.attributes.empty());
    ASSERT_EQ(geometry.targets.size(), size_t{kTargets});
    for (const auto& target : geometry.targets) {
      ASSERT_EQ(target.size(), 2u);
      EXPECT_EQ(target[0].name, "POSITION");
      EXPECT_EQ(target[1].name, "NORMAL");
      for (const RefinedAttribute& offsets : target)
        EXPECT_EQ(offsets.values.size(), 3 * sizeof(float) * geometry.num_vertices);
    }
  }
}

TEST(MorphStream, AnotherNumberOfTargetsIsNoticed) {
  GltfDocument document = ParseGltf(Packed().glb, "").value();
  Json& targets = document.json["meshes"][0u]["primitives"][0u]["targets"];
  targets.erase(targets.size() - 1);
  const std::vector<ProgressiveSurface> surfaces = ReadProgressive(FormatGlb(document), {}).value();
  EXPECT_TRUE(surfaces[0].from_fallback);
  EXPECT_NE(surfaces[0].note.find("4 morph targets"), std::string::npos) << surfaces[0].note;
  EXPECT_FALSE(surfaces[1].from_fallback) << surfaces[1].note;
}

TEST(MorphStream, ManyTargetsAreSeveralAttributes) {
  const PackResult packed = PackFast(testing::BallWithHills({24, 40, 45, false, false, 0}), LevelChoice::kAlways);
  ASSERT_EQ(packed.report.primitives[0].storage, PrimitiveStorage::kProgressive) << packed.report.primitives[0].reason;
  EXPECT_EQ(testing::JsonOf(packed.glb)["extensions"]["LACERTA_mesh_progressive"]["streams"][0u]["attributes"],
            Json::array({"TARGETS_0_POSITION", "TARGETS_42_POSITION"}));
  EXPECT_EQ(ReadProgressive(packed.glb, {}).value()[0].targets.size(), 45u);
}

// A bumpy arm with a target that makes it thicker, here more and there less.
Bytes MorphedArm() {
  shapes::SkinnedSoup arm = shapes::SkinnedCylinder(48, 64);
  for (Vec3f& p : arm.soup.positions) {
    const float angle = std::atan2(p.y, p.x);
    const float scale = 1 + 0.1f * std::sin(p.z) + 0.03f * std::sin(5 * angle + 2 * p.z) + 0.02f * std::sin(5 * p.z);
    p = {p.x * scale, p.y * scale, p.z};
  }
  testing::DropNormals(&arm.soup);
  GltfDocument document = ParseGltf(testing::SkinnedCylinderAsset(arm, 60.0, false), "").value();
  const std::vector<Vec3f> positions =
      Surface(ReadPrimitive(document, PrimitiveAt(document, {0, 0}), {}).value()).positions;
  std::vector<Vec3f> offsets;
  for (const Vec3f& p : positions) offsets.push_back(Vec3f{p.x, p.y, 0} * (0.2f + 0.1f * std::sin(2 * p.z)));
  const uint64_t accessor =
      AddAccessor(MakeAccessor(MakeFloatAccessor(offsets), AccessorUse::kAttribute, true, &document), &document);
  PrimitiveAt(&document, {0, 0})["targets"] = Json::array({{{"POSITION", accessor}}});
  EXPECT_TRUE(MergeBuffers(&document).ok());
  return FormatGlb(document);
}

TEST(MorphStream, SkinsMayHaveTargets) {
  const Bytes asset = MorphedArm();
  const PackResult packed = PackFast(asset, LevelChoice::kWhereTheyPay);
  const PrimitiveReport& report = packed.report.primitives[0];
  ASSERT_EQ(report.storage, PrimitiveStorage::kProgressive) << report.reason;
  EXPECT_EQ(testing::JsonOf(packed.glb)["extensions"]["LACERTA_mesh_progressive"]["streams"][0u]["joints"].size(), 3u);
  const Bytes unpacked = UnpackGltf(packed.glb, {}).value().glb;
  const auto error = [](const TriangleMesh& a, const TriangleMesh& b) {
    return MeasureSurfaceDistance(a, b).value().Rms();
  };
  const double morphed = error(MorphedSurface(asset, 0, 0), MorphedSurface(unpacked, 0, 0));
  const double posed = error(testing::PosedAt(asset, 0, 1.0, 0), testing::PosedAt(unpacked, 0, 1.0, 0));
  EXPECT_LT(morphed, 1.02 * report.target_error);
  EXPECT_LT(posed, 1.05 * report.target_error);
  EXPECT_GT(std::max(morphed, posed), 0.6 * report.target_error);
}

}  // namespace
}  // namespace lacerta
