// What a mesh file holds: a surface, and what .obj and .ply files lay on it.
#ifndef LACERTA_FILE_MESH_H_
#define LACERTA_FILE_MESH_H_

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "lacerta/attributed_mesh.h"
#include "lacerta/mesh.h"

namespace lacerta {

// A PNG or JPEG file, byte for byte.
struct FileImage {
  std::string name;
  std::string mime_type;
  Bytes bytes;
};

// As a glTF material has it; colors are linear.
struct FileMaterial {
  std::string name;
  std::array<double, 4> base_color = {1, 1, 1, 1};
  std::array<double, 3> emissive = {0, 0, 0};
  double metallic = 0;
  double roughness = 1;
  std::optional<size_t> base_color_image, emissive_image, normal_image;  // of FileMesh::images
};

struct FileMesh {
  static constexpr uint32_t kNoMaterial = std::numeric_limits<uint32_t>::max();

  // TEXCOORD_0 (from the upper left corner, as in glTF), NORMAL (of unit length) and COLOR_0 (linear, 3 or 4 components), whatever the file
  // has of them. A group is what shares a material and has the same attributes. Positions are as in the file, not welded.
  AttributedMesh mesh;
  Vec3d origin = {};                      // added to all positions
  std::vector<uint32_t> group_materials;  // of each group: of `materials`, or kNoMaterial
  std::vector<FileMaterial> materials;
  std::vector<FileImage> images;
  std::vector<std::string> notes;  // what was left aside, and why
};

// The same without all that lies on the surface.
FileMesh ShapeOf(FileMesh mesh);

}  // namespace lacerta

#endif  // LACERTA_FILE_MESH_H_
