#include "document/image_size.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "document/uri.h"

namespace lacerta {
namespace {

uint64_t BigEndian(const uint8_t* p, int bytes) {
  uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | p[i];
  return value;
}

uint64_t LittleEndian(const uint8_t* p, int bytes) {
  uint64_t value = 0;
  for (int i = bytes; i-- > 0;) value = value << 8 | p[i];
  return value;
}

bool HasText(Span<const uint8_t> image, size_t offset, const char* text) {
  const size_t length = std::strlen(text);
  return image.size() >= offset + length && std::memcmp(image.data() + offset, text, length) == 0;
}

// Segments are a marker and a length, until one of the start-of-frame kind.
std::optional<uint64_t> SideOfJpeg(Span<const uint8_t> image) {
  size_t at = 2;
  while (at + 9 <= image.size()) {
    const uint8_t* p = image.data() + at;
    if (p[0] != 0xff) return std::nullopt;
    const uint8_t marker = p[1];
    const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame) return std::max(BigEndian(p + 5, 2), BigEndian(p + 7, 2));
    at += 2 + std::max<size_t>(BigEndian(p + 2, 2), 2);
  }
  return std::nullopt;
}

std::optional<uint64_t> SideOfWebp(Span<const uint8_t> image) {
  const uint8_t* p = image.data();
  if (image.size() < 30) return std::nullopt;
  if (HasText(image, 12, "VP8X")) return 1 + std::max(LittleEndian(p + 24, 3), LittleEndian(p + 27, 3));
  if (HasText(image, 12, "VP8L")) {
    const uint64_t bits = LittleEndian(p + 21, 4);
    return 1 + std::max(bits & 0x3fff, bits >> 14 & 0x3fff);
  }
  return std::max(LittleEndian(p + 26, 2) & 0x3fff, LittleEndian(p + 28, 2) & 0x3fff);
}

}  // namespace

std::optional<uint64_t> LongerSide(Span<const uint8_t> image) {
  if (HasText(image, 1, "PNG\r\n") && image.size() >= 24) {
    return std::max(BigEndian(image.data() + 16, 4), BigEndian(image.data() + 20, 4));
  }
  if (image.size() >= 4 && image.data()[0] == 0xff && image.data()[1] == 0xd8) return SideOfJpeg(image);
  if (HasText(image, 0, "RIFF") && HasText(image, 8, "WEBPVP8")) return SideOfWebp(image);
  if (HasText(image, 1, "KTX 20") && image.size() >= 28) {
    return std::max(LittleEndian(image.data() + 20, 4), LittleEndian(image.data() + 24, 4));
  }
  return std::nullopt;
}

std::string ImageMimeType(Span<const uint8_t> image) {
  constexpr char kPng[] = "\x89PNG\r\n\x1a\n";
  if (image.size() > std::strlen(kPng) && HasText(image, 0, kPng)) return "image/png";
  if (image.size() >= 3 && image.data()[0] == 0xff && image.data()[1] == 0xd8) return "image/jpeg";
  if (HasText(image, 0, "RIFF") && HasText(image, 8, "WEBP")) return "image/webp";
  if (HasText(image, 1, "KTX 20")) return "image/ktx2";
  return "";
}

uint64_t LargestImageSide(const GltfDocument& document) {
  uint64_t largest = 0;
  for (uint64_t i = 0; i < ArraySize(document.json, "images"); ++i) {
    const Json& image = *FindElement(document.json, "images", i);
    std::optional<uint64_t> side;
    if (const std::optional<uint64_t> view = AsIndex(Find(image, "bufferView")); view.has_value()) {
      const StatusOr<Span<const uint8_t>> bytes = AvailableViewBytes(document, *view);
      if (bytes.ok()) side = LongerSide(bytes.value());
    } else if (const std::string uri = AsString(Find(image, "uri")); !uri.empty()) {
      const StatusOr<Bytes> bytes = LoadUri(uri, document.folder);
      if (bytes.ok()) side = LongerSide(bytes.value());
    }
    constexpr uint64_t kMostPixels = 1 << 16;  // no texture is larger, whatever a damaged header says
    largest = std::max(largest, std::min(side.value_or(0), kMostPixels));
  }
  return largest;
}

}  // namespace lacerta
