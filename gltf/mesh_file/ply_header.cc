#include "mesh_file/ply_header.h"

#include <algorithm>
#include <string_view>

#include "mesh_file/text_scanner.h"

namespace lacerta {
namespace {

struct TypeName {
  const char* name;
  PlyType type;
};
constexpr TypeName kTypeNames[] = {
    {"char", PlyType::kInt8},       {"int8", PlyType::kInt8},       {"uchar", PlyType::kUint8},
    {"uint8", PlyType::kUint8},     {"short", PlyType::kInt16},     {"int16", PlyType::kInt16},
    {"ushort", PlyType::kUint16},   {"uint16", PlyType::kUint16},   {"int", PlyType::kInt32},
    {"int32", PlyType::kInt32},     {"uint", PlyType::kUint32},     {"uint32", PlyType::kUint32},
    {"float", PlyType::kFloat32},   {"float32", PlyType::kFloat32}, {"double", PlyType::kFloat64},
    {"float64", PlyType::kFloat64},
};

Status ParseType(std::string_view word, PlyType* type) {
  for (const TypeName& known : kTypeNames) {
    if (word == known.name) {
      *type = known.type;
      return Status();
    }
  }
  return InvalidData("unknown property type \"" + std::string(word) + "\"");
}

Status ParseFormat(std::string_view words, PlyHeader* header) {
  const std::string_view encoding = TakeWord(&words);
  const std::string_view version = TakeWord(&words);
  if (version != "1.0") return Unsupported("PLY version \"" + std::string(version) + "\"; only 1.0 is known");
  if (encoding == "ascii") {
    header->encoding = PlyEncoding::kAscii;
  } else if (encoding == "binary_little_endian") {
    header->encoding = PlyEncoding::kLittleEndian;
  } else if (encoding == "binary_big_endian") {
    header->encoding = PlyEncoding::kBigEndian;
  } else {
    return InvalidData("unknown PLY encoding \"" + std::string(encoding) + "\"");
  }
  return Status();
}

Status ParseElement(std::string_view words, PlyHeader* header) {
  PlyElement element;
  element.name = TakeWord(&words);
  const std::string_view word = TakeWord(&words);
  int64_t count = 0;
  if (!ParseInt(word, &count) || count < 0) {
    return InvalidData("element \"" + element.name + "\" has the count \"" + std::string(word) + "\"");
  }
  element.count = static_cast<uint64_t>(count);
  for (const PlyElement& other : header->elements) {
    if (other.name == element.name) return InvalidData("element \"" + element.name + "\" is declared twice");
  }
  header->elements.push_back(std::move(element));
  return Status();
}

Status ParseProperty(std::string_view words, PlyHeader* header) {
  if (header->elements.empty()) return InvalidData("a property comes before any element");
  PlyProperty property;
  std::string_view type = TakeWord(&words);
  if (type == "list") {
    property.is_list = true;
    LACERTA_RETURN_IF_ERROR(ParseType(TakeWord(&words), &property.count_type));
    if (!PlyTypeIsInteger(property.count_type)) return InvalidData("the length of a list has to be an integer type");
    type = TakeWord(&words);
  }
  LACERTA_RETURN_IF_ERROR(ParseType(type, &property.type));
  property.name = TakeWord(&words);
  if (property.name.empty()) return InvalidData("a property has no name");
  header->elements.back().properties.push_back(std::move(property));
  return Status();
}

}  // namespace

size_t PlyTypeSize(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      return 8;
  }
  return 8;
}

int PlyElement::Find(const std::vector<std::string>& names) const {
  for (size_t i = 0; i < properties.size(); ++i) {
    if (std::find(names.begin(), names.end(), properties[i].name) != names.end()) return static_cast<int>(i);
  }
  return -1;
}

StatusOr<PlyHeader> ParsePlyHeader(Span<const uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  TextScanner scanner(text);
  PlyHeader header;
  std::string_view line;
  if (!scanner.NextLine(&line) || TakeWord(&line) != "ply")
    return InvalidData("line 1: is not \"ply\"; this is no PLY file");
  bool has_format = false;
  while (scanner.NextLine(&line)) {
    const std::string_view keyword = TakeWord(&line);
    Status status;
    if (keyword == "end_header") {
      if (!has_format) return InvalidData("the header has no format line");
      header.size = text.size() - scanner.bytes_left();
      header.lines = scanner.line();
      return header;
    } else if (keyword == "format") {
      has_format = true;
      status = ParseFormat(line, &header);
    } else if (keyword == "element") {
      status = ParseElement(line, &header);
    } else if (keyword == "property") {
      status = ParseProperty(line, &header);
    } else if (keyword == "comment") {
      if (TakeWord(&line) == "TextureFile") header.textures.push_back(RestOfLine(line));
    } else if (keyword != "obj_info" && !keyword.empty() && !header.elements.empty()) {
      // Before them old Blenders say who wrote the file, without "comment".
      status = InvalidData("unknown header keyword \"" + std::string(keyword.substr(0, 40)) + "\"");
    }
    if (!status.ok()) return status.WithContext(scanner.LineName());
  }
  return InvalidData("the header has no end_header line; the file is truncated");
}

}  // namespace lacerta
