#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
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

// A vertex, and the color that some programs write after it.
Status ReadVertex(std::string_view words, const PositionRules& rules, TriangleMesh* mesh, MeshAttribute* colors) {
  double xyz[3];
  for (double& value : xyz) {
    const std::string_view word = TakeWord(&words);
    if (!ParseDouble(word, &value)) {
      return InvalidData(word.empty() ? "a vertex has fewer than three coordinates"
                                      : "\"" + std::string(word.substr(0, 40)) + "\" is not a number");
    }
  }
  double rgb[3];
  const bool has_color = ParseDouble(TakeWord(&words), &rgb[0]) && ParseDouble(TakeWord(&words), &rgb[1]) && ParseDouble(TakeWord(&words), &rgb[2]);
  if (has_color) colors->values.insert(colors->values.end(), {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])});
  return AppendPosition(xyz[0], xyz[1], xyz[2], rules, mesh);
}

// A row of a texture coordinate or of a normal. What is no number becomes none, and is refused where it is used.
void ReadRow(std::string_view words, MeshAttribute* attribute) {
  for (uint32_t c = 0; c < attribute->components; ++c) {
    double value = 0;
    const std::string_view word = TakeWord(&words);
    const bool is_number = ParseDouble(word, &value) || (word.empty() && c > 0);  // vt may have one coordinate
    attribute->values.push_back(is_number ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN());
  }
}

// The part of a corner after its first slash, or after both.
std::string_view PartOf(std::string_view corner, int slashes) {
  for (; slashes > 0; --slashes) {
    const size_t slash = corner.find('/');
    if (slash == corner.npos) return {};
    corner.remove_prefix(slash + 1);
  }
  return corner.substr(0, corner.find('/'));
}

// The row that a corner names, counted from 0; kNoValue where it names none.
uint32_t RowOf(std::string_view word, CornerValues* values) {
  if (word.empty()) return MeshAttribute::kNoValue;
  int64_t index = 0;
  const int64_t count = values->attribute.num_values();
  const bool is_index = ParseInt(word, &index) && index != 0 && index >= -count && index < MeshAttribute::kNoValue;
  if (is_index) return static_cast<uint32_t>(index > 0 ? index - 1 : count + index);
  if (values->trouble.empty()) values->trouble = "\"" + std::string(word.substr(0, 40)) + "\" in a face names none of the " + std::to_string(count) + " before it";
  return MeshAttribute::kNoValue;
}

// How many vertices and faces there are, roughly: lines that go on in the next one may look like some.
struct LineCounts {
  size_t vertices = 0, faces = 0;
};

LineCounts CountLines(std::string_view text, const PositionRules& rules) {
  LineCounts counts;
  uint64_t number = 0;
  for (size_t at = 0; at + 1 < text.size(); ++number) {
    rules.Pass(number, text.data() + at);
    const bool ends_word = text[at + 1] == ' ' || text[at + 1] == '\t';
    if (ends_word && text[at] == 'v') ++counts.vertices;
    if (ends_word && text[at] == 'f') ++counts.faces;
    const size_t end = text.find('\n', at);
    if (end == text.npos) break;
    at = end + 1;
  }
  return counts;
}

// Appends the rows of a face, but for faces before the first that has any.
void AppendRows(const std::vector<uint32_t>& rows, size_t num_triangles_before, MeshAttribute* attribute) {
  constexpr Triangle kNoRows = {MeshAttribute::kNoValue, MeshAttribute::kNoValue, MeshAttribute::kNoValue};
  const bool has_any = std::any_of(rows.begin(), rows.end(), [](uint32_t row) { return row != MeshAttribute::kNoValue; });
  if (attribute->corners.empty() && !has_any) return;
  attribute->corners.resize(num_triangles_before, kNoRows);
  AppendFan(rows, &attribute->corners);
}

class ObjReader {
 public:
  ObjReader(const PositionRules& rules, const LineCounts& counts) : rules_(rules) {
    surface_.surface.positions.reserve(counts.vertices);
    surface_.surface.triangles.reserve(counts.faces);
  }

  Status ReadLine(std::string_view line, size_t number) {
    const std::string_view keyword = TakeWord(&line);
    if (keyword == "v") return ReadVertex(line, rules_, &surface_.surface, &colors_.attribute);
    if (keyword == "vt") {
      ReadRow(line, &texture_.attribute);
    } else if (keyword == "vn") {
      ReadRow(line, &normals_.attribute);
    } else if (keyword == "f" || keyword == "fo") {
      return ReadFace(line, number);
    } else if (keyword == "usemtl") {
      material_ = MaterialNamed(RestOfLine(line));
    } else if (keyword == "mtllib") {
      surface_.material_libraries.push_back(RestOfLine(line));
    }
    return Status();
  }

  StatusOr<FileSurface> Finish() {
    const size_t num_vertices = surface_.surface.positions.size();
    if (farthest_.index >= static_cast<int64_t>(num_vertices)) {
      return InvalidData("line " + std::to_string(farthest_.line) + ": vertex index " + std::to_string(farthest_.index + 1) +
                         " is out of range, the file has " + std::to_string(num_vertices) + " vertices (counted from 1)");
    }
    LACERTA_RETURN_IF_ERROR(CheckNotEmpty(surface_.surface));
    FinishColors();
    for (size_t v = 1; v < texture_.attribute.values.size(); v += 2) texture_.attribute.values[v] = 1 - texture_.attribute.values[v];  // from below
    surface_.attributes = {std::move(texture_), std::move(normals_), std::move(colors_)};
    return std::move(surface_);
  }

 private:
  // Faces may name vertices that come later in the file, so their range is checked when all are known.
  struct FarthestIndex {
    int64_t index = -1;
    size_t line = 0;
  };

  uint32_t MaterialNamed(const std::string& name) {
    const auto [material, is_new] = materials_.emplace(name, static_cast<uint32_t>(surface_.material_names.size()));
    if (is_new) surface_.material_names.push_back(name);
    return material->second;
  }

  Status ReadFace(std::string_view words, size_t line) {
    corners_.clear();
    texture_rows_.clear();
    normal_rows_.clear();
    TriangleMesh& mesh = surface_.surface;
    for (std::string_view word = TakeWord(&words); !word.empty() && word[0] != '#'; word = TakeWord(&words)) {
      int64_t index = 0;
      if (!ParseInt(word.substr(0, word.find('/')), &index)) {
        return InvalidData("\"" + std::string(word.substr(0, 40)) +
                           "\" is not a vertex of a face (index[/texture[/normal]])");
      }
      const auto count = static_cast<int64_t>(mesh.positions.size());
      if (index == 0 || index < -count) {
        return InvalidData("vertex index " + std::to_string(index) + " is out of range; " + std::to_string(count) +
                           " vertices come before it (indices start at 1, or count back from -1)");
      }
      corners_.push_back(index > 0 ? index - 1 : count + index);
      if (corners_.back() > farthest_.index) farthest_ = {corners_.back(), line};
      texture_rows_.push_back(RowOf(PartOf(word, 1), &texture_));
      normal_rows_.push_back(RowOf(PartOf(word, 2), &normals_));
    }
    constexpr uint64_t kAnyVertex = uint64_t{1} << 32;
    const size_t num_before = mesh.triangles.size();
    LACERTA_RETURN_IF_ERROR(AppendPolygon(corners_, kAnyVertex, num_faces_++, &mesh));
    AppendRows(texture_rows_, num_before, &texture_.attribute);
    AppendRows(normal_rows_, num_before, &normals_.attribute);
    if (material_ == FileMesh::kNoMaterial && surface_.triangle_materials.empty()) return Status();
    surface_.triangle_materials.resize(num_before, FileMesh::kNoMaterial);
    surface_.triangle_materials.resize(mesh.triangles.size(), material_);
    return Status();
  }

  // Colors are there for all vertices or for none.
  void FinishColors() {
    MeshAttribute& colors = colors_.attribute;
    if (colors.values.empty()) return;
    colors.corners = surface_.surface.triangles;
    if (colors.num_values() != surface_.surface.positions.size()) {
      colors_.trouble = std::to_string(colors.num_values()) + " of " + std::to_string(surface_.surface.positions.size()) + " vertices have a color";
      return;
    }
    CountFromZeroToOne(&colors);
  }

  const PositionRules rules_;
  FileSurface surface_;
  CornerValues texture_ = TextureValues(), normals_ = NormalValues(), colors_ = ColorValues(3);
  std::map<std::string, uint32_t> materials_;  // by name
  uint32_t material_ = FileMesh::kNoMaterial;
  FarthestIndex farthest_;
  uint64_t num_faces_ = 0;
  std::vector<int64_t> corners_;  // of the face at hand
  std::vector<uint32_t> texture_rows_, normal_rows_;
};

}  // namespace

StatusOr<FileSurface> ParseObj(Span<const uint8_t> bytes, const PositionRules& rules) {
  TextScanner scanner({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  ObjReader reader(rules, CountLines(scanner.rest(), rules));
  std::string joined;
  std::string_view line;
  while (NextLogicalLine(&scanner, &joined, &line)) {
    rules.Pass(scanner.line(), scanner.rest().data());
    const Status status = reader.ReadLine(line, scanner.line());
    if (!status.ok()) return status.WithContext(scanner.LineName());
  }
  return reader.Finish();
}

}  // namespace lacerta
