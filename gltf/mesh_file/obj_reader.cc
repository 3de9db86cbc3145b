#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "mesh_file/mesh_builder.h"
#include "mesh_file/readers.h"
#include "mesh_file/text_scanner.h"

namespace lacerta {
namespace {

// Lines with a backslash at their end go on in the next one. `joined` is the memory for that rare case.
bool NextLogicalLine(TextScanner* scanner, std::string* joined, std::string_view* line) {
  if (!scanner->NextLine(line)) return false;
  if (line->empty() || line->back() != '\\') return true;
  joined->clear();
  bool more = true;
  while (more && !line->empty() && line->back() == '\\') {
    joined->append(line->substr(0, line->size() - 1));
    joined->push_back(' ');
    more = scanner->NextLine(line);
    if (!more) *line = {};
  }
  joined->append(*line);
  *line = *joined;
  return true;
}

Status ReadVertex(std::string_view words, TriangleMesh* mesh) {
  double xyz[3];
  for (double& value : xyz) {
    const std::string_view word = TakeWord(&words);
    if (!ParseDouble(word, &value)) {
      return InvalidData(word.empty() ? "a vertex has fewer than three coordinates"
                                      : "\"" + std::string(word.substr(0, 40)) + "\" is not a number");
    }
  }
  return AppendPosition(xyz[0], xyz[1], xyz[2], mesh);
}

// Faces may name vertices that come later in the file, so their range is checked when all are known.
struct FarthestIndex {
  int64_t index = -1;
  size_t line = 0;
};

Status ReadFace(std::string_view words, size_t line, uint64_t face, std::vector<int64_t>* corners,
                FarthestIndex* farthest, TriangleMesh* mesh) {
  corners->clear();
  for (std::string_view word = TakeWord(&words); !word.empty() && word[0] != '#'; word = TakeWord(&words)) {
    int64_t index = 0;
    if (!ParseInt(word.substr(0, word.find('/')), &index)) {
      return InvalidData("\"" + std::string(word.substr(0, 40)) +
                         "\" is not a vertex of a face (index[/texture[/normal]])");
    }
    const auto count = static_cast<int64_t>(mesh->positions.size());
    if (index == 0 || index < -count) {
      return InvalidData("vertex index " + std::to_string(index) + " is out of range; " + std::to_string(count) +
                         " vertices come before it (indices start at 1, or count back from -1)");
    }
    corners->push_back(index > 0 ? index - 1 : count + index);
    if (corners->back() > farthest->index) *farthest = {corners->back(), line};
  }
  constexpr uint64_t kAnyVertex = uint64_t{1} << 32;
  return AppendPolygon(*corners, kAnyVertex, face, mesh);
}

}  // namespace

StatusOr<TriangleMesh> ParseObj(Span<const uint8_t> bytes) {
  TextScanner scanner({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  TriangleMesh mesh;
  FarthestIndex farthest;
  std::vector<int64_t> corners;
  std::string joined;
  std::string_view line;
  uint64_t num_faces = 0;
  while (NextLogicalLine(&scanner, &joined, &line)) {
    const std::string_view keyword = TakeWord(&line);
    Status status;
    if (keyword == "v") {
      status = ReadVertex(line, &mesh);
    } else if (keyword == "f" || keyword == "fo") {
      status = ReadFace(line, scanner.line(), num_faces++, &corners, &farthest, &mesh);
    }
    if (!status.ok()) return status.WithContext(scanner.LineName());
  }
  if (farthest.index >= static_cast<int64_t>(mesh.positions.size())) {
    return InvalidData("line " + std::to_string(farthest.line) + ": vertex index " +
                       std::to_string(farthest.index + 1) + " is out of range, the file has " +
                       std::to_string(mesh.positions.size()) + " vertices (counted from 1)");
  }
  LACERTA_RETURN_IF_ERROR(CheckNotEmpty(mesh));
  return mesh;
}

}  // namespace lacerta
