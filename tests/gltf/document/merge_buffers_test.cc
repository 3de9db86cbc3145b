#include "document/merge_buffers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numeric>

#include "document/accessor.h"
#include "document/alignment.h"
#include "document/buffer_edit.h"

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

// EXT_structural_metadata asks for multiples of 8, in the file as well.
TEST(MergeBuffers, NumbersOfEightBytesStayAligned) {
  for (const bool has_metadata : {false, true}) {
    GltfDocument document = Document();
    document.json["asset"] = {{"version", "2.0"}};
    AddBufferView(AddBuffer(Bytes(16, 7), &document), 8, 8, &document);
    if (has_metadata) document.json["extensionsUsed"] = {"EXT_structural_metadata"};
    for (const char* name : {"", "x", "xx", "xxx", "xxxx"}) {
      GltfDocument merged = document;
      merged.json["asset"]["generator"] = name;
      ASSERT_TRUE(MergeBuffers(&merged).ok());
      const Bytes glb = FormatGlb(merged);
      EXPECT_EQ(View(ParseGltf(glb, "").value(), 5), Bytes(8, 7));
      const uint64_t offset = merged.json["bufferViews"][5].value("byteOffset", uint64_t{0});
      const uint64_t bin = glb.size() - Aligned(merged.buffers[0].size(), AlignmentOf(merged.json));
      EXPECT_EQ(offset % AlignmentOf(merged.json), 0u);
      EXPECT_EQ(bin % AlignmentOf(merged.json), 0u);
      EXPECT_EQ(glb.size() % AlignmentOf(merged.json), 0u);
    }
    EXPECT_EQ(AlignmentOf(document.json), has_metadata ? 8u : 4u);
  }
}

TEST(MergeBuffers, ViewsOfNoBytesKeepABuffer) {
  GltfDocument document;
  AddBufferView(AddBuffer({}, &document), 0, 0, &document);
  ASSERT_TRUE(MergeBuffers(&document).ok());
  EXPECT_EQ(View(document, 0), Bytes());
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

// A buffer of 200 bytes, all different, behind 2 that nobody wants, and views of it that accessors share:
// view 0: indices of 16 bits, view 1: positions and texture coordinates, interleaved.
GltfDocument SharedViews() {
  GltfDocument document;
  Bytes bytes(202);
  std::iota(bytes.begin(), bytes.end(), uint8_t{0});
  AddBuffer(bytes, &document);
  AddBufferView(0, 2, 40, &document);
  AddBufferView(0, 42, 160, &document);
  document.json["bufferViews"][1]["byteStride"] = 20;
  const auto add = [&](uint64_t view, uint64_t offset, uint64_t count, uint64_t type, const char* shape) {
    Json accessor = {{"bufferView", view}, {"componentType", type}, {"count", count}, {"type", shape}};
    if (offset > 0) accessor["byteOffset"] = offset;
    AddAccessor(std::move(accessor), &document);
  };
  add(0, 0, 10, 5123, "SCALAR");
  add(0, 26, 6, 5123, "SCALAR");
  add(1, 40, 3, 5126, "VEC3");
  add(1, 52, 3, 5126, "VEC2");
  return document;
}

Bytes Values(const GltfDocument& document, uint64_t accessor) { return ReadAccessor(document, accessor).value().bytes; }

TEST(MergeBuffers, OfSharedViewsWhatAccessorsReferToStays) {
  const GltfDocument before = SharedViews();
  GltfDocument document = before;
  ASSERT_TRUE(MergeBuffers(&document).ok());
  for (uint64_t i = 0; i < 4; ++i) EXPECT_EQ(Values(document, i), Values(before, i)) << i;
  // 20 and 14 bytes of indices, the second from a multiple of four on, and three strides of vertices; aligned as before.
  EXPECT_LE(document.buffers[0].size(), 20u + 14 + 60 + 4);
  EXPECT_GE(document.buffers[0].size(), 20u + 14 + 60);
  EXPECT_EQ(document.json["bufferViews"][1]["byteLength"], 60);
  for (const Json& accessor : document.json["accessors"]) {
    const Json& view = document.json["bufferViews"][accessor["bufferView"].get<size_t>()];
    const uint64_t offset = accessor.value("byteOffset", uint64_t{0}) + view.value("byteOffset", uint64_t{0});
    EXPECT_EQ(offset % 2, 0u);
    EXPECT_EQ(offset % 4, accessor["componentType"] == 5126 ? 2u : offset % 4);  // as it was
  }
  const GltfDocument once = document;
  ASSERT_TRUE(MergeBuffers(&document).ok());
  EXPECT_EQ(document.json, once.json);
  EXPECT_EQ(document.buffers, once.buffers);
}

TEST(MergeBuffers, SharedViewsShrinkWithTheirAccessors) {
  const GltfDocument before = SharedViews();
  for (const size_t dropped : {0u, 1u}) {
    GltfDocument document = before;
    document.json["accessors"][dropped].erase("bufferView");
    ASSERT_TRUE(MergeBuffers(&document).ok());
    EXPECT_EQ(Values(document, 1 - dropped), Values(before, 1 - dropped));
    EXPECT_EQ(document.json["bufferViews"][0]["byteLength"], dropped == 0 ? 14 : 20);
  }
}

// Three.js reads all strides of what is interleaved, the last one whole, from a multiple of the stride on.
TEST(MergeBuffers, InterleavedStridesStayWhole) {
  constexpr uint64_t kStride = 20;
  GltfDocument before;
  Bytes bytes;
  for (uint8_t i = 0; i < 10 * kStride; ++i) bytes.push_back(i);
  const uint64_t view = AddBufferView(AddBuffer(bytes, &before), 0, bytes.size(), &before);
  before.json["bufferViews"][view]["byteStride"] = kStride;
  for (const uint64_t offset : {3 * kStride, 8 * kStride + 8}) {
    AddAccessor({{"bufferView", view}, {"byteOffset", offset}, {"componentType", 5120}, {"count", 2}, {"type", "VEC3"}}, &before);
  }
  for (const size_t dropped : {0u, 1u, 2u}) {
    GltfDocument document = before;
    if (dropped < 2) document.json["accessors"][dropped].erase("bufferView");
    ASSERT_TRUE(MergeBuffers(&document).ok());
    EXPECT_EQ(document.json["bufferViews"][view]["byteLength"], (dropped < 2 ? 2 : 7) * kStride);
    for (const size_t kept : {0u, 1u}) {
      if (kept == dropped) continue;
      EXPECT_EQ(Values(document, kept), Values(before, kept));
      EXPECT_EQ(document.json["accessors"][kept].value("byteOffset", uint64_t{0}) % kStride, kept == 0 ? 0u : 8u);
    }
  }
}

TEST(MergeBuffers, SparsePartsMoveAlong) {
  GltfDocument document = SharedViews();
  Bytes bytes(64, 0);
  bytes[40] = 2;  // an index
  bytes[48] = 7;  // its value
  const uint64_t view = AddBufferView(AddBuffer(bytes, &document), 0, bytes.size(), &document);
  Json accessor = {{"componentType", 5123}, {"count", 4}, {"type", "SCALAR"}};
  accessor["sparse"] = {{"count", 1},
                        {"indices", {{"bufferView", view}, {"byteOffset", 40}, {"componentType", 5121}}},
                        {"values", {{"bufferView", view}, {"byteOffset", 48}}}};
  const uint64_t index = AddAccessor(std::move(accessor), &document);
  ASSERT_TRUE(MergeBuffers(&document).ok());
  EXPECT_EQ(Values(document, index), Bytes({0, 0, 0, 0, 7, 0, 0, 0}));
  EXPECT_LE(document.json["bufferViews"][view]["byteLength"], 8);
}

TEST(MergeBuffers, MatricesKeepTheirPadding) {
  GltfDocument document = SharedViews();
  const uint64_t view = AddBufferView(AddBuffer(Bytes(64, 1), &document), 0, 64, &document);
  AddAccessor({{"bufferView", view}, {"componentType", 5121}, {"count", 2}, {"type", "MAT3"}}, &document);
  ASSERT_TRUE(MergeBuffers(&document).ok());
  EXPECT_EQ(document.json["bufferViews"][view]["byteLength"], 24);
}

TEST(MergeBuffers, ViewsThatOthersReferToStayWhole) {
  const auto length_of = [](const std::function<void(GltfDocument*)>& change) {
    GltfDocument document = SharedViews();
    change(&document);
    EXPECT_TRUE(MergeBuffers(&document).ok());
    return document.json["bufferViews"][0]["byteLength"].get<uint64_t>();
  };
  EXPECT_EQ(length_of([](GltfDocument*) {}), 34u);
  EXPECT_EQ(length_of([](GltfDocument* document) { document->json["images"] = {{{"bufferView", 0}}}; }), 40u);
  EXPECT_EQ(length_of([](GltfDocument* document) { document->json["extensionsUsed"] = {"EXT_structural_metadata"}; }), 40u);
  EXPECT_EQ(length_of([](GltfDocument* document) { document->json["accessors"][1]["count"] = 8; }), 40u);  // too many
  EXPECT_EQ(length_of([](GltfDocument* document) { document->json["accessors"][1]["count"] = std::numeric_limits<int64_t>::max(); }), 40u);
  EXPECT_EQ(length_of([](GltfDocument* document) { document->json["accessors"][1]["type"] = "VEC7"; }), 40u);
  EXPECT_EQ(length_of([](GltfDocument* document) { document->json["accessors"] = Json::array(); }), 40u);
}

}  // namespace
}  // namespace lacerta
