#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

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
  uint64_t bytes_left() const { return scanner_.bytes_left(); }
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
  uint64_t bytes_left() const { return bytes_.size() - offset_; }
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
  return Status();
}

template <typename Values>
Status ReadVertices(const PlyElement& element, Values* values, TriangleMesh* mesh) {
  int axis_property[3];
  const char* const axes[3] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    axis_property[axis] = element.Find({axes[axis]});
    if (axis_property[axis] < 0 || element.properties[static_cast<size_t>(axis_property[axis])].is_list) {
      return InvalidData(std::string("the vertices have no property ") + axes[axis]);
    }
  }
  mesh->positions.reserve(static_cast<size_t>(element.count));
  for (uint64_t v = 0; v < element.count; ++v) {
    double xyz[3] = {};
    LACERTA_RETURN_IF_ERROR(ReadRow(element, values, [&](size_t property, double value) {
      for (int axis = 0; axis < 3; ++axis) {
        if (static_cast<int>(property) == axis_property[axis]) xyz[axis] = value;
      }
    }));
    LACERTA_RETURN_IF_ERROR(AppendPosition(xyz[0], xyz[1], xyz[2], mesh));
  }
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

// Calls done(row, vertices) for each row. vertices: -1 for what no index can be.
template <typename Values, typename Done>
Status ReadIndexLists(const PlyElement& element, Values* values, const Done& done) {
  LACERTA_ASSIGN_OR_RETURN(const size_t indices, FindIndices(element));
  std::vector<int64_t> vertices;
  for (uint64_t row = 0; row < element.count; ++row) {
    vertices.clear();
    LACERTA_RETURN_IF_ERROR(ReadRow(element, values, [&](size_t property, double value) {
      // A double holds every index that can be in range.
      if (property == indices) vertices.push_back(std::abs(value) < 1e15 ? static_cast<int64_t>(value) : -1);
    }));
    LACERTA_RETURN_IF_ERROR(done(row, vertices));
  }
  return Status();
}

template <typename Values>
Status ReadFaces(const PlyElement& element, uint64_t num_vertices, Values* values, TriangleMesh* mesh) {
  mesh->triangles.reserve(static_cast<size_t>(element.count));
  return ReadIndexLists(element, values,
                        [&](uint64_t face, const std::vector<int64_t>& corners) { return AppendPolygon(corners, num_vertices, face, mesh); });
}

// Strips as Stanford's tools write them: every vertex makes a triangle with the two before it, each second one turned round; -1 begins
// a new strip.
template <typename Values>
Status ReadStrips(const PlyElement& element, uint64_t num_vertices, Values* values, TriangleMesh* mesh) {
  return ReadIndexLists(element, values, [&](uint64_t row, const std::vector<int64_t>& vertices) {
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
Status ReadBody(const PlyHeader& header, Values* values, TriangleMesh* mesh) {
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
      status = ReadVertices(element, values, mesh);
    } else if (element.name == "face") {
      status = ReadFaces(element, num_vertices, values, mesh);
    } else if (element.name == "tristrips") {
      status = ReadStrips(element, num_vertices, values, mesh);
    } else {
      status = SkipRows(element, values);
    }
    if (!status.ok()) return status.WithContext(values->Where());
  }
  if (mesh->positions.size() != num_vertices) return InvalidData("the vertices have no properties");
  return Status();
}

}  // namespace

StatusOr<TriangleMesh> ParsePly(Span<const uint8_t> bytes) {
  LACERTA_ASSIGN_OR_RETURN(const PlyHeader header, ParsePlyHeader(bytes));
  TriangleMesh mesh;
  if (header.encoding == PlyEncoding::kAscii) {
    const Span<const uint8_t> body = bytes.Subspan(header.size);
    AsciiValues values({reinterpret_cast<const char*>(body.data()), body.size()}, header.lines);
    LACERTA_RETURN_IF_ERROR(ReadBody(header, &values, &mesh));
  } else {
    BinaryValues values(bytes, header.size, header.encoding == PlyEncoding::kBigEndian);
    LACERTA_RETURN_IF_ERROR(ReadBody(header, &values, &mesh));
  }
  LACERTA_RETURN_IF_ERROR(CheckNotEmpty(mesh));
  return mesh;
}

}  // namespace lacerta
