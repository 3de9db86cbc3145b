// The page over all encoding of bare surfaces, with the plan that EncodeMesh (lacerta/codec.h) makes.
#ifndef LACERTA_DRACO_ENCODE_MESH_H_
#define LACERTA_DRACO_ENCODE_MESH_H_

#include "draco/memory_plan.h"
#include "lacerta/codec.h"

namespace lacerta {

// The mesh is cleaned where it is, measured by way of SurfaceDistanceMeter::CreateLean, and followed by way of a mesh of as few triangles as the plan
// allows. The target is met by what is measured to the input itself; a triangle that is there twice counts once. Throws std::bad_alloc.
StatusOr<EncodedMesh> EncodeLean(TriangleMesh mesh, const EncodeOptions& options, const MemoryPlan& plan);

}  // namespace lacerta

#endif  // LACERTA_DRACO_ENCODE_MESH_H_
