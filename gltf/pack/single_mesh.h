// An asset around one mesh.
#ifndef LACERTA_PACK_SINGLE_MESH_H_
#define LACERTA_PACK_SINGLE_MESH_H_

#include <string>

#include "document/gltf_document.h"
#include "lacerta/file_mesh.h"
#include "lacerta/mesh.h"

namespace lacerta {

// One scene with one node at `origin` that shows the mesh in core glTF: positions and indices. `name` may be empty.
GltfDocument SingleMeshDocument(const TriangleMesh& mesh, const std::string& name, const Vec3d& origin = {});
// With its attributes, materials and images; a primitive for each group.
GltfDocument SingleMeshDocument(const FileMesh& mesh, const std::string& name);

}  // namespace lacerta

#endif  // LACERTA_PACK_SINGLE_MESH_H_
