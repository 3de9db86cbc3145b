// A bare surface that is too large for the way that assets go, with a copy in a document and more of them beside it.
#ifndef LACERTA_PACK_LARGE_SHAPE_H_
#define LACERTA_PACK_LARGE_SHAPE_H_

#include <string>
#include <vector>

#include "document/gltf_document.h"
#include "lacerta/file_mesh.h"
#include "lacerta/gltf.h"
#include "pack/plan.h"

namespace lacerta {

// Whether a mesh is such a surface, within the memory that the options allow. Fails as PlanMemory does.
StatusOr<bool> IsLargeShape(const FileMesh& mesh, const PackOptions& options);

struct LargeShape {
  GltfDocument document;             // as of SingleMeshDocument, with other geometry
  std::vector<PrimitivePlan> plans;  // for that to be replaced
};

// Encodes the surface from where it is. Fails like EncodeMesh. Streams are not compared with Draco of all vertices.
StatusOr<LargeShape> PlanLargeShape(FileMesh mesh, const std::string& name, const PackOptions& options);

}  // namespace lacerta

#endif  // LACERTA_PACK_LARGE_SHAPE_H_
