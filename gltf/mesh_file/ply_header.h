// The header of a PLY file (Turk 1994): what elements follow, and how their properties are stored.
#ifndef LACERTA_MESH_FILE_PLY_HEADER_H_
#define LACERTA_MESH_FILE_PLY_HEADER_H_

#include <cstdint>
#include <string>
#include <vector>

#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

size_t PlyTypeSize(PlyType type);  // bytes
inline bool PlyTypeIsInteger(PlyType type) { return type != PlyType::kFloat32 && type != PlyType::kFloat64; }

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;  // of the value, or of the items of a list
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  // of the length of a list
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;

  // Index of the first property of one of these names, or -1.
  int Find(const std::vector<std::string>& names) const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  std::vector<std::string> textures;  // files, as MeshLab names them in comments
  size_t size = 0;  // bytes, up to and with the end of the end_header line
  size_t lines = 0;
};

// Fails with kInvalidData naming the line, or kUnsupported for another version.
StatusOr<PlyHeader> ParsePlyHeader(Span<const uint8_t> bytes);

}  // namespace lacerta

#endif  // LACERTA_MESH_FILE_PLY_HEADER_H_
