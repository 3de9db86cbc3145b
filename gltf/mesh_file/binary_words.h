// Numbers of 32 bits in binary mesh files.
#ifndef LACERTA_MESH_FILE_BINARY_WORDS_H_
#define LACERTA_MESH_FILE_BINARY_WORDS_H_

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace lacerta {

inline uint32_t ReadUint32(const uint8_t* bytes, bool is_big_endian = false) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value |= static_cast<uint32_t>(bytes[i]) << (8 * (is_big_endian ? 3 - i : i));
  return value;
}

inline float ReadFloat(const uint8_t* bytes, bool is_big_endian = false) {
  const uint32_t bits = ReadUint32(bytes, is_big_endian);
  float value;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

}  // namespace lacerta

#endif  // LACERTA_MESH_FILE_BINARY_WORDS_H_
