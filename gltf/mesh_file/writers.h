// The bytes of a mesh file. Indices are checked; see WriteMeshFile in lacerta/mesh_file.h.
#ifndef LACERTA_MESH_FILE_WRITERS_H_
#define LACERTA_MESH_FILE_WRITERS_H_

#include "lacerta/mesh.h"

namespace lacerta {

Bytes FormatPly(const TriangleMesh& mesh, const Vec3d& origin = {});  // binary little endian
Bytes FormatObj(const TriangleMesh& mesh, const Vec3d& origin = {});  // shortest decimals that give the same floats back

}  // namespace lacerta

#endif  // LACERTA_MESH_FILE_WRITERS_H_
