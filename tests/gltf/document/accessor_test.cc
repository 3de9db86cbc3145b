#include "document/accessor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gltf/test_bytes.h"

namespace lacerta {
namespace {

using testing::Append;
using ::testing::HasSubstr;

// One buffer with the floats 0, 1, 2, ... and a view of it; `accessor` and `view` are added to.
GltfDocument Floats(size_t count, const Json& accessor, const Json& view = Json::object()) {
  GltfDocument document;
  Bytes bytes;
  for (size_t i = 0; i < count; ++i) Append(static_cast<float>(i), &bytes);
  document.json = {
      {"buffers", {{{"byteLength", bytes.size()}}}},
      {"bufferViews", Json::array({{{"buffer", 0}, {"byteLength", bytes.size()}}})},
      {"accessors", Json::array({{{"bufferView", 0}, {"componentType", 5126}, {"count", 2}, {"type", "VEC3"}}})}};
  document.json["bufferViews"][0].update(view);
  document.json["accessors"][0].update(accessor);
  document.buffers.push_back(std::move(bytes));
  return document;
}

std::string MessageOf(const GltfDocument& document) { return ReadAccessor(document, 0).status().message(); }

TEST(Accessor, ReadsOffsetsAndStrides) {
  const auto data =
      ReadAccessor(Floats(12, {{"byteOffset", 4}}, {{"byteOffset", 8}, {"byteLength", 40}, {"byteStride", 16}}), 0);
  ASSERT_TRUE(data.ok()) << data.status().message();
  EXPECT_EQ(data.value().Float(0, 0), 3.0f);
  EXPECT_EQ(data.value().Float(1, 2), 9.0f);
}

TEST(Accessor, ScalesNormalizedIntegers) {
  AccessorData data;
  data.type = ComponentType::kInt8;
  data.normalized = true;
  data.count = 3;
  data.bytes = {127, static_cast<uint8_t>(-128), static_cast<uint8_t>(-127)};
  EXPECT_EQ(data.Float(0, 0), 1.0f);
  EXPECT_EQ(data.Float(1, 0), -1.0f);
  EXPECT_EQ(data.Float(2, 0), -1.0f);
  data.type = ComponentType::kUint8;
  EXPECT_EQ(data.Float(1, 0), 128.0f / 255.0f);
  data.normalized = false;
  EXPECT_EQ(data.Float(1, 0), 128.0f);
}

TEST(Accessor, AppliesSparseValues) {
  GltfDocument document = Floats(9, {{"count", 2}});
  Json& accessor = document.json["accessors"][0];
  // Index 1 is the first byte of float 0... as unsigned bytes the float 8.0 is 0, 0, 0, 65; float 0 is all zeros.
  accessor["sparse"] = {{"count", 1},
                        {"indices", {{"bufferView", 0}, {"byteOffset", 0}, {"componentType", 5121}}},
                        {"values", {{"bufferView", 0}, {"byteOffset", 24}}}};
  const auto data = ReadAccessor(document, 0);
  ASSERT_TRUE(data.ok()) << data.status().message();
  EXPECT_EQ(data.value().Float(0, 0), 6.0f);  // replaced
  EXPECT_EQ(data.value().Float(1, 0), 3.0f);
  accessor["sparse"]["indices"]["byteOffset"] = 35;  // 65
  EXPECT_THAT(MessageOf(document), HasSubstr("sparse index 65"));
  accessor["sparse"]["count"] = 4000000000u;
  EXPECT_THAT(MessageOf(document), HasSubstr("more than the bufferView"));
}

TEST(Accessor, RangesOfComponents) {
  const AccessorData pairs = MakeFloatAccessor({1, -2, 0.5f, 7, 3, 0}, 2);
  ASSERT_EQ(pairs.count, 3u);
  const std::vector<ComponentRange> ranges = ComponentRanges(pairs);
  ASSERT_EQ(ranges.size(), 2u);
  EXPECT_EQ(ranges[0].low, 0.5f);
  EXPECT_EQ(ranges[0].high, 3.0f);
  EXPECT_EQ(ranges[1].low, -2.0f);
  EXPECT_EQ(ranges[1].high, 7.0f);
  EXPECT_TRUE(ComponentRanges(MakeFloatAccessor({}, 2)).empty());
}

TEST(Accessor, ReadsMatricesAsMatricesAlone) {
  GltfDocument document = Floats(32, {{"byteOffset", 0}}, {{"byteOffset", 0}, {"byteLength", 128}});
  Json& accessor = document.json["accessors"][0];
  EXPECT_THAT(ReadMatrices(document, 0).status().message(), HasSubstr("4 x 4 matrices"));
  accessor["type"] = "MAT4";
  accessor["count"] = 2;
  const auto data = ReadMatrices(document, 0);
  ASSERT_TRUE(data.ok()) << data.status().message();
  EXPECT_EQ(data.value().components, 16u);
  EXPECT_EQ(data.value().Float(1, 3), 19.0f);
  EXPECT_EQ(ReadAccessor(document, 0).status().code(), StatusCode::kUnsupported);
  accessor["count"] = 3;
  EXPECT_EQ(ReadMatrices(document, 0).status().code(), StatusCode::kInvalidData);
}

TEST(Accessor, RefusesWhatIsNotThere) {
  EXPECT_THAT(MessageOf(Floats(6, {{"count", 3}})), AllOf(HasSubstr("accessor 0"), HasSubstr("3 elements")));
  EXPECT_THAT(MessageOf(Floats(6, {{"count", 18446744073709551615u}})), HasSubstr("accessor 0"));
  EXPECT_THAT(MessageOf(Floats(6, {{"byteOffset", 1}})), HasSubstr("from byte 1"));
  EXPECT_THAT(MessageOf(Floats(6, {{"byteOffset", 18446744073709551615u}})), HasSubstr("more than"));
  EXPECT_THAT(MessageOf(Floats(6, {{"bufferView", 1}})), HasSubstr("bufferView 1 does not exist"));
  EXPECT_THAT(MessageOf(Floats(6, {{"componentType", 5124}})), HasSubstr("5124"));
  EXPECT_THAT(MessageOf(Floats(6, {{"type", "MAT4"}})), HasSubstr("MAT4"));
  EXPECT_THAT(MessageOf(Floats(6, {{"count", -1}})), HasSubstr("\"count\""));
  EXPECT_THAT(MessageOf(Floats(6, Json::object(), {{"byteStride", 4}})), HasSubstr("byteStride 4"));
  EXPECT_THAT(MessageOf(Floats(6, Json::object(), {{"byteStride", 0}})), HasSubstr("byteStride 0"));
  EXPECT_THAT(MessageOf(Floats(6, Json::object(), {{"byteLength", 25}})),
              AllOf(HasSubstr("24 of its 25"), HasSubstr("truncated")));
  EXPECT_THAT(MessageOf(Floats(6, Json::object(), {{"buffer", 7}})), HasSubstr("buffer 7"));
  EXPECT_THAT(ReadAccessor(Floats(6, Json::object()), 1).status().message(), HasSubstr("accessor 1 does not exist"));
}

TEST(Accessor, ElementsOfEveryTypeAreInsideTheirViews) {
  const auto check = [](size_t count, const Json& accessor, const Json& view = Json::object()) { return CheckAccessor(Floats(count, accessor, view), 0); };
  const auto sparse = [](uint64_t count, uint64_t offset) {
    const Json indices = {{"bufferView", 0}, {"componentType", 5123}}, values = {{"bufferView", 0}, {"byteOffset", offset}};
    return Json{{"sparse", {{"count", count}, {"indices", indices}, {"values", values}}}};
  };
  EXPECT_TRUE(check(6, Json::object()).ok());
  EXPECT_THAT(check(5, Json::object()).message(), AllOf(HasSubstr("accessor 0"), HasSubstr("2 elements")));
  EXPECT_TRUE(check(32, {{"type", "MAT4"}}).ok());
  EXPECT_EQ(check(31, {{"type", "MAT4"}}).code(), StatusCode::kInvalidData);
  EXPECT_TRUE(check(7, Json::object(), {{"byteStride", 16}}).ok());
  EXPECT_EQ(check(6, Json::object(), {{"byteStride", 16}}).code(), StatusCode::kInvalidData);
  EXPECT_TRUE(check(6, sparse(2, 0)).ok());
  EXPECT_EQ(check(6, sparse(2, 4)).code(), StatusCode::kInvalidData);
  EXPECT_EQ(check(6, sparse(13, 0)).code(), StatusCode::kInvalidData);
  EXPECT_TRUE(check(6, {{"type", "of its own"}, {"count", 99}}).ok());  // nobody knows
  GltfDocument without_data = Floats(6, Json::object());
  without_data.json["accessors"][0].erase("bufferView");
  EXPECT_TRUE(CheckAccessor(without_data, 0).ok());
  EXPECT_EQ(CheckAccessor(without_data, 1).code(), StatusCode::kInvalidData);
}

}  // namespace
}  // namespace lacerta
