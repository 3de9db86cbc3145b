#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "geometry/position_table.h"
#include "mesh_file/binary_words.h"
#include "mesh_file/mesh_builder.h"
#include "mesh_file/readers.h"
#include "mesh_file/text_scanner.h"

namespace lacerta {
namespace {

constexpr size_t kHeaderSize = 84;    // 80 bytes of anything, then the count
constexpr size_t kTriangleSize = 50;  // normal, three corners, 16 bits of anything

// Corners at one place become one vertex as they come: as three vertices for each triangle they would take several times the memory.
class Welder {
 public:
  // expected: triangles.
  Welder(size_t expected, const PositionRules& rules, TriangleMesh* mesh) : rules_(rules), mesh_(mesh), table_(expected / 2) {
    mesh->triangles.reserve(expected);
    mesh->positions.reserve(expected / 2 + expected / 16);
  }

  Status AddCorner(double x, double y, double z) {
    LACERTA_RETURN_IF_ERROR(AppendPosition(x, y, z, rules_, mesh_));
    const auto number = static_cast<uint32_t>(mesh_->positions.size() - 1);
    const Vec3f p = mesh_->positions.back();
    const uint32_t vertex = std::isnan(p.x) ? number : table_.FindOrEnter(mesh_->positions, p, number);
    if (vertex != number) mesh_->positions.pop_back();
    corners_[num_corners_++ % 3] = vertex;
    return Status();
  }
  void EndTriangle() {
    mesh_->triangles.push_back(corners_);
    num_corners_ = 0;
  }
  size_t num_corners() const { return num_corners_; }  // of the triangle at hand
  size_t num_triangles() const { return mesh_->triangles.size(); }
  const PositionRules& rules() const { return rules_; }

 private:
  const PositionRules& rules_;
  TriangleMesh* const mesh_;
  PositionTable table_;
  Triangle corners_{};
  size_t num_corners_ = 0;
};

Status ReadBinary(Span<const uint8_t> bytes, const PositionRules& rules, TriangleMesh* mesh) {
  if (bytes.size() < kHeaderSize) {
    return InvalidData("a binary STL file has at least 84 bytes, this one " + std::to_string(bytes.size()));
  }
  const uint32_t count = ReadUint32(bytes.data() + 80);
  LACERTA_RETURN_IF_ERROR(CheckCount(count, kTriangleSize, bytes.size() - kHeaderSize, "triangles"));
  Welder welder(count, rules, mesh);
  for (size_t t = 0; t < count; ++t) {
    const size_t offset = kHeaderSize + t * kTriangleSize;
    rules.Pass(t, bytes.data() + offset);
    for (size_t corner = 0; corner < 3; ++corner) {
      const uint8_t* p = bytes.data() + offset + 12 * (corner + 1);
      const Status status = welder.AddCorner(ReadFloat(p), ReadFloat(p + 4), ReadFloat(p + 8));
      if (!status.ok()) return status.WithContext("byte " + std::to_string(offset + 12 * (corner + 1)));
    }
    welder.EndTriangle();
  }
  return Status();
}

Status ReadCorner(TextScanner* scanner, Welder* welder) {
  double xyz[3];
  for (double& value : xyz) {
    std::string_view word;
    if (!scanner->NextWord(&word)) return InvalidData("the file ends too early; it is truncated");
    if (!ParseDouble(word, &value))
      return InvalidData("\"" + std::string(word.substr(0, 40)) + "\" is not a coordinate");
  }
  return welder->AddCorner(xyz[0], xyz[1], xyz[2]);
}

// Only the words that carry the surface are looked at: vertex, endloop, endsolid.
Status ReadText(TextScanner* scanner, Welder* welder) {
  std::string_view line;
  if (!scanner->NextLine(&line)) return InvalidData("the file is empty");  // "solid" and a name of any words
  bool ended = false;
  for (std::string_view word; scanner->NextWord(&word);) {
    if (word == "vertex") {
      LACERTA_RETURN_IF_ERROR(ReadCorner(scanner, welder));
    } else if (word == "endloop") {
      if (welder->num_corners() != 3) {
        return InvalidData("facet " + std::to_string(welder->num_triangles()) + " has " + std::to_string(welder->num_corners()) +
                           " corners instead of 3");
      }
      welder->rules().Pass(welder->num_triangles(), scanner->rest().data());
      welder->EndTriangle();
    } else if (word == "endsolid") {
      ended = true;
    } else if (word == "solid") {
      ended = false;
    }
  }
  if (!ended) return InvalidData("there is no endsolid; the file is truncated");
  if (welder->num_corners() != 0) return InvalidData("the last facet has no endloop");
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
    constexpr size_t kLeastBytes = 80;  // of a facet
    Welder welder(bytes.size() / (3 * kLeastBytes), rules, &mesh);
    const Status status = ReadText(&scanner, &welder);
    if (!status.ok()) return status.WithContext(scanner.LineName());
  }
  LACERTA_RETURN_IF_ERROR(CheckNotEmpty(mesh));
  return surface;
}

}  // namespace lacerta
