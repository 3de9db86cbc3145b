#include "document/gltf_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gltf/test_assets.h"
#include "gltf/test_bytes.h"

namespace lacerta {
namespace {

using testing::FromText;
using ::testing::HasSubstr;

std::string MessageOf(const std::string& text) { return ParseGltf(FromText(text), "").status().message(); }

TEST(GltfDocument, GlbPassesThroughUnchanged) {
  testing::AssetBuilder builder;
  builder.AddMesh("ball", Json::array({builder.Primitive(testing::WavySphere(4, 6))}));
  const Bytes glb = builder.Glb();
  const StatusOr<GltfDocument> document = ParseGltf(glb, "");
  ASSERT_TRUE(document.ok()) << document.status().message();
  EXPECT_EQ(FormatGlb(document.value()), glb);
  EXPECT_EQ(document.value().json["asset"]["extras"]["id"].get<uint64_t>(), 9007199254740993u);
}

TEST(GltfDocument, RefusesEveryTruncationOfHeaderAndJson) {
  testing::AssetBuilder builder;
  builder.AddMesh("ball", Json::array({builder.Primitive(testing::WavySphere(3, 3))}));
  const Bytes glb = builder.Glb();
  size_t first_readable = 0;
  testing::ForEveryPrefix(glb, [&](Span<const uint8_t> prefix) {
    const bool ok = ParseGltf(prefix, "").ok();
    if (ok && first_readable == 0) first_readable = prefix.size();
    EXPECT_EQ(ok, first_readable != 0) << prefix.size();
  });
  const size_t json_end = 20 + testing::JsonOf(glb).dump().size();
  EXPECT_GE(first_readable, json_end);
  EXPECT_LE(first_readable, json_end + 3);
}

TEST(GltfDocument, ReadsDataUris) {
  const auto document = ParseGltf(
      FromText(
          R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": "data:application/octet-stream;base64,AQID/w=="}]})"),
      "");
  ASSERT_TRUE(document.ok()) << document.status().message();
  EXPECT_THAT(document.value().buffers[0], ::testing::ElementsAre(1, 2, 3, 255));
}

TEST(GltfDocument, ABufferInNoFileIsNamed) {
  const auto document = ParseGltf(
      FromText(R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4}], "bufferViews": [{"buffer": 0, "byteLength": 4}]})"), "");
  ASSERT_TRUE(document.ok()) << document.status().message();
  const Status status = BufferViewBytes(document.value(), 0).status();
  EXPECT_EQ(status.code(), StatusCode::kUnsupported);
  EXPECT_THAT(status.message(), HasSubstr("buffer 0 has no \"uri\", and there is no BIN chunk"));

  testing::AssetBuilder builder;
  builder.AddMesh("ball", Json::array({builder.Primitive(testing::WavySphere(4, 6))}));
  const Bytes glb = builder.Glb();
  const size_t before_bin = glb.size() - ParseGltf(glb, "").value().buffers[0].size() - 8;
  const GltfDocument cut = ParseGltf(Span<const uint8_t>(glb).First(before_bin), "").value();
  EXPECT_EQ(BufferViewBytes(cut, 0).status().code(), StatusCode::kInvalidData) << "a file that was cut off";
}

TEST(GltfDocument, NamesWhatIsWrong) {
  EXPECT_THAT(MessageOf("{"), HasSubstr("not well formed at its end"));
  EXPECT_THAT(MessageOf("{\"asset\": [1, what?]}"), HasSubstr("not well formed at byte 14, where it goes on with \"what?]}\""));
  EXPECT_THAT(MessageOf("[]"), HasSubstr("no object"));
  EXPECT_THAT(MessageOf(R"({"asset": {"version": "1.0"}})"), HasSubstr("1.0"));
  EXPECT_THAT(MessageOf(R"({"asset": 2})"), HasSubstr("version"));
  for (const char* member :
       {R"("meshes": 3)", R"("meshes": [{}])", R"("meshes": [{"primitives": [1]}])", R"("accessors": [null])",
        R"("extensions": [])", R"("nodes": [{"extensions": 1}])", R"("extensionsUsed": {})"}) {
    EXPECT_THAT(MessageOf(std::string(R"({"asset": {"version": "2.0"}, )") + member + "}"), HasSubstr("\" is no "));
  }
  EXPECT_THAT(MessageOf(std::string(100000, '[')), HasSubstr("levels deep"));
  const std::string head = R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": ")";
  EXPECT_THAT(MessageOf(head + "/etc/passwd\"}]}"), HasSubstr("in the folder"));
  EXPECT_THAT(MessageOf(head + "a/../../b.bin\"}]}"), HasSubstr("in the folder"));
  EXPECT_THAT(MessageOf(head + "%2e%2e/b.bin\"}]}"), HasSubstr("in the folder"));
  EXPECT_THAT(MessageOf(head + "https://a.b/c.bin\"}]}"), HasSubstr("in the folder"));
  EXPECT_THAT(MessageOf(head + "no_such.bin\"}]}"), AllOf(HasSubstr("buffer 0"), HasSubstr("no_such.bin")));
  EXPECT_THAT(MessageOf(head + "data:;base64,AQI=\"}]}"), HasSubstr("announces 4 bytes"));
  EXPECT_THAT(MessageOf(head + "data:;base64,A?I=\"}]}"), HasSubstr("base64"));
}

}  // namespace
}  // namespace lacerta
