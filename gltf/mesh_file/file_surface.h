// What a parser takes from a mesh file, as the file has it, and how it becomes a FileMesh.
#ifndef LACERTA_MESH_FILE_FILE_SURFACE_H_
#define LACERTA_MESH_FILE_FILE_SURFACE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "lacerta/attributed_mesh.h"
#include "lacerta/file_mesh.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// An attribute whose corners name rows of values, which may come later in the file, or none (kNoValue).
struct CornerValues {
  MeshAttribute attribute;
  std::string trouble;  // why all of it is left aside: the first reason; empty: nothing is against it
};

CornerValues TextureValues();  // no rows yet
CornerValues NormalValues();
CornerValues ColorValues(uint32_t components);  // as on screens (sRGB)

// Appends the rows at a polygon's corners as the fan that AppendPolygon makes of it.
void AppendFan(const std::vector<uint32_t>& rows, std::vector<Triangle>* corners);

// Of colors as floats: some programs count to 255.
void CountFromZeroToOne(MeshAttribute* colors);

struct FileSurface {
  TriangleMesh surface;
  std::vector<CornerValues> attributes;      // with corners of all triangles, or of none
  std::vector<uint32_t> triangle_materials;  // #F, of materials_named; kNoMaterial; empty: none has any
  std::vector<std::string> material_names;
  std::vector<std::string> material_libraries;  // .obj: files that say what materials are
  std::vector<std::string> textures;            // .ply: files; material i shows texture i
  std::vector<std::string> notes;
};

// Takes the triangles of vertices without a finite position off, with a note; such vertices lie where another does then. Normals that are not
// finite become those that the surface tells. Fails with kInvalidData where no triangle is left.
Status RemoveNotFinite(FileSurface* surface);

// Leaves aside, with a note, what has rows that are not there or not finite; makes normals unit vectors, those without length what the
// surface tells; makes colors linear; takes off what is the same everywhere and, with a note, normals of flat shading; sorts faces into groups.
// `materials`: of surface.material_names.
FileMesh ToFileMesh(FileSurface surface, std::vector<FileMaterial> materials, std::vector<FileImage> images);

}  // namespace lacerta

#endif  // LACERTA_MESH_FILE_FILE_SURFACE_H_
