#include "document/buffer_edit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lacerta {
namespace {

using ::testing::ElementsAre;

// One buffer with the bytes 0 to 31: an image, the data of a stream, its base, indices, another image.
GltfDocument Document() {
  GltfDocument document;
  Bytes bytes;
  for (uint8_t i = 0; i < 32; ++i) bytes.push_back(i);
  AddBuffer(bytes, &document);
  AddBufferView(0, 1, 3, &document);   // image
  AddBufferView(0, 8, 6, &document);   // stream
  AddBufferView(0, 8, 2, &document);   // its base
  AddBufferView(0, 16, 4, &document);  // indices
  AddBufferView(0, 28, 2, &document);  // image
  document.json["images"] = {{{"bufferView", 0}}, {{"uri", "elsewhere.png"}}, {{"bufferView", 4}}};
  document.json["extensions"]["LACERTA_mesh_progressive"]["data"] = 1;
  return document;
}

Bytes View(const GltfDocument& document, uint64_t index) {
  const Span<const uint8_t> bytes = BufferViewBytes(document, index).value();
  return Bytes(bytes.begin(), bytes.end());
}

TEST(MergeBuffers, StreamsComeBeforeImagesAndAfterAllElse) {
  GltfDocument document = Document();
  AddBufferView(AddBuffer({99}, &document), 0, 1, &document);  // of another accessor
  ASSERT_TRUE(MergeBuffers(&document).ok());
  ASSERT_EQ(document.buffers.size(), 1u);
  EXPECT_EQ(View(document, 0), Bytes({1, 2, 3}));
  EXPECT_EQ(View(document, 1), Bytes({8, 9, 10, 11, 12, 13}));
  EXPECT_EQ(View(document, 2), Bytes({8, 9}));
  EXPECT_EQ(View(document, 3), Bytes({16, 17, 18, 19}));
  EXPECT_EQ(View(document, 4), Bytes({28, 29}));
  EXPECT_EQ(View(document, 5), Bytes({99}));
  std::vector<uint64_t> offsets;
  for (const Json& view : document.json["bufferViews"]) offsets.push_back(view.value("byteOffset", uint64_t{0}));
  EXPECT_THAT(offsets, ElementsAre(17, 8, 8, 0, 20, 4));
}

TEST(MergeBuffers, BytesThatAnImageSharesAreNotPutOff) {
  GltfDocument document = Document();
  AddBufferView(0, 2, 4, &document);  // needed, and a part of the first image
  ASSERT_TRUE(MergeBuffers(&document).ok());
  EXPECT_EQ(View(document, 0), Bytes({1, 2, 3}));
  EXPECT_EQ(View(document, 5), Bytes({2, 3, 4, 5}));
  EXPECT_LT(document.json["bufferViews"][5].value("byteOffset", uint64_t{0}), document.json["bufferViews"][1].value("byteOffset", uint64_t{0}));
}

TEST(MergeBuffers, TwiceIsAsOnce) {
  GltfDocument document = Document();
  ASSERT_TRUE(MergeBuffers(&document).ok());
  const GltfDocument once = document;
  ASSERT_TRUE(MergeBuffers(&document).ok());
  EXPECT_EQ(document.json, once.json);
  EXPECT_EQ(document.buffers, once.buffers);
}

TEST(MergeBuffers, RefusesAViewOfBytesThatAreNotThere) {
  GltfDocument document = Document();
  AddBufferView(0, 30, 3, &document);
  EXPECT_EQ(MergeBuffers(&document).code(), StatusCode::kInvalidData);
}

}  // namespace
}  // namespace lacerta
