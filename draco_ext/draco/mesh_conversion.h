// Between draco::Mesh and the mesh types of Lacerta. Positions and triangles only: other attributes are not carried.
#ifndef LACERTA_DRACO_MESH_CONVERSION_H_
#define LACERTA_DRACO_MESH_CONVERSION_H_

#include <draco/core/status.h>
#include <draco/mesh/mesh.h>

#include <memory>

#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// Checks what Draco's encoders do not check and crash on: at least one vertex and one triangle, fewer than 2^31 / 3 of
// each, finite positions, indices < #V. Fails with kInvalidData, naming the first vertex or triangle at fault.
Status CheckEncodable(const TriangleMesh& mesh);

// Point i of the result is vertex i, its position is value i of the one POSITION attribute (float32 x 3): vertices at
// equal positions stay apart. The mesh must pass CheckEncodable.
std::unique_ptr<draco::Mesh> ToDracoMesh(const TriangleMesh& mesh);
// The same into an empty mesh.
void FillDracoMesh(const TriangleMesh& mesh, draco::Mesh* result);

// Vertex i of the result is point i. Positions of any number type become floats, without scaling. Fails with
// kInvalidData where there is no POSITION attribute of three components, an index is out of range or a position is not
// finite.
StatusOr<TriangleMesh> FromDracoMesh(const draco::Mesh& mesh);

// The same status in the other library's type. Codes without a counterpart become DRACO_ERROR and kInvalidData.
draco::Status ToDracoStatus(const Status& status);
Status FromDracoStatus(const draco::Status& status);

}  // namespace lacerta

#endif  // LACERTA_DRACO_MESH_CONVERSION_H_
