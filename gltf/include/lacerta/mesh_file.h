// Triangle meshes in files: what the command and the tools around it read and write.
//
// Readers are safe on untrusted bytes: every count is held against the size of the file before memory is taken for it.
#ifndef LACERTA_MESH_FILE_H_
#define LACERTA_MESH_FILE_H_

#include <cstdint>
#include <string>

#include "lacerta/file_io.h"
#include "lacerta/file_mesh.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

enum class MeshFormat {
  kPly,   // ascii, binary little and big endian
  kObj,   // Wavefront
  kOff,   // OFF, COFF, NOFF, STOFF; ascii, binary in either byte order
  kStl,   // ascii and binary; corners at one place become one vertex
  kDrc,   // a stream of ours in either form, or any stock Draco mesh; finest level
  kGltf,  // glb or gltf: the triangle primitives of the default scene with the transforms of their nodes
};

// The format of a file, by its first bytes where those are telling (ply, glb, drc), else by the extension of `path`.
// Fails with kUnsupported, naming the extensions that are known.
StatusOr<MeshFormat> DetectMeshFormat(const std::string& path, Span<const uint8_t> bytes);

// Parses the surface of one file and leaves all else aside. Polygons are cut into fans. Positions are float; values that are not finite as float
// are refused with the index of the vertex, faces with fewer than three corners or an index out of range with that of
// the face. `folder` is where the buffers of a .gltf are looked for; no other format uses it. Fails with kInvalidData,
// naming line or byte offset, or kUnsupported.
// Positions are relative to `origin`, which is taken off before they are rounded to floats.
StatusOr<TriangleMesh> ParseMesh(Span<const uint8_t> bytes, MeshFormat format, const std::string& folder = "", const Vec3d& origin = {});

// A point near the middle of a mesh that is too far from zero for floats (over 16 diagonals), as in coordinates of a country: relative to it
// positions keep their digits. Zero for all others.
Vec3d FarOrigin(const TriangleMesh& mesh);

// The same with what .obj and .ply files lay on the surface: texture coordinates, normals, colors; of .obj the materials of .mtl files and
// their textures, of .ply the textures of `comment TextureFile`, all read from `folder` and nowhere else (empty: the working directory). What
// cannot be used is left aside with a note, and never in the way of the surface. Positions are relative to their FarOrigin. Other formats: the surface alone. kGltf is not for here.
// `repair`: triangles of vertices that have no finite position are taken off, with a note, instead of being refused.
StatusOr<FileMesh> ParseFileMesh(Span<const uint8_t> bytes, MeshFormat format, const std::string& folder, bool repair = false);

// The same of a file that is read or mapped, whose pages are let go of once they were parsed.
StatusOr<TriangleMesh> ParseMesh(const FileBytes& file, MeshFormat format, const std::string& folder = "", const Vec3d& origin = {});
StatusOr<FileMesh> ParseFileMesh(const FileBytes& file, MeshFormat format, const std::string& folder, bool repair = false);

// Reads a file of any of the formats above. Messages begin with `path`. Fails with kNotFound or kIoError besides what
// ParseMesh returns.
StatusOr<TriangleMesh> ReadMeshFile(const std::string& path, const Vec3d& origin = {});

// Writes .ply (binary little endian), .obj or .glb (plain core glTF with smooth normals left to the viewer), chosen by
// the extension of `path`. The file appears under its name only when it is complete. Fails with kUnsupported on another
// extension, kInvalidArgument on an index out of range, kIoError. `origin` is added to all positions: as numbers of 64 bits in .ply, as the
// translation of the node in .glb.
Status WriteMeshFile(const TriangleMesh& mesh, const std::string& path, const Vec3d& origin = {});

}  // namespace lacerta

#endif  // LACERTA_MESH_FILE_H_
