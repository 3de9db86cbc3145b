// Where the bytes of a buffer come from when they are not in the GLB itself.
#ifndef LACERTA_DOCUMENT_URI_H_
#define LACERTA_DOCUMENT_URI_H_

#include <filesystem>
#include <string>
#include <string_view>

#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// Whether a path, in its lexically normal form, names something outside the folder that it is relative to, or nothing.
bool LeavesFolder(const std::filesystem::path& path);

// Decodes a base64 "data:" URI, or reads the file that a relative URI names inside `folder`. Absolute paths, other
// schemes and paths that leave the folder are refused with kUnsupported: an asset must not fetch what its user did not
// hand over.
StatusOr<Bytes> LoadUri(std::string_view uri, const std::string& folder);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_URI_H_
