#include "pack/rounding_forecast.h"

#include <gtest/gtest.h>

#include <cmath>

#include "decoder/smooth_normals.h"
#include "gltf/test_assets.h"
#include "lacerta/surface_distance.h"

namespace lacerta {
namespace {

Primitive Textured() {
  const TriangleMesh mesh = testing::WavySphere(24, 36);
  Primitive primitive;
  primitive.num_vertices = mesh.positions.size();
  primitive.triangles = mesh.triangles;
  std::vector<float> texture;
  for (const Vec3f& p : mesh.positions) texture.insert(texture.end(), {0.5f + 0.45f * p.x, 0.5f + 0.45f * p.y});
  primitive.attributes = {{"POSITION", MakeFloatAccessor(mesh.positions)},
                          {"NORMAL", MakeFloatAccessor(SmoothNormals(mesh.positions, mesh.triangles))},
                          {"TEXCOORD_0", MakeFloatAccessor(texture, 2)},
                          {"_MINE", MakeFloatAccessor(mesh.positions)}};
  return primitive;
}

// RMS over the surface, by many samples of a difference that is linear on every triangle.
template <typename ErrorAt>
double SampledRms(const TriangleMesh& surface, const ErrorAt& error_at) {
  constexpr int kSide = 8;
  double sum = 0.0, area_sum = 0.0;
  for (const Triangle& t : surface.triangles) {
    const Vec3d a = Vec3Cast<double>(surface.positions[t[0]]);
    const double area = Norm(Cross(Vec3Cast<double>(surface.positions[t[1]]) - a, Vec3Cast<double>(surface.positions[t[2]]) - a));
    int count = 0;
    double squares = 0.0;
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; i + j < kSide; ++j, ++count) {
        const double u = (i + 1.0 / 3) / kSide, v = (j + 1.0 / 3) / kSide;
        const double error = error_at(t, 1 - u - v, u, v);
        squares += error * error;
      }
    }
    sum += area * squares / count;
    area_sum += area;
  }
  return std::sqrt(sum / area_sum);
}

TEST(RoundingForecast, AttributesInTheUnitsOfTheirTargets) {
  const Primitive primitive = Textured();
  const std::vector<const Primitive*> primitives = {&primitive};
  const auto attributes = RoundedAttributesOf(primitives, {}, [](size_t, uint64_t) { return 1024.0; });
  ASSERT_EQ(attributes.size(), 2u);  // nobody said how exact _MINE has to be
  EXPECT_EQ(attributes[0].unit, "degrees");
  EXPECT_EQ(attributes[1].unit, "texels");
  RoundingForecast forecast(primitives, attributes);
  const AccessorData& texture = primitive.attributes[2].data;
  const int level = 7 * kLevelsPerBit + 1;
  const AccessorData rounded = attributes[1].RoundedAt(primitive.attributes[attributes[1].parts[0].index].data, attributes[1].parts[0], level);
  const double sampled = 1024.0 * SampledRms(Surface(primitive), [&](const Triangle& t, double a, double b, double c) {
    double squares = 0.0;
    for (uint32_t i = 0; i < 2; ++i) {
      const auto at = [&](size_t k) { return rounded.Float(t[k], i) - texture.Float(t[k], i); };
      squares += std::pow(a * at(0) + b * at(1) + c * at(2), 2.0);
    }
    return std::sqrt(squares);
  });
  EXPECT_LT(forecast.Rounded(1, level), sampled);  // without the worst hundredth
  EXPECT_GT(forecast.Rounded(1, level), 0.9 * sampled);
  EXPECT_EQ(forecast.Rounded(1, kMostLevel + 1), 0.0);
  // A bit more is half the error.
  EXPECT_NEAR(forecast.Rounded(1, level + kLevelsPerBit), 0.5 * forecast.Rounded(1, level), 0.1 * forecast.Rounded(1, level));
  EXPECT_GT(forecast.Rounded(0, 5 * kLevelsPerBit), 1.0);  // degrees
  EXPECT_LT(forecast.Rounded(0, 5 * kLevelsPerBit), 3.0);
}

TEST(RoundingForecast, PositionsAndWhatSlidesOnThem) {
  const Primitive primitive = Textured();
  const std::vector<const Primitive*> primitives = {&primitive};
  const auto attributes = RoundedAttributesOf(primitives, {}, [](size_t, uint64_t) { return 1024.0; });
  RoundingForecast forecast(primitives, attributes);
  const TriangleMesh surface = Surface(primitive);
  const double diagonal = BoundingBoxDiagonal(surface);
  for (const double psnr : {55.0, 70.0}) {
    const double error = DistanceOfPsnr(psnr, diagonal);
    const RoundedPositions& positions = forecast.Positions(forecast.StartLevel(error));
    EXPECT_LE(positions.distance, 1.5 * error);
    EXPECT_GE(positions.distance, error / 1.5);
    TriangleMesh moved = surface;
    moved.positions = positions.moved[0];
    for (const Vec3f& position : moved.positions) {
      for (int c = 0; c < 3; ++c) {
        const auto component = static_cast<uint32_t>(c);
        EXPECT_EQ(position[c], positions.lattice.At(positions.lattice.Round(position[c], component), component));
      }
    }
    const double measured = MeasureSurfaceDistance(surface, moved).value().Rms();
    EXPECT_LE(positions.distance, 1.3 * measured);
    EXPECT_GE(positions.distance, 0.9 * measured);
    // The texture goes with x and y: 0.45 of what the surface slides within itself. But for its bends other values make up for that.
    EXPECT_GT(positions.slides[1], 0.01 * 1024.0 * positions.distance);
    EXPECT_LT(positions.slides[1], 0.1 * 1024.0 * positions.distance);
    const std::vector<AccessorData> fitted = forecast.Fitted(1, forecast.StartLevel(error));
    ASSERT_EQ(fitted.size(), 1u);
    for (uint64_t v = 0; v < primitive.num_vertices; v += 50) EXPECT_NEAR(fitted[0].Float(v, 0), 0.5f + 0.45f * moved.positions[v].x, 3.0 * positions.distance);
  }
  EXPECT_EQ(forecast.StartLevel(0.0), kMostLevel);
}

// With two joints, of which the second takes over along x and goes up by `shift` in one of two poses.
struct Skinned {
  Primitive primitive = Textured();
  Skin skin;

  explicit Skinned(double shift) {
    std::vector<float> weights;
    AccessorData joints;
    joints.type = ComponentType::kUint8;
    joints.components = 4;
    joints.count = primitive.num_vertices;
    for (const Vec3f& p : Surface(primitive).positions) {
      const float second = 0.5f + 0.45f * p.x;
      weights.insert(weights.end(), {1 - second, second, 0, 0});
      joints.bytes.insert(joints.bytes.end(), {0, 1, 0, 0});
    }
    primitive.attributes.push_back({"JOINTS_0", joints});
    primitive.attributes.push_back({"WEIGHTS_0", MakeFloatAccessor(weights, 4)});
    skin.num_joints = 2;
    skin.poses.assign(2, std::vector<Transform>(2, kIdentity));
    skin.poses[1][1][11] = shift;
  }
};

TEST(RoundingForecast, WeightsByWhatPosesShow) {
  constexpr int kLevel = 4 * kLevelsPerBit;
  std::vector<double> per_shift;
  for (const double shift : {0.5, 1.0}) {
    const Skinned skinned(shift);
    const std::vector<const Primitive*> primitives = {&skinned.primitive};
    const auto attributes = RoundedAttributesOf(primitives, {}, [](size_t, uint64_t) { return 1024.0; });
    ASSERT_EQ(attributes.back().name, "WEIGHTS_0");
    const size_t weights = attributes.size() - 1;
    RoundingForecast forecast(primitives, attributes, &skinned.skin);
    Primitive rounded = skinned.primitive;
    rounded.attributes.back().data = attributes[weights].RoundedAt(rounded.attributes.back().data, attributes[weights].parts[0], kLevel);
    const TriangleMesh exact = PosedSurface(primitives, skinned.skin, 1).value(), moved = PosedSurface({&rounded}, skinned.skin, 1).value();
    const double measured = MeasureSurfaceDistance(exact, moved).value().Rms();
    EXPECT_LE(forecast.Posed(weights, kLevel), 1.3 * measured);
    EXPECT_GE(forecast.Posed(weights, kLevel), 0.9 * measured);
    per_shift.push_back(forecast.Posed(weights, kLevel) / shift);
    EXPECT_NEAR(forecast.Posed(weights, kLevel + kLevelsPerBit) / shift, 0.5 * per_shift.back(), 0.15 * per_shift.back());
    EXPECT_EQ(forecast.Posed(weights, kMostLevel + 1), 0.0);
  }
  EXPECT_NEAR(per_shift[0], per_shift[1], 0.05 * per_shift[0]);
  const Skinned still(0.0);
  const std::vector<const Primitive*> primitives = {&still.primitive};
  const auto attributes = RoundedAttributesOf(primitives, {}, [](size_t, uint64_t) { return 1024.0; });
  EXPECT_LT(RoundingForecast(primitives, attributes, &still.skin).Posed(attributes.size() - 1, kLevel), 1e-6);  // joints that nothing moves apart
}

TEST(RoundingForecast, SurfacesWithoutArea) {
  Primitive primitive = Textured();
  primitive.triangles = {{0, 0, 1}};
  const std::vector<const Primitive*> primitives = {&primitive};
  const auto attributes = RoundedAttributesOf(primitives, {}, [](size_t, uint64_t) { return 1024.0; });
  RoundingForecast forecast(primitives, attributes);
  EXPECT_GT(forecast.Positions(8).distance, 0.0);  // of the corners
  EXPECT_EQ(forecast.Positions(8).slides[1], 0.0);
  EXPECT_GT(forecast.Positions(8).lattice.range, 0.0f);
}

}  // namespace
}  // namespace lacerta
