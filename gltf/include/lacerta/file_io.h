// Whole files in and out.
#ifndef LACERTA_FILE_IO_H_
#define LACERTA_FILE_IO_H_

#include <cstdint>
#include <string>

#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// All bytes of a file. Fails with kNotFound when there is none, kIoError when it cannot be read (a directory,
// permissions).
StatusOr<Bytes> ReadFile(const std::string& path);

// Writes all bytes under a temporary name in the same folder and renames it, so that `path` never holds half a file.
// Something that exists and is no regular file (/dev/null, a pipe) is written to directly. Fails with kIoError.
Status WriteFileAtomically(const std::string& path, Span<const uint8_t> bytes);

}  // namespace lacerta

#endif  // LACERTA_FILE_IO_H_
