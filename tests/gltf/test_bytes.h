// Bytes for tests: from text, from numbers, and in heap blocks of the exact size so that a sanitizer sees one byte too
// far.
#ifndef LACERTA_TESTS_GLTF_TEST_BYTES_H_
#define LACERTA_TESTS_GLTF_TEST_BYTES_H_

#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta::testing {

inline Bytes FromText(const std::string& text) { return Bytes(text.begin(), text.end()); }

// Little endian.
template <typename T>
void Append(T value, Bytes* bytes) {
  uint8_t raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes->insert(bytes->end(), raw, raw + sizeof(T));
}

template <typename T>
void AppendBigEndian(T value, Bytes* bytes) {
  Bytes raw;
  Append(value, &raw);
  bytes->insert(bytes->end(), raw.rbegin(), raw.rend());
}

// Calls parse(prefix) for every length from 0 up to the whole.
template <typename Parse>
void ForEveryPrefix(const Bytes& bytes, const Parse& parse) {
  for (size_t length = 0; length <= bytes.size(); ++length) {
    const std::unique_ptr<uint8_t[]> copy(new uint8_t[length]);
    std::copy_n(bytes.begin(), length, copy.get());
    parse(Span<const uint8_t>(copy.get(), length));
  }
}

// Calls parse(mutant) with every byte replaced in turn by a few others.
template <typename Parse>
void ForEveryMutant(const Bytes& bytes, const Parse& parse) {
  for (size_t i = 0; i < bytes.size(); ++i) {
    for (const uint8_t value :
         {uint8_t{0}, uint8_t{0x7f}, uint8_t{0xff}, uint8_t{'9'}, static_cast<uint8_t>(bytes[i] ^ 1)}) {
      Bytes mutant = bytes;
      mutant[i] = value;
      parse(Span<const uint8_t>(mutant));
    }
  }
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_GLTF_TEST_BYTES_H_
