// OFF files in binary, behind their first line.
#ifndef LACERTA_MESH_FILE_BINARY_OFF_READER_H_
#define LACERTA_MESH_FILE_BINARY_OFF_READER_H_

#include <cstdint>

#include "lacerta/mesh.h"
#include "lacerta/status.h"
#include "mesh_file/mesh_builder.h"

namespace lacerta {

// bytes: from the counts to the end of the file. words_per_vertex: floats of each, of which the first three are the position; the others and
// colors of faces are left aside. In either byte order, whichever counts and faces fit. Fails with kInvalidData where none does, and as AppendPosition and AppendPolygon do.
Status ReadBinaryOff(Span<const uint8_t> bytes, uint64_t words_per_vertex, const PositionRules& rules, TriangleMesh* mesh);

}  // namespace lacerta

#endif  // LACERTA_MESH_FILE_BINARY_OFF_READER_H_
