#include "document/image_size.h"

#include <gtest/gtest.h>

#include "gltf/test_bytes.h"

namespace lacerta {
namespace {

using testing::AppendBigEndian;
using testing::FromText;

Bytes Png(uint32_t width, uint32_t height) {
  Bytes bytes = FromText("\x89PNG\r\n\x1a\n");
  AppendBigEndian(uint32_t{13}, &bytes);
  for (const char c : {'I', 'H', 'D', 'R'}) bytes.push_back(static_cast<uint8_t>(c));
  AppendBigEndian(width, &bytes);
  AppendBigEndian(height, &bytes);
  return bytes;
}

Bytes Jpeg(uint16_t width, uint16_t height) {
  Bytes bytes = {0xff, 0xd8, 0xff, 0xe0, 0, 4, 1, 2, 0xff, 0xc2, 0, 17, 8};
  AppendBigEndian(height, &bytes);
  AppendBigEndian(width, &bytes);
  return bytes;
}

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

}  // namespace
}  // namespace lacerta
