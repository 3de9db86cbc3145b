#include "pack/rounded.h"

#include <gtest/gtest.h>

#include <cmath>

#include "decoder/smooth_normals.h"
#include "gltf/test_assets.h"
#include "lacerta/surface_distance.h"

namespace lacerta {
namespace {

// A ball with a texture that goes `repeats` times around it.
Primitive Textured(float repeats) {
  const TriangleMesh mesh = testing::WavySphere(48, 72);
  Primitive primitive;
  primitive.num_vertices = mesh.positions.size();
  primitive.triangles = mesh.triangles;
  std::vector<float> texture;
  for (const Vec3f& p : mesh.positions) texture.insert(texture.end(), {repeats * p.x, repeats * p.y});
  primitive.attributes = {{"POSITION", MakeFloatAccessor(mesh.positions)},
                          {"NORMAL", MakeFloatAccessor(SmoothNormals(mesh.positions, mesh.triangles))},
                          {"TEXCOORD_0", MakeFloatAccessor(texture, 2)}};
  return primitive;
}

double Texels(uint64_t) { return 1024.0; }

// What a viewer sees of the decoded primitive, by a meter of our own.
SurfaceErrors Seen(const Primitive& original, const Primitive& decoded, const TexelScale& scale) {
  const AttributedMesh before = ToAttributedMesh({&original}, scale).value();
  const AttributedMesh after = ToAttributedMesh({&decoded}, scale).value();
  return SurfaceErrorMeter::Create(before, 1024.0).value().Measure(after, 50'000).value();
}

TEST(Rounded, PositionsThatSlideUnderTheTextureGetMoreBits) {
  const TexelScale scale = [](size_t, uint64_t set) { return Texels(set); };
  const double diagonal = BoundingBoxDiagonal(Surface(Textured(1.0f)));
  const double error = DistanceOfPsnr(50.0, diagonal);
  int bits_before = 0;
  for (const float repeats : {0.05f, 4.0f}) {
    const Primitive primitive = Textured(repeats);
    const FamilyMeter meter({&primitive}, error, {}, 1024, scale);
    const auto rounded = RoundFamily(meter.primitives(), meter);
    ASSERT_TRUE(rounded.ok()) << rounded.status().message();
    const RoundedFamily& family = rounded.value();
    ASSERT_EQ(family.members.size(), 1u);
    const SurfaceErrors seen = Seen(primitive, family.members[0].decoded, scale);
    EXPECT_LE(seen.distance, 1.02 * error);
    EXPECT_LE(seen.attributes[0].rms_99, 1.02 * AttributeTargets().normal_degrees);
    EXPECT_LE(seen.attributes[1].rms_99, 1.02 * AttributeTargets().uv_texels);
    EXPECT_LE(seen.turned, 6e-4);
    EXPECT_GE(family.reports[0][1].error, 0.9 * seen.attributes[1].rms_99);  // the report owns up to it
    const int bits = family.precisions[0].positions.bits;
    if (bits_before == 0) {
      EXPECT_GE(family.reports[0][0].error, 0.5 * AttributeTargets().normal_degrees);  // a bit fewer would be too much
    } else {
      EXPECT_GT(bits, bits_before + 1);  // the distance alone would be happy with fewer
      EXPECT_GT(seen.attributes[1].rms, 0.1 * AttributeTargets().uv_texels);  // not just any bits
    }
    bits_before = bits;
  }
}

TEST(Rounded, SurfacesWithoutAreaAreHeldToTheirVertices) {
  Primitive primitive = Textured(1.0f);
  primitive.triangles = {{0, 0, 1}};
  const FamilyMeter meter({&primitive}, 0.01, {}, 1024, [](size_t, uint64_t set) { return Texels(set); });
  EXPECT_FALSE(meter.status().ok());
  const auto rounded = RoundFamily(meter.primitives(), meter);
  // Draco drops what has no area, so there may be nothing to encode; never a crash or a search without end.
  if (rounded.ok()) {
    EXPECT_TRUE(rounded.value().everywhere.empty());
  }
}

}  // namespace
}  // namespace lacerta
