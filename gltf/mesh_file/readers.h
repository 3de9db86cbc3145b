// One parser per format; what they promise is in lacerta/mesh_file.h (ParseMesh, ParseFileMesh).
#ifndef LACERTA_MESH_FILE_READERS_H_
#define LACERTA_MESH_FILE_READERS_H_

#include <cstdint>

#include "lacerta/mesh.h"
#include "lacerta/status.h"
#include "mesh_file/file_surface.h"

namespace lacerta {

StatusOr<FileSurface> ParsePly(Span<const uint8_t> bytes);
StatusOr<FileSurface> ParseObj(Span<const uint8_t> bytes);
StatusOr<FileSurface> ParseOff(Span<const uint8_t> bytes);
StatusOr<TriangleMesh> ParseStl(Span<const uint8_t> bytes);

}  // namespace lacerta

#endif  // LACERTA_MESH_FILE_READERS_H_
