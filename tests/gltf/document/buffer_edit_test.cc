#include "document/buffer_edit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "document/primitive.h"

namespace lacerta {
namespace {

using ::testing::ElementsAre;

AccessorData Bytes8(const std::vector<int8_t>& values) {
  AccessorData data{ComponentType::kInt8, 3, true, values.size() / 3, {}};
  for (const int8_t value : values) data.bytes.push_back(static_cast<uint8_t>(value));
  return data;
}

// "The normalized property has no effect on these", as glTF says of bounds.
TEST(BufferEdit, BoundsAreOfWhatIsStored) {
  GltfDocument document;
  const Json accessor = MakeAccessor(Bytes8({-127, 0, 5, 127, -1, 64}), AccessorUse::kAttribute, true, &document);
  EXPECT_THAT(accessor["min"], ElementsAre(-127, -1, 5));
  EXPECT_THAT(accessor["max"], ElementsAre(127, 0, 64));
  EXPECT_TRUE(accessor["normalized"]);
}

TEST(BufferEdit, SparseAccessorsShareTheirViews) {
  std::vector<float> floats(300, 0.0f);
  floats[3 * 7] = 1.5f;
  std::vector<int8_t> integers(300, 0);
  integers[3 * 50 + 2] = 3;
  integers[3 * 51] = -4;
  const AccessorData a = Bytes8(integers), b = MakeFloatAccessor(floats, 3), none = MakeFloatAccessor(std::vector<float>(300, 0.0f), 3);
  GltfDocument document;
  for (Json& accessor : MakeSparseAccessors({{&a, true}, {&b, true}, {&none, false}}, &document)) AddAccessor(std::move(accessor), &document);
  EXPECT_EQ(ArraySize(document.json, "bufferViews"), 2u);
  ASSERT_EQ(ArraySize(document.json, "accessors"), 3u);
  EXPECT_EQ(ReadAccessor(document, 0).value().bytes, a.bytes);
  EXPECT_EQ(ReadAccessor(document, 1).value().bytes, b.bytes);
  EXPECT_EQ(ReadAccessor(document, 2).value().bytes, none.bytes);
  EXPECT_EQ(document.json["accessors"][1]["sparse"]["values"]["byteOffset"], 8);  // behind 6 bytes, where a float may be
  EXPECT_EQ(document.json["accessors"][2]["sparse"]["count"], 1);
  EXPECT_FALSE(document.json["accessors"][2].contains("min"));
  EXPECT_TRUE(MakeSparseAccessors({}, &document).empty());
  EXPECT_EQ(ArraySize(document.json, "bufferViews"), 2u);
}

// Attributes of a buffer begin at multiples of four bytes each; what is sparse is packed.
TEST(BufferEdit, TheSmallerFormIsTold) {
  std::vector<int8_t> integers(3 * 30, 0);
  EXPECT_FALSE(SparseIsSmaller(Bytes8(integers)));
  EXPECT_EQ(StoredSize(Bytes8(integers)), 120u);
  integers.resize(3 * 100, 0);
  EXPECT_TRUE(SparseIsSmaller(Bytes8(integers)));
  const uint64_t nothing = StoredSize(Bytes8(integers));
  integers[3 * 50 + 2] = integers[3 * 51] = 1;
  EXPECT_EQ(StoredSize(Bytes8(integers)), nothing + 2 * (2 + 3));
}

}  // namespace
}  // namespace lacerta
