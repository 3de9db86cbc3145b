#include "mesh_file/binary_off_reader.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mesh_file/binary_words.h"

namespace lacerta {
namespace {

// What writers disagree about. Geomview, whose format it is, has integers and floats big-endian, and after each face the number of its colors, and these; others write as their machines
// do, and no colors.
struct Layout {
  bool is_big_endian;
  bool has_face_colors;
};
constexpr std::array<Layout, 4> kLayouts = {{{true, true}, {false, false}, {false, true}, {true, false}}};

// All of them are of 32 bits.
class Words {
 public:
  Words(Span<const uint8_t> bytes, bool is_big_endian) : bytes_(bytes), is_big_endian_(is_big_endian) {}

  uint64_t size() const { return bytes_.size() / 4; }
  uint32_t Uint(uint64_t i) const { return ReadUint32(At(i), is_big_endian_); }
  double Float(uint64_t i) const { return static_cast<double>(ReadFloat(At(i), is_big_endian_)); }
  const uint8_t* At(uint64_t i) const { return bytes_.data() + 4 * i; }

 private:
  Span<const uint8_t> bytes_;
  bool is_big_endian_;
};

constexpr uint64_t kNumCounts = 3;  // vertices, faces, edges

uint64_t FirstFace(const Words& words, uint64_t words_per_vertex) { return kNumCounts + words.Uint(0) * words_per_vertex; }

// Of a face that begins there, the first word after it; nothing where that is beyond the end.
std::optional<uint64_t> AfterFace(const Words& words, bool has_colors, uint64_t first) {
  for (int i = 0; i < (has_colors ? 2 : 1); ++i) {
    if (first >= words.size()) return std::nullopt;
    first += 1 + uint64_t{words.Uint(first)};
  }
  if (first > words.size()) return std::nullopt;
  return first;
}

// Whether counts and faces in this layout end where the file does.
bool IsIn(const Layout& layout, Span<const uint8_t> bytes, uint64_t words_per_vertex) {
  const Words words(bytes, layout.is_big_endian);
  uint64_t at = FirstFace(words, words_per_vertex);
  for (uint32_t f = 0; f < words.Uint(1); ++f) {
    const std::optional<uint64_t> next = AfterFace(words, layout.has_face_colors, at);
    if (!next) return false;
    at = *next;
  }
  return 4 * at == bytes.size();
}

Status Read(const Layout& layout, Span<const uint8_t> bytes, uint64_t words_per_vertex, const PositionRules& rules, TriangleMesh* mesh) {
  const Words words(bytes, layout.is_big_endian);
  const uint64_t num_vertices = words.Uint(0);
  mesh->positions.reserve(static_cast<size_t>(num_vertices));
  for (uint64_t v = 0; v < num_vertices; ++v) {
    const uint64_t first = kNumCounts + v * words_per_vertex;
    rules.Pass(v, words.At(first));
    LACERTA_RETURN_IF_ERROR(AppendPosition(words.Float(first), words.Float(first + 1), words.Float(first + 2), rules, mesh));
  }
  std::vector<int64_t> corners;
  uint64_t at = FirstFace(words, words_per_vertex);
  for (uint32_t f = 0; f < words.Uint(1); ++f) {
    rules.Pass(f, words.At(at));
    corners.clear();
    for (uint32_t k = 0; k < words.Uint(at); ++k) corners.push_back(words.Uint(at + 1 + k));
    LACERTA_RETURN_IF_ERROR(AppendPolygon(corners, num_vertices, f, mesh));
    at = *AfterFace(words, layout.has_face_colors, at);
  }
  return Status();
}

}  // namespace

Status ReadBinaryOff(Span<const uint8_t> bytes, uint64_t words_per_vertex, const PositionRules& rules, TriangleMesh* mesh) {
  if (bytes.size() >= 4 * kNumCounts) {
    for (const Layout& layout : kLayouts) {
      if (IsIn(layout, bytes, words_per_vertex)) return Read(layout, bytes, words_per_vertex, rules, mesh);
    }
  }
  return InvalidData("binary OFF: the " + std::to_string(bytes.size()) +
                     " bytes after the first line are not those of the vertices and faces that they begin with, in either byte order; the file is truncated or damaged");
}

}  // namespace lacerta
