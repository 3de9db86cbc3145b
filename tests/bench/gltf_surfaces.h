// The meshes of a glTF file as surfaces with attributes, for benches.
#ifndef LACERTA_TESTS_BENCH_GLTF_SURFACES_H_
#define LACERTA_TESTS_BENCH_GLTF_SURFACES_H_

#include <CLI/CLI.hpp>
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

// The main function of a program that reports on the surfaces of files: parses its options and the files, and calls `report` for each
// surface. What fails is told on standard error, by name. Returns the exit status: 0 where all files could be read.
int ReportSurfaces(CLI::App* options, int argc, char** argv, const std::function<Status(const NamedSurface&)>& report);

}  // namespace lacerta

#endif  // LACERTA_TESTS_BENCH_GLTF_SURFACES_H_
