// Packs a mesh into an asset, reads it back and measures it, through the installed headers alone.
#include <lacerta/codec.h>
#include <lacerta/gltf.h>
#include <lacerta/mesh_file.h>

#include <cstdio>

int main() {
  const lacerta::TriangleMesh octahedron = {
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  lacerta::PackOptions options;
  options.encode.target = {lacerta::EncodeTarget::Kind::kPsnr, 50.0};
  options.encode.levels = lacerta::LevelChoice::kAlways;  // an octahedron is smaller as it is
  const auto packed = lacerta::PackMesh(octahedron, "octahedron", options);
  if (!packed.ok()) {
    std::fprintf(stderr, "%s\n", packed.status().message().c_str());
    return 1;
  }
  const auto surfaces = lacerta::ReadProgressive(packed.value().glb, {});
  if (!surfaces.ok() || surfaces.value().size() != 1 || surfaces.value()[0].surface.triangles.size() != 8) {
    std::fprintf(stderr, "the octahedron did not come back: %s\n", surfaces.status().message().c_str());
    return 1;
  }
  return 0;
}
