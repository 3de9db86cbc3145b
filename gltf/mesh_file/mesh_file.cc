#include "lacerta/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <utility>

#include "document/draco_primitive.h"
#include "geometry/bounding_box.h"
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
StatusOr<FileSurface> ParseGltfSurface(Span<const uint8_t> bytes, const std::string& folder, const Vec3d& origin) {
  UnpackOptions options;
  options.origin = origin;
  options.folder = folder;
  LACERTA_ASSIGN_OR_RETURN(FlattenResult result, FlattenGltf(bytes, options));
  FileSurface surface;
  surface.surface = std::move(result.mesh);
  return surface;
}

// The whole mesh or none: DecodeMesh tells what is left of a stream that was cut short or damaged.
StatusOr<FileSurface> ParseDrc(Span<const uint8_t> bytes, const Vec3d& origin) {
  LACERTA_ASSIGN_OR_RETURN(DecodedMesh decoded, DecodeMesh(bytes, {}));
  LACERTA_RETURN_IF_ERROR(decoded.refinement);
  FileSurface surface;
  surface.surface = std::move(decoded.mesh);
  for (Vec3f& position : surface.surface.positions) position = Vec3Cast<float>(Vec3Cast<double>(position) - origin);
  return surface;
}

// What a stock decoder finds besides positions; it decodes the stream once more.
void NoteDracoAttributes(Span<const uint8_t> bytes, std::vector<std::string>* notes) {
  const StatusOr<std::vector<std::string>> kinds = DracoAttributeKinds(bytes);
  if (!kinds.ok()) return;  // of the custom form
  for (const std::string& kind : kinds.value()) notes->push_back(kind + " of the Draco stream is left aside");
}

StatusOr<FileSurface> ParseFile(Span<const uint8_t> bytes, MeshFormat format, const std::string& folder, const PositionRules& rules) {
  if (bytes.empty()) return InvalidData("the file is empty");
  if (IsUtf16(bytes)) return Unsupported("the file is UTF-16 text; save it as UTF-8 or ASCII");
  if (BeginsWith(bytes, "\xEF\xBB\xBF")) bytes = bytes.Subspan(3);  // the mark of UTF-8
  switch (format) {
    case MeshFormat::kPly:
      return ParsePly(bytes, rules);
    case MeshFormat::kObj:
      return ParseObj(bytes, rules);
    case MeshFormat::kOff:
      return ParseOff(bytes, rules);
    case MeshFormat::kStl:
      return ParseStl(bytes, rules);
    case MeshFormat::kDrc:
      return ParseDrc(bytes, rules.origin);
    case MeshFormat::kGltf:
      return ParseGltfSurface(bytes, folder, rules.origin);
  }
  return InternalError("a mesh format without a parser");
}

std::function<void(const void*)> PassingIn(const FileBytes& file) {
  return [&file](const void* end) { file.PassTo(static_cast<const uint8_t*>(end)); };
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

Vec3d FarOrigin(const TriangleMesh& mesh) {
  constexpr double kFar = 16;  // diagonals: floats are off by less than 125 dB up to there
  if (mesh.positions.empty()) return {};
  const BoundingBox box = BoundsOf(mesh.positions);
  const Vec3d low = Vec3Cast<double>(box.low), high = Vec3Cast<double>(box.high);
  const double diagonal = Norm(high - low);
  const auto farthest = [](const Vec3d& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
  if (std::max(farthest(low), farthest(high)) <= kFar * diagonal) return {};
  Vec3d origin = (low + high) * 0.5;
  // Of few digits, so that differences to it are exact where positions are floats themselves.
  const double step = diagonal > 0 ? std::exp2(std::floor(std::log2(diagonal))) : 1;
  for (int axis = 0; axis < 3; ++axis) origin[axis] = std::round(origin[axis] / step) * step;
  return origin;
}

StatusOr<TriangleMesh> ParseMesh(Span<const uint8_t> bytes, MeshFormat format, const std::string& folder, const Vec3d& origin) {
  LACERTA_ASSIGN_OR_RETURN(FileSurface surface, ParseFile(bytes, format, folder, {origin, false, {}}));
  return std::move(surface.surface);
}

StatusOr<TriangleMesh> ParseMesh(const FileBytes& file, MeshFormat format, const std::string& folder, const Vec3d& origin) {
  LACERTA_ASSIGN_OR_RETURN(FileSurface surface, ParseFile(file.span(), format, folder, {origin, false, PassingIn(file)}));
  return std::move(surface.surface);
}

namespace {

StatusOr<FileMesh> ParseFileMesh(Span<const uint8_t> bytes, MeshFormat format, const std::string& folder, PositionRules rules) {
  if (format == MeshFormat::kGltf) return InvalidArgument("glTF assets are more than a mesh");
  const bool repair = rules.keep_not_finite;
  const auto parse = [&](const Vec3d& origin) -> StatusOr<FileSurface> {
    rules.origin = origin;
    LACERTA_ASSIGN_OR_RETURN(FileSurface surface, ParseFile(bytes, format, folder, rules));
    if (repair) LACERTA_RETURN_IF_ERROR(RemoveNotFinite(&surface));
    return surface;
  };
  LACERTA_ASSIGN_OR_RETURN(FileSurface surface, parse({}));
  const Vec3d origin = FarOrigin(surface.surface);
  if (origin != Vec3d{}) {
    surface = {};  // before the other comes
    LACERTA_ASSIGN_OR_RETURN(surface, parse(origin));
  }
  if (format == MeshFormat::kDrc) NoteDracoAttributes(bytes, &surface.notes);
  FileMaterials materials = LoadMaterials(folder, &surface);
  FileMesh mesh = ToFileMesh(std::move(surface), std::move(materials.materials), std::move(materials.images));
  mesh.origin = origin;
  return mesh;
}

}  // namespace

StatusOr<FileMesh> ParseFileMesh(Span<const uint8_t> bytes, MeshFormat format, const std::string& folder, bool repair) {
  return ParseFileMesh(bytes, format, folder, PositionRules{{}, repair, {}});
}

StatusOr<FileMesh> ParseFileMesh(const FileBytes& file, MeshFormat format, const std::string& folder, bool repair) {
  return ParseFileMesh(file.span(), format, folder, PositionRules{{}, repair, PassingIn(file)});
}

StatusOr<TriangleMesh> ReadMeshFile(const std::string& path, const Vec3d& origin) {
  LACERTA_ASSIGN_OR_RETURN(const FileBytes bytes, FileBytes::Open(path));
  const StatusOr<MeshFormat> format = DetectMeshFormat(path, bytes.span());
  if (!format.ok()) return format.status().WithContext(path);
  StatusOr<TriangleMesh> mesh = ParseMesh(bytes, format.value(), std::filesystem::path(path).parent_path().string(), origin);
  if (!mesh.ok()) return mesh.status().WithContext(path);
  return mesh;
}

Status WriteMeshFile(const TriangleMesh& mesh, const std::string& path, const Vec3d& origin) {
  LACERTA_RETURN_IF_ERROR(CheckIndices(mesh).WithContext(path));
  const std::string extension = LowercaseExtension(path);
  if (extension == ".ply") return WriteFileAtomically(path, FormatPly(mesh, origin));
  if (extension == ".obj") return WriteFileAtomically(path, FormatObj(mesh, origin));
  if (extension == ".glb") {
    LACERTA_ASSIGN_OR_RETURN(const Bytes glb, FormatPlainGlb(mesh, std::filesystem::path(path).stem().string(), origin));
    return WriteFileAtomically(path, glb);
  }
  return Unsupported(path + ": meshes are written as .ply, .obj or .glb; choose one of these extensions");
}

}  // namespace lacerta
