// Beginnings of image files, as far as their size can be read from them.
#ifndef LACERTA_TESTS_GLTF_TEST_IMAGES_H_
#define LACERTA_TESTS_GLTF_TEST_IMAGES_H_

#include <cstdint>

#include "gltf/test_bytes.h"

namespace lacerta::testing {

inline Bytes Png(uint32_t width, uint32_t height) {
  Bytes bytes = FromText("\x89PNG\r\n\x1a\n");
  AppendBigEndian(uint32_t{13}, &bytes);
  for (const char c : {'I', 'H', 'D', 'R'}) bytes.push_back(static_cast<uint8_t>(c));
  AppendBigEndian(width, &bytes);
  AppendBigEndian(height, &bytes);
  return bytes;
}

inline Bytes Jpeg(uint16_t width, uint16_t height) {
  Bytes bytes = {0xff, 0xd8, 0xff, 0xe0, 0, 4, 1, 2, 0xff, 0xc2, 0, 17, 8};
  AppendBigEndian(height, &bytes);
  AppendBigEndian(width, &bytes);
  return bytes;
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_GLTF_TEST_IMAGES_H_
