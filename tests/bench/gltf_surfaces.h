// The meshes of a glTF file as surfaces with attributes, for benches.
#ifndef LACERTA_TESTS_BENCH_GLTF_SURFACES_H_
#define LACERTA_TESTS_BENCH_GLTF_SURFACES_H_

#include <functional>
#include <string>
#include <vector>

#include "document/primitive.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// Positions, triangles and the attributes that can be interpolated.
VertexSoup ToSoup(const Primitive& primitive);

struct NamedSurface {
  std::string name;
  AttributedMesh mesh;
};

// One surface for each glTF mesh that has triangles; joints and weights are left out.
StatusOr<std::vector<NamedSurface>> ReadGltfSurfaces(const std::string& path);

// Calls `report` for each of them; what fails is told on standard error, by name. Returns whether the file could be read.
bool ReportSurfaces(const std::string& path, const std::function<Status(const NamedSurface&)>& report);

}  // namespace lacerta

#endif  // LACERTA_TESTS_BENCH_GLTF_SURFACES_H_
