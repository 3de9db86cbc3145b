#include "pack/vertex_match.h"

#include <gtest/gtest.h>

#include "gltf/test_assets.h"

namespace lacerta {
namespace {

Primitive Plain(const TriangleMesh& mesh) {
  return {mesh.positions.size(), mesh.triangles, {{"POSITION", MakeFloatAccessor(mesh.positions)}}};
}

TEST(VertexMatch, FindsTheOrderOfDraco) {
  const Primitive primitive = Plain(testing::WavySphere(8, 12));
  const DracoPrecision precision = {PositionLattice({-2, -2, -2}, {2, 2, 2}, 12), {}, 0};
  const Primitive decoded = EncodeDracoPrimitive(primitive, precision).value().decoded;
  const auto order = MatchVertices(RoundAttributes(primitive, precision), decoded, precision, {});
  ASSERT_TRUE(order.has_value());
  ASSERT_EQ(order->size(), decoded.num_vertices);
  const AccessorData moved = Reorder(primitive.attributes[0].data, *order);
  bool reordered = false;
  for (uint64_t v = 0; v < decoded.num_vertices; ++v) {
    reordered = reordered || (*order)[v] != v;
    for (uint32_t c = 0; c < 3; ++c) EXPECT_NEAR(moved.Float(v, c), decoded.attributes[0].data.Float(v, c), 5e-4);
  }
  EXPECT_TRUE(reordered);
}

TEST(VertexMatch, RefusesTwinsThatDifferElsewhere) {
  TriangleMesh mesh = testing::WavySphere(4, 6);
  mesh.positions.push_back(mesh.positions[0]);  // a twin, used by one triangle
  const auto twin = static_cast<uint32_t>(mesh.positions.size() - 1);
  for (uint32_t& index : mesh.triangles[0]) index = index == 0 ? twin : index;
  const Primitive primitive = Plain(mesh);
  const DracoPrecision precision = {PositionLattice({-2, -2, -2}, {2, 2, 2}, 12), {}, 0};
  const Primitive decoded = EncodeDracoPrimitive(primitive, precision).value().decoded;
  const Primitive rounded = RoundAttributes(primitive, precision);
  std::vector<Vec3f> offsets(mesh.positions.size());
  EXPECT_TRUE(MatchVertices(rounded, decoded, precision, {MakeFloatAccessor(offsets)}).has_value());
  offsets[twin] = {1, 0, 0};
  EXPECT_FALSE(MatchVertices(rounded, decoded, precision, {MakeFloatAccessor(offsets)}).has_value());
}

}  // namespace
}  // namespace lacerta
