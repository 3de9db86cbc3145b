#include "lacerta/mesh_file.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <utility>

#include "document/draco_primitive.h"
#include "lacerta/codec.h"
#include "lacerta/file_io.h"
#include "lacerta/gltf.h"
#include "mesh_file/file_materials.h"
#include "mesh_file/file_surface.h"
#include "mesh_file/readers.h"
#include "mesh_file/writers.h"

namespace lacerta {
namespace {

std::string LowercaseExtension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

bool BeginsWith(Span<const uint8_t> bytes, const char* magic) {
  const size_t length = std::strlen(magic);
  return bytes.size() >= length && std::memcmp(bytes.data(), magic, length) == 0;
}

// Text files of some editors and shells: their mark, and a letter of ASCII after it.
bool IsUtf16(Span<const uint8_t> bytes) {
  if (bytes.size() < 4) return false;
  return (bytes[0] == 0xFF && bytes[1] == 0xFE && bytes[3] == 0) || (bytes[0] == 0xFE && bytes[1] == 0xFF && bytes[2] == 0);
}

// Notes on what was left out are for those who call FlattenGltf themselves.
StatusOr<TriangleMesh> ParseGltfSurface(Span<const uint8_t> bytes, const std::string& folder) {
  UnpackOptions options;
  options.folder = folder;
  LACERTA_ASSIGN_OR_RETURN(FlattenResult result, FlattenGltf(bytes, options));
  return std::move(result.mesh);
}

// The whole mesh or none: DecodeMesh tells what is left of a stream that was cut short or damaged.
StatusOr<FileSurface> ParseDrc(Span<const uint8_t> bytes) {
  LACERTA_ASSIGN_OR_RETURN(DecodedMesh decoded, DecodeMesh(bytes, {}));
  LACERTA_RETURN_IF_ERROR(decoded.refinement);
  FileSurface surface;
  surface.surface = std::move(decoded.mesh);
  const StatusOr<std::vector<std::string>> kinds = DracoAttributeKinds(bytes);  // of streams that a stock decoder reads
  if (!kinds.ok()) return surface;
  for (const std::string& kind : kinds.value()) surface.notes.push_back(kind + " of the Draco stream is left aside");
  return surface;
}

// The surface alone, as formats without attributes have it.
StatusOr<FileSurface> Alone(StatusOr<TriangleMesh> mesh) {
  if (!mesh.ok()) return mesh.status();
  FileSurface surface;
  surface.surface = std::move(mesh).value();
  return surface;
}

StatusOr<FileSurface> ParseFile(Span<const uint8_t> bytes, MeshFormat format, const std::string& folder) {
  if (bytes.empty()) return InvalidData("the file is empty");
  if (IsUtf16(bytes)) return Unsupported("the file is UTF-16 text; save it as UTF-8 or ASCII");
  if (BeginsWith(bytes, "\xEF\xBB\xBF")) bytes = bytes.Subspan(3);  // the mark of UTF-8
  switch (format) {
    case MeshFormat::kPly:
      return ParsePly(bytes);
    case MeshFormat::kObj:
      return ParseObj(bytes);
    case MeshFormat::kOff:
      return ParseOff(bytes);
    case MeshFormat::kStl:
      return Alone(ParseStl(bytes));
    case MeshFormat::kDrc:
      return ParseDrc(bytes);
    case MeshFormat::kGltf:
      return Alone(ParseGltfSurface(bytes, folder));
  }
  return InternalError("a mesh format without a parser");
}

Status CheckIndices(const TriangleMesh& mesh) {
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const uint32_t index : mesh.triangles[t]) {
      if (index >= mesh.positions.size()) {
        return InvalidArgument("triangle " + std::to_string(t) + " has vertex index " + std::to_string(index) +
                               ", but only " + std::to_string(mesh.positions.size()) + " vertices are there");
      }
    }
  }
  return Status();
}

}  // namespace

StatusOr<MeshFormat> DetectMeshFormat(const std::string& path, Span<const uint8_t> bytes) {
  if (BeginsWith(bytes, "ply\n") || BeginsWith(bytes, "ply\r")) return MeshFormat::kPly;
  if (BeginsWith(bytes, "glTF")) return MeshFormat::kGltf;
  if (BeginsWith(bytes, "DRACO")) return MeshFormat::kDrc;
  const std::string extension = LowercaseExtension(path);
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".off") return MeshFormat::kOff;
  if (extension == ".stl") return MeshFormat::kStl;
  if (extension == ".drc") return MeshFormat::kDrc;
  if (extension == ".glb" || extension == ".gltf") return MeshFormat::kGltf;
  return Unsupported("the extension \"" + extension +
                     "\" is not known; use .glb, .gltf, .obj, .ply, .off, .stl or .drc");
}

StatusOr<TriangleMesh> ParseMesh(Span<const uint8_t> bytes, MeshFormat format, const std::string& folder) {
  LACERTA_ASSIGN_OR_RETURN(FileSurface surface, ParseFile(bytes, format, folder));
  return std::move(surface.surface);
}

StatusOr<FileMesh> ParseFileMesh(Span<const uint8_t> bytes, MeshFormat format, const std::string& folder) {
  if (format == MeshFormat::kGltf) return InvalidArgument("glTF assets are more than a mesh");
  LACERTA_ASSIGN_OR_RETURN(FileSurface surface, ParseFile(bytes, format, folder));
  FileMaterials materials = LoadMaterials(folder, &surface);
  return ToFileMesh(std::move(surface), std::move(materials.materials), std::move(materials.images));
}

StatusOr<TriangleMesh> ReadMeshFile(const std::string& path) {
  LACERTA_ASSIGN_OR_RETURN(const Bytes bytes, ReadFile(path));
  const StatusOr<MeshFormat> format = DetectMeshFormat(path, bytes);
  if (!format.ok()) return format.status().WithContext(path);
  StatusOr<TriangleMesh> mesh = ParseMesh(bytes, format.value(), std::filesystem::path(path).parent_path().string());
  if (!mesh.ok()) return mesh.status().WithContext(path);
  return mesh;
}

Status WriteMeshFile(const TriangleMesh& mesh, const std::string& path) {
  LACERTA_RETURN_IF_ERROR(CheckIndices(mesh).WithContext(path));
  const std::string extension = LowercaseExtension(path);
  if (extension == ".ply") return WriteFileAtomically(path, FormatPly(mesh));
  if (extension == ".obj") return WriteFileAtomically(path, FormatObj(mesh));
  if (extension == ".glb") {
    LACERTA_ASSIGN_OR_RETURN(const Bytes glb, FormatPlainGlb(mesh, std::filesystem::path(path).stem().string()));
    return WriteFileAtomically(path, glb);
  }
  return Unsupported(path + ": meshes are written as .ply, .obj or .glb; choose one of these extensions");
}

}  // namespace lacerta
