#include "pack/family_meter.h"

#include <gtest/gtest.h>

#include <ctime>
#include <random>
#include <vector>

namespace lacerta {
namespace {

// Triangles from one point outward, every two of them through each other near it.
Primitive BowTies(uint32_t num_triangles) {
  std::mt19937 random(num_triangles);
  const auto coordinate = [&] { return static_cast<float>(random() % 20001) / 10000 - 1; };
  std::vector<Vec3f> positions = {{0, 0, 0}};
  Primitive primitive;
  for (uint32_t i = 0; i < num_triangles; ++i) {
    const Vec3f out = {coordinate(), coordinate(), coordinate()};
    positions.insert(positions.end(), {out, out + Vec3f{0.01f * coordinate(), 0.01f * coordinate(), 0.01f * coordinate()}});
    primitive.triangles.push_back({0, 2 * i + 1, 2 * i + 2});
  }
  primitive.num_vertices = positions.size();
  primitive.attributes = {{"POSITION", MakeFloatAccessor(positions)}};
  return primitive;
}

// Every query looks at a share of all triangles, so that fewer are made.
TEST(FamilyMeter, MeasuresACrowdInTheTimeOfASurface) {
  const Primitive primitive = BowTies(20'000);
  const FamilyMeter meter({&primitive}, 1e-3, {}, 1024, [](size_t, uint64_t) { return 1024.0; });
  ASSERT_TRUE(meter.status().ok()) << meter.status().message();
  Primitive moved = primitive;
  const Vec3f shift = {0.002f, 0, 0};
  std::vector<Vec3f> positions;
  for (uint32_t v = 0; v < moved.num_vertices; ++v) {
    positions.push_back(Vec3f{moved.attributes[0].data.Float(v, 0), moved.attributes[0].data.Float(v, 1), moved.attributes[0].data.Float(v, 2)} + shift);
  }
  moved.attributes[0].data = MakeFloatAccessor(positions);
  const std::clock_t begin = std::clock();
  const StatusOr<SurfaceErrors> errors = meter.Measure({&moved});
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  ASSERT_TRUE(errors.ok()) << errors.status().message();
  EXPECT_LE(errors.value().distance, 0.002);
  EXPECT_GE(errors.value().distance, 0.0004);
  EXPECT_LT(seconds, 3.0);
}

}  // namespace
}  // namespace lacerta
