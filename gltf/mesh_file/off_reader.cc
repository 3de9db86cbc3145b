#include <string>
#include <string_view>
#include <vector>

#include "mesh_file/binary_off_reader.h"
#include "mesh_file/mesh_builder.h"
#include "mesh_file/readers.h"
#include "mesh_file/text_scanner.h"

namespace lacerta {
namespace {

// The next line that holds anything besides blanks and a comment.
Status NextDataLine(TextScanner* scanner, std::string_view* line) {
  while (scanner->NextLine(line)) {
    *line = line->substr(0, line->find('#'));
    std::string_view rest = *line;
    if (!TakeWord(&rest).empty()) return Status();
  }
  return InvalidData("the file ends too early; it is truncated");
}

// Takes the keyword off the line. The counts follow without a blank in some files, many of ModelNet among them.
std::string_view TakeKeyword(std::string_view* line) {
  const std::string_view word = TakeWord(line);
  const size_t end = word.find_first_of("0123456789", word.find("OFF"));
  if (end != word.npos) *line = {word.data() + end, word.size() - end + line->size()};
  return word.substr(0, end);
}

// [ST][C][N][4][n]OFF: texture coordinates, colours and normals come after the position and are left aside. numbers_per_vertex: of all these.
Status CheckKeyword(std::string_view keyword, std::vector<std::string>* notes, uint64_t* numbers_per_vertex) {
  if (keyword.size() < 3 || keyword.substr(keyword.size() - 3) != "OFF") {
    return InvalidData("does not begin with OFF; this is no OFF file");
  }
  std::string_view prefix = keyword.substr(0, keyword.size() - 3);
  *numbers_per_vertex = 3;
  const auto take = [&](std::string_view letters, uint64_t numbers) {
    if (prefix.substr(0, letters.size()) != letters) return;
    prefix.remove_prefix(letters.size());
    *numbers_per_vertex += numbers;
  };
  take("ST", 2);
  take("C", 4);
  take("N", 3);
  if (prefix.empty()) {
    if (keyword.size() > 3) notes->push_back("of " + std::string(keyword) + " vertices the positions alone are read");
    return Status();
  }
  return Unsupported("the variant " + std::string(keyword.substr(0, 40)) + " is not read; convert it to OFF");
}

Status ParseCount(std::string_view* words, const char* what, uint64_t* count) {
  const std::string_view word = TakeWord(words);
  int64_t value = 0;
  if (!ParseInt(word, &value) || value < 0) {
    return InvalidData(std::string("the number of ") + what + " is \"" + std::string(word.substr(0, 40)) + "\"");
  }
  *count = static_cast<uint64_t>(value);
  return Status();
}

Status ReadVertex(std::string_view line, const PositionRules& rules, TriangleMesh* mesh) {
  double xyz[3];
  for (double& value : xyz) {
    const std::string_view word = TakeWord(&line);
    if (!ParseDouble(word, &value))
      return InvalidData("\"" + std::string(word.substr(0, 40)) + "\" is not a coordinate");
  }
  return AppendPosition(xyz[0], xyz[1], xyz[2], rules, mesh);
}

// A face begins on a line of its own and goes on over the next ones where some writers break it. What else is on its last line are colours.
Status ReadFace(std::string_view line, uint64_t face, TextScanner* scanner, std::vector<int64_t>* corners, TriangleMesh* mesh) {
  uint64_t count = 0;
  LACERTA_RETURN_IF_ERROR(ParseCount(&line, "corners of a face", &count));
  LACERTA_RETURN_IF_ERROR(CheckCount(count, 2, line.size() + scanner->bytes_left() + 1, "corners of a face"));
  corners->clear();
  for (uint64_t i = 0; i < count; ++i) {
    std::string_view word = TakeWord(&line);
    if (word.empty()) {
      LACERTA_RETURN_IF_ERROR(NextDataLine(scanner, &line));
      word = TakeWord(&line);
    }
    int64_t index = 0;
    if (!ParseInt(word, &index))
      return InvalidData("\"" + std::string(word.substr(0, 40)) + "\" is not a vertex index");
    corners->push_back(index);
  }
  return AppendPolygon(*corners, mesh->positions.size(), face, mesh);
}

Status ReadAll(TextScanner* scanner, const PositionRules& rules, FileSurface* surface) {
  TriangleMesh* const mesh = &surface->surface;
  std::string_view line;
  LACERTA_RETURN_IF_ERROR(NextDataLine(scanner, &line));
  uint64_t numbers_per_vertex = 0;
  LACERTA_RETURN_IF_ERROR(CheckKeyword(TakeKeyword(&line), &surface->notes, &numbers_per_vertex));
  std::string_view rest = line;
  const std::string_view next = TakeWord(&rest);
  if (next == "BINARY") {
    const std::string_view body = scanner->rest();
    return ReadBinaryOff({reinterpret_cast<const uint8_t*>(body.data()), body.size()}, numbers_per_vertex, rules, mesh);
  }
  if (next.empty()) LACERTA_RETURN_IF_ERROR(NextDataLine(scanner, &line));
  uint64_t num_vertices = 0;
  uint64_t num_faces = 0;
  LACERTA_RETURN_IF_ERROR(ParseCount(&line, "vertices", &num_vertices));
  LACERTA_RETURN_IF_ERROR(ParseCount(&line, "faces", &num_faces));
  LACERTA_RETURN_IF_ERROR(CheckCount(num_vertices, 6, scanner->bytes_left() + 1, "vertices"));
  mesh->positions.reserve(static_cast<size_t>(num_vertices));
  for (uint64_t v = 0; v < num_vertices; ++v) {
    rules.Pass(v, scanner->rest().data());
    LACERTA_RETURN_IF_ERROR(NextDataLine(scanner, &line));
    LACERTA_RETURN_IF_ERROR(ReadVertex(line, rules, mesh));
  }
  LACERTA_RETURN_IF_ERROR(CheckCount(num_faces, 8, scanner->bytes_left() + 1, "faces"));
  mesh->triangles.reserve(static_cast<size_t>(num_faces));
  std::vector<int64_t> corners;
  for (uint64_t f = 0; f < num_faces; ++f) {
    rules.Pass(f, scanner->rest().data());
    LACERTA_RETURN_IF_ERROR(NextDataLine(scanner, &line));
    LACERTA_RETURN_IF_ERROR(ReadFace(line, f, scanner, &corners, mesh));
  }
  return Status();
}

}  // namespace

StatusOr<FileSurface> ParseOff(Span<const uint8_t> bytes, const PositionRules& rules) {
  TextScanner scanner({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  FileSurface surface;
  const Status status = ReadAll(&scanner, rules, &surface);
  if (!status.ok()) return status.WithContext(scanner.LineName());
  LACERTA_RETURN_IF_ERROR(CheckNotEmpty(surface.surface));
  return surface;
}

}  // namespace lacerta
