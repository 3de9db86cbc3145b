#include "document/embed_images.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "gltf/test_bytes.h"
#include "gltf/test_images.h"
#include "lacerta/file_io.h"

namespace lacerta {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::FromText;
using testing::Jpeg;
using testing::Png;

// The first 24 bytes of a PNG of 1 x 1.
constexpr char kDataUri[] = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAAB";

class EmbedImagesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    document_.folder = ::testing::TempDir() + "/lacerta_embed_images";
    std::filesystem::create_directories(document_.folder + "/maps");
    ASSERT_TRUE(WriteFileAtomically(document_.folder + "/maps/a b.png", Png(8, 8)).ok());
    ASSERT_TRUE(WriteFileAtomically(document_.folder + "/b.jpg", Jpeg(8, 8)).ok());
    ASSERT_TRUE(WriteFileAtomically(document_.folder + "/c.gif", FromText("GIF89a")).ok());
  }

  // What becomes of images with these URIs, the first of which has a name.
  Json Embed(ImageFiles files, const std::vector<std::string>& uris) {
    document_.json["images"] = Json::array();
    for (const std::string& uri : uris) document_.json["images"].push_back({{"uri", uri}});
    document_.json["images"][0]["name"] = "first";
    EmbedImages(files, &document_, &notes_);
    return document_.json["images"];
  }

  Bytes BytesOf(const Json& image) const {
    const auto bytes = BufferViewBytes(document_, image["bufferView"].get<uint64_t>());
    return bytes.ok() ? Bytes(bytes.value().begin(), bytes.value().end()) : Bytes();
  }

  GltfDocument document_;
  std::vector<std::string> notes_;
};

TEST_F(EmbedImagesTest, FilesAreTakenByteForByteAndOnce) {
  const Json images = Embed(ImageFiles::kEmbed, {"maps/a%20b.png", "b.jpg", "maps/a%20b.png"});
  EXPECT_EQ(images[0], Json({{"name", "first"}, {"bufferView", 0}, {"mimeType", "image/png"}}));
  EXPECT_EQ(images[1], Json({{"bufferView", 1}, {"mimeType", "image/jpeg"}}));
  EXPECT_EQ(images[2]["bufferView"], 0);
  EXPECT_EQ(BytesOf(images[0]), Png(8, 8));
  EXPECT_EQ(BytesOf(images[1]), Jpeg(8, 8));
  EXPECT_THAT(notes_, IsEmpty());
}

TEST_F(EmbedImagesTest, DataUrisAreTakenInAnyCaseFilesWhereAskedFor) {
  const Json images = Embed(ImageFiles::kReferTo, {kDataUri, "b.jpg"});
  EXPECT_EQ(images[0], Json({{"name", "first"}, {"bufferView", 0}, {"mimeType", "image/png"}}));
  EXPECT_EQ(BytesOf(images[0]), Png(1, 1));
  EXPECT_EQ(images[1], Json({{"uri", "b.jpg"}}));
  EXPECT_THAT(notes_, IsEmpty());
}

TEST_F(EmbedImagesTest, WhatCannotBeTakenStaysAndIsNamed) {
  const std::vector<std::string> uris = {"gone.png", "c.gif", "../outside.png", "https://example.org/a.png", "data:image/png;base64,!"};
  const Json images = Embed(ImageFiles::kEmbed, uris);
  for (size_t i = 0; i < uris.size(); ++i) {
    EXPECT_EQ(images[i]["uri"], uris[i]);
    EXPECT_FALSE(images[i].contains("bufferView"));
  }
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("image 0 stays a reference to \"gone.png\""), HasSubstr("image 1 stays a reference to \"c.gif\": it is neither"),
                                  HasSubstr("image 2 "), HasSubstr("image 3 ")));
  EXPECT_TRUE(document_.buffers.empty());
}

}  // namespace
}  // namespace lacerta
