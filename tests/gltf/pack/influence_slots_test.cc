#include "pack/influence_slots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "document/draco_encode.h"
#include "pack/skin.h"
#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

// The skinned cylinder with the largest weight first at every vertex, as exporters write it.
Primitive SortedByWeight() {
  const shapes::SkinnedSoup cylinder = shapes::SkinnedCylinder(24, 60);
  Primitive primitive{cylinder.soup.positions.size(), cylinder.soup.triangles, {}};
  AccessorData joints;
  joints.type = ComponentType::kUint8;
  joints.components = 4;
  joints.count = primitive.num_vertices;
  std::vector<float> weights;
  for (uint64_t v = 0; v < primitive.num_vertices; ++v) {
    std::vector<std::pair<float, uint8_t>> own;
    for (size_t c = 0; c < 4; ++c) own.emplace_back(-cylinder.weights[4 * v + c], cylinder.joints[4 * v + c]);
    std::sort(own.begin(), own.end());
    for (const auto& [weight, joint] : own) joints.bytes.push_back(joint), weights.push_back(-weight);
  }
  primitive.attributes = {{"POSITION", MakeFloatAccessor(cylinder.soup.positions)},
                          {"JOINTS_0", joints},
                          {"WEIGHTS_0", MakeFloatAccessor(weights, 4)}};
  return primitive;
}

size_t SizeOf(const Primitive& primitive) {
  DracoPrecision precision;
  precision.positions = FitLattice(primitive.attributes[0].data, 11);
  precision.lattices["WEIGHTS_0"] = {{}, 1.0f, 8};
  return EncodeDracoPrimitive(primitive, precision).value().bytes.size();
}

TEST(InfluenceSlots, SaveBytesAndChangeNothing) {
  const Primitive before = SortedByWeight();
  Primitive after = before;
  ArrangeInfluences({&after});
  EXPECT_LT(SizeOf(after), SizeOf(before));
  EXPECT_GT(SizeOf(after) * 4, SizeOf(before) * 3);
  const VertexInfluences old_ones = ReadInfluences(before, 3).value(), new_ones = ReadInfluences(after, 3).value();
  EXPECT_EQ(old_ones.first, new_ones.first);
  for (size_t i = 0; i < old_ones.all.size(); ++i) {
    EXPECT_EQ(old_ones.all[i].joint, new_ones.all[i].joint);
    EXPECT_EQ(old_ones.all[i].weight, new_ones.all[i].weight);
  }
}

TEST(InfluenceSlots, EqualVerticesStayEqualInAllPrimitives) {
  Primitive sorted = SortedByWeight(), upper = sorted;
  upper.triangles.assign(sorted.triangles.begin() + static_cast<std::ptrdiff_t>(sorted.triangles.size() / 2),
                         sorted.triangles.end());
  ArrangeInfluences({&sorted, &upper});
  EXPECT_EQ(sorted.attributes[1].data.bytes, upper.attributes[1].data.bytes);
  EXPECT_EQ(sorted.attributes[2].data.bytes, upper.attributes[2].data.bytes);
}

TEST(InfluenceSlots, SeveralSetsStay) {
  Primitive primitive = SortedByWeight();
  primitive.attributes.push_back({"JOINTS_1", primitive.attributes[1].data});
  primitive.attributes.push_back({"WEIGHTS_1", primitive.attributes[2].data});
  const Bytes joints = primitive.attributes[1].data.bytes;
  ArrangeInfluences({&primitive});
  EXPECT_EQ(primitive.attributes[1].data.bytes, joints);
}

}  // namespace
}  // namespace lacerta
