// The materials and images that mesh files refer to.
#ifndef LACERTA_MESH_FILE_FILE_MATERIALS_H_
#define LACERTA_MESH_FILE_FILE_MATERIALS_H_

#include <string>
#include <vector>

#include "lacerta/file_mesh.h"
#include "mesh_file/file_surface.h"

namespace lacerta {

struct FileMaterials {
  std::vector<FileMaterial> materials;  // of FileSurface::material_names, or of its textures
  std::vector<FileImage> images;
};

// Reads material libraries (Wavefront .mtl) and textures from `folder`, never from outside it: a path that leads elsewhere, as of the machine
// that wrote it, stands for a file of that name in the folder. What is not there, or no PNG or JPEG, is left out with a note to
// `surface`; where no library says anything, faces have no material.
FileMaterials LoadMaterials(const std::string& folder, FileSurface* surface);

}  // namespace lacerta

#endif  // LACERTA_MESH_FILE_FILE_MATERIALS_H_
