// One parser per format; what they promise is in lacerta/mesh_file.h (ParseMesh, ParseFileMesh). Positions are taken by `rules`.
#ifndef LACERTA_MESH_FILE_READERS_H_
#define LACERTA_MESH_FILE_READERS_H_

#include <cstdint>

#include "lacerta/mesh.h"
#include "lacerta/status.h"
#include "mesh_file/file_surface.h"
#include "mesh_file/mesh_builder.h"

namespace lacerta {

StatusOr<FileSurface> ParsePly(Span<const uint8_t> bytes, const PositionRules& rules);
StatusOr<FileSurface> ParseObj(Span<const uint8_t> bytes, const PositionRules& rules);
StatusOr<FileSurface> ParseOff(Span<const uint8_t> bytes, const PositionRules& rules);
StatusOr<FileSurface> ParseStl(Span<const uint8_t> bytes, const PositionRules& rules);

}  // namespace lacerta

#endif  // LACERTA_MESH_FILE_READERS_H_
