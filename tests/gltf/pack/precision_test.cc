#include "pack/precision.h"

#include <gtest/gtest.h>

#include <cmath>

#include "document/normals.h"
#include "gltf/test_assets.h"
#include "lacerta/surface_distance.h"
#include "pack/attribute_error.h"

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
                          {"NORMAL", MakeFloatAccessor(DeriveNormals(mesh))},
                          {"TEXCOORD_0", MakeFloatAccessor(texture, 2)},
                          {"_MINE", MakeFloatAccessor(mesh.positions)}};
  return primitive;
}

TEST(Precision, FewestBitsThatMeetTheTargets) {
  const Primitive primitive = Textured();
  const TriangleMesh surface = Surface(primitive);
  const auto texels = [](uint64_t) { return 1024.0; };
  for (const double share : {1.0, 0.25, 0.01}) {
    AttributeTargets targets;
    targets.uv_texels = 0.5 * share;
    targets.normal_degrees = 2.0 * share;
    const AttributePrecision found = FindAttributeBits(primitive, targets, texels);
    ASSERT_EQ(found.reports.size(), 3u);
    EXPECT_EQ(found.bits.count("_MINE"), 0u);  // nobody said how exact it has to be
    EXPECT_LE(found.reports[0].error, targets.normal_degrees);
    EXPECT_LE(found.reports[1].error, targets.uv_texels);
    const AccessorData& normal = primitive.Find("NORMAL")->data;
    const int normal_bits = found.bits.at("NORMAL");
    EXPECT_GT(DirectionRms(surface, normal, RoundOctahedral(normal, normal_bits - 1)), targets.normal_degrees);
    const AccessorData& texture = primitive.Find("TEXCOORD_0")->data;
    const int bits = found.bits.at("TEXCOORD_0");
    const auto error = [&](int b) { return 1024 * SurfaceRms(surface, texture, RoundToLattice(texture, FitLattice(texture, b))); };
    EXPECT_GT(error(bits - 1), targets.uv_texels);
    EXPECT_NEAR(error(bits), found.reports[1].error, 1e-9);
  }
}

TEST(Precision, PositionsAreMeasuredOnTheSurface) {
  const TriangleMesh surface = testing::WavySphere(24, 36);
  const double diagonal = BoundingBoxDiagonal(surface);
  for (const double psnr : {50.0, 70.0, 90.0}) {
    const double error = DistanceOfPsnr(psnr, diagonal);
    const SharedLattice found = FindPositionLattice(surface, error);
    EXPECT_LE(found.error, error);
    EXPECT_LE(found.flipped, 5e-4);
    const SharedLattice twice = FindPositionLattice(surface, found.error * 0.99);
    EXPECT_GT(twice.lattice.bits, found.lattice.bits);
    EXPECT_GT(found.error, error / 6);  // one bit fewer would not do, and a bit is a factor of two or so
  }
  EXPECT_EQ(FindPositionLattice(surface, 0.0).lattice.bits, kMostLatticeBits);
  EXPECT_GT(FindPositionLattice({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}}, 0.1).lattice.range, 0.0f);
}

}  // namespace
}  // namespace lacerta
