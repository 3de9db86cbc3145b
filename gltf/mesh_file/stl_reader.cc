#include <cstring>
#include <string>
#include <string_view>

#include "mesh_file/mesh_builder.h"
#include "mesh_file/readers.h"
#include "mesh_file/text_scanner.h"

namespace lacerta {
namespace {

constexpr size_t kHeaderSize = 84;    // 80 bytes of anything, then the count
constexpr size_t kTriangleSize = 50;  // normal, three corners, 16 bits of anything

uint32_t ReadUint32(const uint8_t* p) {
  return static_cast<uint32_t>(p[0]) | static_cast<uint32_t>(p[1]) << 8 | static_cast<uint32_t>(p[2]) << 16 |
         static_cast<uint32_t>(p[3]) << 24;
}

float ReadFloat(const uint8_t* p) {
  const uint32_t bits = ReadUint32(p);
  float value;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

void AppendLastThree(TriangleMesh* mesh) {
  const auto end = static_cast<uint32_t>(mesh->positions.size());
  mesh->triangles.push_back({end - 3, end - 2, end - 1});
}

Status ReadBinary(Span<const uint8_t> bytes, const PositionRules& rules, TriangleMesh* mesh) {
  if (bytes.size() < kHeaderSize) {
    return InvalidData("a binary STL file has at least 84 bytes, this one " + std::to_string(bytes.size()));
  }
  const uint32_t count = ReadUint32(bytes.data() + 80);
  LACERTA_RETURN_IF_ERROR(CheckCount(count, kTriangleSize, bytes.size() - kHeaderSize, "triangles"));
  mesh->positions.reserve(size_t{3} * count);
  mesh->triangles.reserve(count);
  for (size_t t = 0; t < count; ++t) {
    const size_t offset = kHeaderSize + t * kTriangleSize;
    for (size_t corner = 0; corner < 3; ++corner) {
      const uint8_t* p = bytes.data() + offset + 12 * (corner + 1);
      const Status status = AppendPosition(ReadFloat(p), ReadFloat(p + 4), ReadFloat(p + 8), rules, mesh);
      if (!status.ok()) return status.WithContext("byte " + std::to_string(offset + 12 * (corner + 1)));
    }
    AppendLastThree(mesh);
  }
  return Status();
}

Status ReadCorner(TextScanner* scanner, const PositionRules& rules, TriangleMesh* mesh) {
  double xyz[3];
  for (double& value : xyz) {
    std::string_view word;
    if (!scanner->NextWord(&word)) return InvalidData("the file ends too early; it is truncated");
    if (!ParseDouble(word, &value))
      return InvalidData("\"" + std::string(word.substr(0, 40)) + "\" is not a coordinate");
  }
  return AppendPosition(xyz[0], xyz[1], xyz[2], rules, mesh);
}

// Only the words that carry the surface are looked at: vertex, endloop, endsolid.
Status ReadText(TextScanner* scanner, const PositionRules& rules, TriangleMesh* mesh) {
  std::string_view line;
  if (!scanner->NextLine(&line)) return InvalidData("the file is empty");  // "solid" and a name of any words
  size_t corners = 0;
  bool ended = false;
  for (std::string_view word; scanner->NextWord(&word);) {
    if (word == "vertex") {
      LACERTA_RETURN_IF_ERROR(ReadCorner(scanner, rules, mesh));
      ++corners;
    } else if (word == "endloop") {
      if (corners != 3) {
        return InvalidData("facet " + std::to_string(mesh->triangles.size()) + " has " + std::to_string(corners) +
                           " corners instead of 3");
      }
      AppendLastThree(mesh);
      corners = 0;
    } else if (word == "endsolid") {
      ended = true;
    } else if (word == "solid") {
      ended = false;
    }
  }
  if (!ended) return InvalidData("there is no endsolid; the file is truncated");
  if (corners != 0) return InvalidData("the last facet has no endloop");
  return Status();
}

// Many binary files begin with "solid" too, so the length decides first.
bool IsBinary(Span<const uint8_t> bytes) {
  if (bytes.size() >= kHeaderSize &&
      bytes.size() == kHeaderSize + uint64_t{ReadUint32(bytes.data() + 80)} * kTriangleSize) {
    return true;
  }
  return bytes.size() < 5 || std::memcmp(bytes.data(), "solid", 5) != 0;
}

}  // namespace

StatusOr<FileSurface> ParseStl(Span<const uint8_t> bytes, const PositionRules& rules) {
  FileSurface surface;
  TriangleMesh& mesh = surface.surface;
  if (IsBinary(bytes)) {
    LACERTA_RETURN_IF_ERROR(ReadBinary(bytes, rules, &mesh));
  } else {
    TextScanner scanner({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    const Status status = ReadText(&scanner, rules, &mesh);
    if (!status.ok()) return status.WithContext(scanner.LineName());
  }
  LACERTA_RETURN_IF_ERROR(CheckNotEmpty(mesh));
  return surface;
}

}  // namespace lacerta
