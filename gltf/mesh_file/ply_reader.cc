#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh_file/file_surface.h"
#include "mesh_file/mesh_builder.h"
#include "mesh_file/ply_header.h"
#include "mesh_file/readers.h"
#include "mesh_file/text_scanner.h"

namespace lacerta {
namespace {

// The values of the body one after the other, whatever their encoding.
class AsciiValues {
 public:
  AsciiValues(std::string_view body, size_t header_lines) : scanner_(body), header_lines_(header_lines) {}

  Status Next(PlyType type, double* value) {
    std::string_view word;
    if (!scanner_.NextWord(&word)) return InvalidData("the file ends too early; it is truncated");
    if (!ParseDouble(word, value) || (PlyTypeIsInteger(type) && *value != std::floor(*value))) {
      return InvalidData("\"" + std::string(word.substr(0, 40)) + "\" is not a number of the declared type");
    }
    return Status();
  }
  // A row ends with its line: some programs write values there that the header does not name.
  void EndRow() {
    std::string_view rest;
    scanner_.NextLine(&rest);
  }
  uint64_t bytes_left() const { return scanner_.bytes_left(); }
  const void* here() const { return scanner_.rest().data(); }
  std::string Where() const { return "line " + std::to_string(header_lines_ + scanner_.line()); }
  // Least bytes of one value: a digit and a blank, which the very last one may lack.
  static uint64_t LeastBytes(PlyType) { return 2; }
  static constexpr uint64_t kSlack = 1;

 private:
  TextScanner scanner_;
  size_t header_lines_;
};

class BinaryValues {
 public:
  BinaryValues(Span<const uint8_t> bytes, size_t offset, bool big_endian)
      : bytes_(bytes), offset_(offset), big_endian_(big_endian) {}

  Status Next(PlyType type, double* value) {
    const size_t size = PlyTypeSize(type);
    if (bytes_.size() - offset_ < size) return InvalidData("the file ends too early; it is truncated");
    uint64_t raw = 0;
    for (size_t i = 0; i < size; ++i) {
      const size_t place = big_endian_ ? size - 1 - i : i;
      raw |= static_cast<uint64_t>(bytes_[offset_ + i]) << (8 * place);
    }
    *value = Interpret(type, raw);
    offset_ += size;
    return Status();
  }
  void EndRow() {}
  uint64_t bytes_left() const { return bytes_.size() - offset_; }
  const void* here() const { return bytes_.data() + offset_; }
  std::string Where() const { return "byte " + std::to_string(offset_); }
  static uint64_t LeastBytes(PlyType type) { return PlyTypeSize(type); }
  static constexpr uint64_t kSlack = 0;

 private:
  static double Interpret(PlyType type, uint64_t raw) {
    switch (type) {
      case PlyType::kInt8:
        return static_cast<int8_t>(raw);
      case PlyType::kInt16:
        return static_cast<int16_t>(raw);
      case PlyType::kInt32:
        return static_cast<int32_t>(raw);
      case PlyType::kUint8:
      case PlyType::kUint16:
      case PlyType::kUint32:
        return static_cast<double>(raw);
      case PlyType::kFloat32: {
        float value;
        const auto bits = static_cast<uint32_t>(raw);
        std::memcpy(&value, &bits, sizeof(value));
        return value;
      }
      case PlyType::kFloat64: {
        double value;
        std::memcpy(&value, &raw, sizeof(value));
        return value;
      }
    }
    return 0.0;
  }

  Span<const uint8_t> bytes_;
  size_t offset_;
  bool big_endian_;
};

// Calls item(property, index in list, value) for every value of one row of `element`.
template <typename Values, typename Item>
Status ReadRow(const PlyElement& element, Values* values, const Item& item) {
  for (size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    double count = 1.0;
    if (property.is_list) {
      LACERTA_RETURN_IF_ERROR(values->Next(property.count_type, &count));
      if (!(count >= 0.0 && count <= 4294967295.0)) return InvalidData("a list has a negative or absurd length");
      LACERTA_RETURN_IF_ERROR(CheckCount(static_cast<uint64_t>(count), Values::LeastBytes(property.type),
                                         values->bytes_left() + Values::kSlack, "items of the list " + property.name));
    }
    for (uint64_t i = 0; i < static_cast<uint64_t>(count); ++i) {
      double value = 0.0;
      LACERTA_RETURN_IF_ERROR(values->Next(property.type, &value));
      item(p, value);
    }
  }
  values->EndRow();
  return Status();
}

// What properties of vertices are called, by the programs that write them.
struct VertexColumns {
  int position[3], normal[3], color[4], texture[2];  // properties; -1 where there is none

  explicit VertexColumns(const PlyElement& vertex)
      : position{Number(vertex, {"x"}), Number(vertex, {"y"}), Number(vertex, {"z"})},
        normal{Number(vertex, {"nx"}), Number(vertex, {"ny"}), Number(vertex, {"nz"})},
        color{Number(vertex, {"red", "diffuse_red"}), Number(vertex, {"green", "diffuse_green"}), Number(vertex, {"blue", "diffuse_blue"}),
              Number(vertex, {"alpha", "diffuse_alpha"})},
        texture{Number(vertex, {"s", "u", "texture_u"}), Number(vertex, {"t", "v", "texture_v"})} {}

  bool has_normals() const { return normal[0] >= 0 && normal[1] >= 0 && normal[2] >= 0; }
  bool has_colors() const { return color[0] >= 0 && color[1] >= 0 && color[2] >= 0; }
  bool has_texture() const { return texture[0] >= 0 && texture[1] >= 0; }

 private:
  static int Number(const PlyElement& vertex, const std::vector<std::string>& names) {
    const int found = vertex.Find(names);
    return found >= 0 && !vertex.properties[static_cast<size_t>(found)].is_list ? found : -1;
  }
};

// Integers of colors count to the largest of their type.
double ColorScale(PlyType type) { return PlyTypeIsInteger(type) ? 1 / (std::exp2(8.0 * static_cast<double>(PlyTypeSize(type))) - 1) : 1; }

// Vertex v has row v of each of its attributes.
struct VertexAttributes {
  CornerValues texture = TextureValues(), normals = NormalValues(), colors = ColorValues(3);
};

// A vertex without a finite position: the grids of depth cameras have one where nothing was seen, which no triangle uses.
struct UnseenVertex {
  uint32_t vertex;
  std::string where;  // in the file
};

// Puts unseen vertices where another is, so that they have a position; fails where a triangle uses one.
Status PlaceUnseen(const std::vector<UnseenVertex>& unseen, TriangleMesh* mesh) {
  if (unseen.empty()) return Status();
  std::vector<uint8_t> is_used(mesh->positions.size(), 0);
  for (const Triangle& t : mesh->triangles) {
    for (const uint32_t v : t) is_used[v] = 1;
  }
  for (const UnseenVertex& u : unseen) {
    if (is_used[u.vertex] != 0) {
      return InvalidData(u.where + ": vertex " + std::to_string(u.vertex) +
                         ": a coordinate is not a finite 32-bit float, and a triangle uses it; repair or remove the vertex");
    }
    mesh->positions[u.vertex] = mesh->positions[mesh->triangles[0][0]];
  }
  return Status();
}

template <typename Values>
Status ReadVertices(const PlyElement& element, const PositionRules& rules, Values* values, TriangleMesh* mesh, VertexAttributes* attributes,
                    std::vector<UnseenVertex>* unseen) {
  const VertexColumns columns(element);
  const char* const axes[3] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    if (columns.position[axis] < 0) return InvalidData(std::string("the vertices have no property ") + axes[axis]);
  }
  const bool has_alpha = columns.color[3] >= 0;
  if (has_alpha) attributes->colors = ColorValues(4);
  const double color_scale = columns.has_colors() ? ColorScale(element.properties[static_cast<size_t>(columns.color[0])].type) : 1;
  std::vector<double> row(element.properties.size());
  const auto number = [&](int property, double scale = 1) { return static_cast<float>(scale * row[static_cast<size_t>(property)]); };
  mesh->positions.reserve(static_cast<size_t>(element.count));
  for (uint64_t v = 0; v < element.count; ++v) {
    rules.Pass(v, values->here());
    LACERTA_RETURN_IF_ERROR(ReadRow(element, values, [&](size_t property, double value) { row[property] = value; }));
    const auto [x, y, z] = columns.position;
    if (!AppendPosition(row[static_cast<size_t>(x)], row[static_cast<size_t>(y)], row[static_cast<size_t>(z)], rules, mesh).ok()) {
      unseen->push_back({static_cast<uint32_t>(v), values->Where()});
      mesh->positions.push_back({});
    }
    if (columns.has_normals()) {
      for (const int property : columns.normal) attributes->normals.attribute.values.push_back(number(property));
    }
    if (columns.has_colors()) {
      for (int c = 0; c < (has_alpha ? 4 : 3); ++c) attributes->colors.attribute.values.push_back(number(columns.color[c], color_scale));
    }
    if (columns.has_texture()) {
      attributes->texture.attribute.values.push_back(number(columns.texture[0]));
      attributes->texture.attribute.values.push_back(1 - number(columns.texture[1]));  // from below
    }
  }
  if (columns.has_colors() && color_scale == 1) CountFromZeroToOne(&attributes->colors.attribute);
  return Status();
}

// Which property of faces or strips lists their vertices.
StatusOr<size_t> FindIndices(const PlyElement& element) {
  const int found = element.Find({"vertex_indices", "vertex_index"});
  if (found < 0 || !element.properties[static_cast<size_t>(found)].is_list) {
    return InvalidData("the faces have no list vertex_indices");
  }
  const auto indices = static_cast<size_t>(found);
  if (!PlyTypeIsInteger(element.properties[indices].type)) {
    return InvalidData("the list vertex_indices is not of an integer type");
  }
  return indices;
}

constexpr Triangle kNoRows = {MeshAttribute::kNoValue, MeshAttribute::kNoValue, MeshAttribute::kNoValue};

// One row of faces or strips.
struct FaceRow {
  std::vector<int64_t> vertices;  // -1 for what no index can be
  std::vector<float> texture;     // of the corners one after the other, as MeshLab writes them
  int64_t texture_number = 0;
};

// Calls done(row number, FaceRow) for each row.
template <typename Values, typename Done>
Status ReadFaceRows(const PlyElement& element, const PositionRules& rules, Values* values, const Done& done) {
  LACERTA_ASSIGN_OR_RETURN(const size_t indices, FindIndices(element));
  const int texture = element.Find({"texcoord"}), number = element.Find({"texnumber"});
  FaceRow face;
  for (uint64_t row = 0; row < element.count; ++row) {
    rules.Pass(row, values->here());
    face.vertices.clear();
    face.texture.clear();
    LACERTA_RETURN_IF_ERROR(ReadRow(element, values, [&](size_t property, double value) {
      // A double holds every index that can be in range.
      const int64_t index = std::abs(value) < 1e15 ? static_cast<int64_t>(value) : -1;
      if (property == indices) face.vertices.push_back(index);
      if (static_cast<int>(property) == texture) face.texture.push_back(static_cast<float>(value));
      if (static_cast<int>(property) == number) face.texture_number = index;
    }));
    LACERTA_RETURN_IF_ERROR(done(row, face));
  }
  return Status();
}

// wedges: texture coordinates that faces have themselves.
template <typename Values>
Status ReadFaces(const PlyElement& element, uint64_t num_vertices, const PositionRules& rules, Values* values, FileSurface* surface,
                 CornerValues* wedges) {
  TriangleMesh& mesh = surface->surface;
  const bool may_have_wedges = element.Find({"texcoord"}) >= 0;
  if (may_have_wedges) wedges->attribute.corners.resize(mesh.triangles.size(), kNoRows);  // of strips that came before
  mesh.triangles.reserve(static_cast<size_t>(element.count));
  std::vector<uint32_t> rows;
  return ReadFaceRows(element, rules, values, [&](uint64_t number, const FaceRow& face) {
    const size_t num_before = mesh.triangles.size();
    LACERTA_RETURN_IF_ERROR(AppendPolygon(face.vertices, num_vertices, number, &mesh));
    std::vector<float>& values_of_wedges = wedges->attribute.values;
    const bool has_wedges = face.texture.size() == 2 * face.vertices.size();
    rows.clear();
    for (size_t i = 0; i < face.vertices.size(); ++i) {
      rows.push_back(has_wedges ? wedges->attribute.num_values() : MeshAttribute::kNoValue);
      if (has_wedges) values_of_wedges.insert(values_of_wedges.end(), {face.texture[2 * i], 1 - face.texture[2 * i + 1]});
    }
    if (may_have_wedges) AppendFan(rows, &wedges->attribute.corners);
    const bool has_texture = face.texture_number >= 0 && face.texture_number < static_cast<int64_t>(surface->textures.size());
    if (!surface->textures.empty()) {
      surface->triangle_materials.resize(num_before, FileMesh::kNoMaterial);
      surface->triangle_materials.resize(mesh.triangles.size(), has_texture ? static_cast<uint32_t>(face.texture_number) : FileMesh::kNoMaterial);
    }
    return Status();
  });
}

// Strips as Stanford's tools write them: every vertex makes a triangle with the two before it, each second one turned round; -1 begins
// a new strip.
template <typename Values>
Status ReadStrips(const PlyElement& element, uint64_t num_vertices, const PositionRules& rules, Values* values, TriangleMesh* mesh) {
  return ReadFaceRows(element, rules, values, [&](uint64_t row, const FaceRow& face) {
    const std::vector<int64_t>& vertices = face.vertices;
    size_t begin = 0;
    for (size_t i = 0; i < vertices.size(); ++i) {
      if (vertices[i] == -1) begin = i + 1;
      if (i < begin + 2) continue;
      const size_t turn = (i - begin) % 2;
      LACERTA_RETURN_IF_ERROR(AppendPolygon({vertices[i - 2 + turn], vertices[i - 1 - turn], vertices[i]}, num_vertices, row, mesh));
    }
    return Status();
  });
}

template <typename Values>
Status SkipRows(const PlyElement& element, Values* values) {
  for (uint64_t row = 0; row < element.count; ++row) {
    LACERTA_RETURN_IF_ERROR(ReadRow(element, values, [](size_t, double) {}));
  }
  return Status();
}

// Least bytes of a row: every value once, a list only by its length.
template <typename Values>
uint64_t LeastRowBytes(const PlyElement& element) {
  uint64_t sum = 0;
  for (const PlyProperty& property : element.properties) {
    sum += Values::LeastBytes(property.is_list ? property.count_type : property.type);
  }
  return sum;
}

template <typename Values>
StatusOr<FileSurface> ReadBody(const PlyHeader& header, const PositionRules& rules, Values* values) {
  FileSurface surface;
  surface.textures = header.textures;
  TriangleMesh& mesh = surface.surface;
  VertexAttributes attributes;
  std::vector<UnseenVertex> unseen;
  CornerValues wedges = TextureValues();
  uint64_t num_vertices = 0;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") num_vertices = element.count;
  }
  for (const PlyElement& element : header.elements) {
    if (element.properties.empty()) continue;  // rows without any value take no bytes
    LACERTA_RETURN_IF_ERROR(CheckCount(element.count, LeastRowBytes<Values>(element),
                                       values->bytes_left() + Values::kSlack, "rows of element " + element.name));
    Status status;
    if (element.name == "vertex") {
      status = ReadVertices(element, rules, values, &mesh, &attributes, &unseen);
    } else if (element.name == "face") {
      status = ReadFaces(element, num_vertices, rules, values, &surface, &wedges);
    } else if (element.name == "tristrips") {
      status = ReadStrips(element, num_vertices, rules, values, &mesh);
    } else {
      status = SkipRows(element, values);
    }
    if (!status.ok()) return status.WithContext(values->Where());
  }
  if (mesh.positions.size() != num_vertices) return InvalidData("the vertices have no properties");
  LACERTA_RETURN_IF_ERROR(CheckNotEmpty(mesh));
  LACERTA_RETURN_IF_ERROR(PlaceUnseen(unseen, &mesh));
  const bool has_wedges = !wedges.attribute.values.empty();
  if (has_wedges) std::swap(attributes.texture, wedges);  // they may have seams
  for (CornerValues* values_at : {&attributes.texture, &attributes.normals, &attributes.colors}) {
    MeshAttribute& attribute = values_at->attribute;
    if (attribute.values.empty()) continue;
    const bool by_corner = has_wedges && values_at == &attributes.texture;
    if (!by_corner) attribute.corners = mesh.triangles;
    attribute.corners.resize(mesh.triangles.size(), kNoRows);  // of strips
    surface.attributes.push_back(std::move(*values_at));
  }
  if (!surface.triangle_materials.empty()) surface.triangle_materials.resize(mesh.triangles.size(), FileMesh::kNoMaterial);
  return surface;
}

}  // namespace

StatusOr<FileSurface> ParsePly(Span<const uint8_t> bytes, const PositionRules& rules) {
  LACERTA_ASSIGN_OR_RETURN(const PlyHeader header, ParsePlyHeader(bytes));
  if (header.encoding == PlyEncoding::kAscii) {
    const Span<const uint8_t> body = bytes.Subspan(header.size);
    AsciiValues values({reinterpret_cast<const char*>(body.data()), body.size()}, header.lines);
    return ReadBody(header, rules, &values);
  }
  BinaryValues values(bytes, header.size, header.encoding == PlyEncoding::kBigEndian);
  return ReadBody(header, rules, &values);
}

}  // namespace lacerta
