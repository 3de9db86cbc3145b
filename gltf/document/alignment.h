// Where in a buffer numbers may begin.
#ifndef LACERTA_DOCUMENT_ALIGNMENT_H_
#define LACERTA_DOCUMENT_ALIGNMENT_H_

#include <cstdint>

namespace lacerta {

// Of vertex attributes, columns of matrices and the parts of a GLB, bytes (glTF 2.0, sections 3.6.2.4 and 4.4.3).
inline constexpr uint64_t kAlignment = 4;

// The least multiple of `alignment` that is not below `size`.
constexpr uint64_t Aligned(uint64_t size, uint64_t alignment = kAlignment) { return (size + alignment - 1) / alignment * alignment; }

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_ALIGNMENT_H_
