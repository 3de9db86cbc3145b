#include "document/image_size.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "gltf/test_bytes.h"
#include "gltf/test_images.h"
#include "lacerta/file_io.h"

namespace lacerta {
namespace {

using testing::FromText;
using testing::Jpeg;
using testing::Png;

TEST(ImageSize, ReadsHeaders) {
  EXPECT_EQ(LongerSide(Png(640, 2048)), 2048u);
  EXPECT_EQ(LongerSide(Png(4096, 1)), 4096u);
  EXPECT_EQ(LongerSide(Jpeg(300, 200)), 300u);
  EXPECT_EQ(LongerSide(FromText("RIFF....WEBPVP8X........\x3f\x01\x00\xff\x01\x00")), std::nullopt);  // cut by the zero
  EXPECT_EQ(LongerSide(FromText("GIF89a")), std::nullopt);
}

TEST(ImageSize, SurvivesTruncation) {
  for (const Bytes& image : {Png(640, 480), Jpeg(640, 480)}) {
    size_t known = 0;
    testing::ForEveryPrefix(image, [&](Span<const uint8_t> prefix) { known += LongerSide(prefix).has_value() ? 1 : 0; });
    EXPECT_EQ(known, 1u);  // the whole one
  }
}

TEST(ImageSize, TheLargestOfAnAsset) {
  GltfDocument document;
  EXPECT_EQ(LargestImageSide(document), 0u);
  const Bytes png = Png(2048, 16);
  document.buffers.push_back(png);
  document.json = {{"buffers", {{{"byteLength", png.size()}}}},
                   {"bufferViews", Json::array({{{"buffer", 0}, {"byteLength", png.size()}}})},
                   {"images", {{{"uri", "elsewhere.png"}}, {{"bufferView", 0}}, {{"bufferView", 7}}}}};
  EXPECT_EQ(LargestImageSide(document), 2048u);
}

TEST(ImageSize, FilesBesideTheAssetCount) {
  GltfDocument document;
  document.folder = ::testing::TempDir() + "/lacerta_image_size";
  std::filesystem::create_directories(document.folder + "/textures");
  ASSERT_TRUE(WriteFileAtomically(document.folder + "/textures/large one.png", Png(16, 4096)).ok());
  document.json = {{"images", {{{"uri", "textures/large%20one.png"}}, {{"uri", "gone.png"}}}}};
  EXPECT_EQ(LargestImageSide(document), 4096u);
  document.folder += "/elsewhere";
  EXPECT_EQ(LargestImageSide(document), 0u);
}

TEST(ImageSize, KindsByTheirFirstBytes) {
  EXPECT_EQ(ImageMimeType(Png(1, 1)), "image/png");
  EXPECT_EQ(ImageMimeType(Jpeg(1, 1)), "image/jpeg");
  EXPECT_EQ(ImageMimeType(FromText("RIFF....WEBPVP8X")), "image/webp");
  EXPECT_EQ(ImageMimeType(FromText("\xabKTX 20\xbb")), "image/ktx2");
  EXPECT_EQ(ImageMimeType(FromText("GIF89a")), "");
  EXPECT_EQ(ImageMimeType({}), "");
}

}  // namespace
}  // namespace lacerta
