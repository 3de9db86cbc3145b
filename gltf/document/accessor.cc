#include "document/accessor.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "document/alignment.h"

namespace lacerta {
namespace {

// An accessor that only a sparse part fills may be long without bytes to show for it.
constexpr uint64_t kMaxSparseCount = uint64_t{1} << 24;

StatusOr<uint32_t> ParseComponents(const Json& object) {
  const std::string type = AsString(Find(object, "type"));
  if (type == "SCALAR") return uint32_t{1};
  if (type == "VEC2") return uint32_t{2};
  if (type == "VEC3") return uint32_t{3};
  if (type == "VEC4") return uint32_t{4};
  return Unsupported("type \"" + type + "\" is not read as a vertex attribute");
}

// Fails where `count` elements of `size` bytes, `stride` apart, are not all inside so many bytes.
Status CheckElements(uint64_t num_bytes, uint64_t offset, uint64_t stride, uint64_t size, uint64_t count) {
  if (count == 0) return Status();
  if (stride < size) return InvalidData("byteStride " + std::to_string(stride) + " is smaller than an element");
  if (offset > num_bytes || size > num_bytes - offset || (count - 1) > (num_bytes - offset - size) / stride) {
    return InvalidData(std::to_string(count) + " elements from byte " + std::to_string(offset) + " on are more than the bufferView of " +
                       std::to_string(num_bytes) + " bytes holds");
  }
  return Status();
}

// Copies elements, after checking that they are inside `source`.
Status CopyElements(Span<const uint8_t> source, uint64_t offset, uint64_t stride, uint64_t size, uint64_t count,
                    Bytes* target) {
  LACERTA_RETURN_IF_ERROR(CheckElements(source.size(), offset, stride, size, count));
  target->resize(static_cast<size_t>(count * size));
  for (uint64_t i = 0; i < count; ++i) {
    std::memcpy(target->data() + i * size, source.data() + offset + i * stride, static_cast<size_t>(size));
  }
  return Status();
}

// Offset of the 16 or 32 bits of component `index` of the packed bytes.
template <typename T>
T Load(const Bytes& bytes, uint64_t index) {
  T value;
  std::memcpy(&value, bytes.data() + index * sizeof(T), sizeof(T));
  return value;
}

Status ApplySparse(const GltfDocument& document, const Json& sparse, AccessorData* data) {
  LACERTA_ASSIGN_OR_RETURN(const uint64_t count, GetIndex(sparse, "count"));
  const Json* indices = Find(sparse, "indices");
  const Json* values = Find(sparse, "values");
  if (indices == nullptr || values == nullptr) return InvalidData("sparse has no indices or no values");
  AccessorData where;
  LACERTA_ASSIGN_OR_RETURN(where.type, ParseComponentType(*indices));
  if (where.type != ComponentType::kUint8 && where.type != ComponentType::kUint16 &&
      where.type != ComponentType::kUint32) {
    return InvalidData("sparse.indices are not of an unsigned integer type");
  }
  LACERTA_ASSIGN_OR_RETURN(const uint64_t index_view, GetIndex(*indices, "bufferView"));
  LACERTA_ASSIGN_OR_RETURN(const uint64_t index_offset, GetIndex(*indices, "byteOffset", 0));
  LACERTA_ASSIGN_OR_RETURN(const Span<const uint8_t> index_bytes, BufferViewBytes(document, index_view));
  const uint64_t index_size = ComponentSize(where.type);
  LACERTA_RETURN_IF_ERROR(CopyElements(index_bytes, index_offset, index_size, index_size, count, &where.bytes));
  LACERTA_ASSIGN_OR_RETURN(const uint64_t value_view, GetIndex(*values, "bufferView"));
  LACERTA_ASSIGN_OR_RETURN(const uint64_t value_offset, GetIndex(*values, "byteOffset", 0));
  LACERTA_ASSIGN_OR_RETURN(const Span<const uint8_t> value_bytes, BufferViewBytes(document, value_view));
  const uint64_t size = data->components * ComponentSize(data->type);
  Bytes replacements;
  LACERTA_RETURN_IF_ERROR(CopyElements(value_bytes, value_offset, size, size, count, &replacements));
  for (uint64_t i = 0; i < count; ++i) {
    const uint64_t target = where.Uint(i, 0);
    if (target >= data->count) return InvalidData("sparse index " + std::to_string(target) + " is out of range");
    std::memcpy(data->bytes.data() + target * size, replacements.data() + i * size, static_cast<size_t>(size));
  }
  return Status();
}

// What an accessor without any data holds: glTF says zeros, unless an extension brings what is meant.
enum class WithoutData { kRefused, kZeros };

StatusOr<AccessorData> ReadElements(const GltfDocument& document, const Json& accessor, uint32_t components, WithoutData without_data) {
  AccessorData data;
  LACERTA_ASSIGN_OR_RETURN(data.type, ParseComponentType(accessor));
  data.components = components;
  LACERTA_ASSIGN_OR_RETURN(data.count, GetIndex(accessor, "count"));
  data.normalized = IsTrue(Find(accessor, "normalized"));
  const uint64_t size = data.components * ComponentSize(data.type);
  const Json* sparse = Find(accessor, "sparse");
  if (Find(accessor, "bufferView") != nullptr) {
    LACERTA_ASSIGN_OR_RETURN(const uint64_t view, GetIndex(accessor, "bufferView"));
    LACERTA_ASSIGN_OR_RETURN(const Span<const uint8_t> bytes, BufferViewBytes(document, view));
    LACERTA_ASSIGN_OR_RETURN(const uint64_t offset, GetIndex(accessor, "byteOffset", 0));
    LACERTA_ASSIGN_OR_RETURN(const uint64_t stride,
                             GetIndex(*FindElement(document.json, "bufferViews", view), "byteStride", size));
    LACERTA_RETURN_IF_ERROR(CopyElements(bytes, offset, stride, size, data.count, &data.bytes));
  } else if ((sparse != nullptr || without_data == WithoutData::kZeros) && data.count <= kMaxSparseCount) {
    data.bytes.resize(static_cast<size_t>(data.count * size));
  } else {
    return Unsupported("has no bufferView and thus no data");
  }
  if (sparse != nullptr) LACERTA_RETURN_IF_ERROR(ApplySparse(document, *sparse, &data));
  return data;
}

StatusOr<AccessorData> ReadUnnamed(const GltfDocument& document, const Json& accessor) {
  LACERTA_ASSIGN_OR_RETURN(const uint32_t components, ParseComponents(accessor));
  return ReadElements(document, accessor, components, WithoutData::kRefused);
}

StatusOr<AccessorData> ReadUnnamedOrZeros(const GltfDocument& document, const Json& accessor) {
  LACERTA_ASSIGN_OR_RETURN(const uint32_t components, ParseComponents(accessor));
  return ReadElements(document, accessor, components, WithoutData::kZeros);
}

StatusOr<AccessorData> ReadUnnamedMatrices(const GltfDocument& document, const Json& accessor) {
  constexpr uint32_t kComponents = 16;
  LACERTA_ASSIGN_OR_RETURN(const ComponentType type, ParseComponentType(accessor));
  if (type != ComponentType::kFloat || AsString(Find(accessor, "type")) != "MAT4") {
    return Unsupported("does not hold 4 x 4 matrices of floats");
  }
  return ReadElements(document, accessor, kComponents, WithoutData::kRefused);
}

StatusOr<AccessorData> ReadNamed(const GltfDocument& document, uint64_t index,
                                 StatusOr<AccessorData> (*read)(const GltfDocument&, const Json&)) {
  const std::string name = "accessor " + std::to_string(index);
  const Json* accessor = FindElement(document.json, "accessors", index);
  if (accessor == nullptr) return InvalidData(name + " does not exist");
  StatusOr<AccessorData> data = read(document, *accessor);
  if (!data.ok()) return data.status().WithContext(name);
  return data;
}

// part, size, count: as of VisitParts.
Status CheckPart(const GltfDocument& document, const Json& part, uint64_t size, uint64_t count) {
  const std::optional<uint64_t> view = AsIndex(Find(part, "bufferView"));
  if (!view.has_value() || size == 0) return Status();
  const StatusOr<Span<const uint8_t>> bytes = BufferViewBytes(document, *view);
  if (!bytes.ok()) return bytes.status().code() == StatusCode::kUnsupported ? Status() : bytes.status();
  LACERTA_ASSIGN_OR_RETURN(const uint64_t offset, GetIndex(part, "byteOffset", 0));
  LACERTA_ASSIGN_OR_RETURN(const uint64_t stride, GetIndex(*FindElement(document.json, "bufferViews", *view), "byteStride", size));
  return CheckElements(bytes.value().size(), offset, stride, size, count);
}

Status CheckParts(const GltfDocument& document, const Json& accessor) {
  LACERTA_RETURN_IF_ERROR(GetIndex(accessor, "count").status());
  if (const Json* sparse = Find(accessor, "sparse"); sparse != nullptr) LACERTA_RETURN_IF_ERROR(GetIndex(*sparse, "count").status());
  Status status;
  VisitParts(accessor, [&](const Json& part, uint64_t size, uint64_t count) {
    if (status.ok()) status = CheckPart(document, part, size, count);
  });
  return status;
}

}  // namespace

StatusOr<ComponentType> ParseComponentType(const Json& object) {
  LACERTA_ASSIGN_OR_RETURN(const uint64_t code, GetIndex(object, "componentType"));
  switch (code) {
    case 5120:
    case 5121:
    case 5122:
    case 5123:
    case 5125:
    case 5126:
      return static_cast<ComponentType>(code);
    default:
      return InvalidData("componentType " + std::to_string(code) + " does not exist");
  }
}

size_t ComponentSize(ComponentType type) {
  switch (type) {
    case ComponentType::kInt8:
    case ComponentType::kUint8:
      return 1;
    case ComponentType::kInt16:
    case ComponentType::kUint16:
      return 2;
    case ComponentType::kUint32:
    case ComponentType::kFloat:
      return 4;
  }
  return 4;
}

uint64_t ComponentSizeOf(const Json& object) {
  const StatusOr<ComponentType> type = ParseComponentType(object);
  return type.ok() ? ComponentSize(type.value()) : 0;
}

// glTF 2.0 section 3.6.2.4: the columns of matrices begin at multiples of four bytes.
uint64_t ElementSize(const Json& accessor) {
  const uint64_t component = ComponentSizeOf(accessor);
  const std::string type = AsString(Find(accessor, "type"));
  if (type == "SCALAR") return component;
  const uint64_t order = type.size() == 4 && type[3] >= '2' && type[3] <= '4' ? static_cast<uint64_t>(type[3] - '0') : 0;
  if (type.rfind("VEC", 0) == 0) return order * component;
  if (type.rfind("MAT", 0) == 0) return order * Aligned(order * component);
  return 0;
}

float AccessorData::Float(uint64_t element, uint32_t component) const {
  const uint64_t i = element * components + component;
  switch (type) {
    case ComponentType::kFloat:
      return Load<float>(bytes, i);
    case ComponentType::kUint8:
      return normalized ? static_cast<float>(Load<uint8_t>(bytes, i)) / 255.0f : Load<uint8_t>(bytes, i);
    case ComponentType::kInt8:
      return normalized ? std::max(static_cast<float>(Load<int8_t>(bytes, i)) / 127.0f, -1.0f) : Load<int8_t>(bytes, i);
    case ComponentType::kUint16:
      return normalized ? static_cast<float>(Load<uint16_t>(bytes, i)) / 65535.0f : Load<uint16_t>(bytes, i);
    case ComponentType::kInt16:
      return normalized ? std::max(static_cast<float>(Load<int16_t>(bytes, i)) / 32767.0f, -1.0f)
                        : Load<int16_t>(bytes, i);
    case ComponentType::kUint32:
      return static_cast<float>(Load<uint32_t>(bytes, i));
  }
  return 0.0f;
}

uint32_t AccessorData::Uint(uint64_t element, uint32_t component) const {
  const uint64_t i = element * components + component;
  if (type == ComponentType::kUint8) return Load<uint8_t>(bytes, i);
  if (type == ComponentType::kUint16) return Load<uint16_t>(bytes, i);
  return Load<uint32_t>(bytes, i);
}

AccessorData MakeFloatAccessor(const std::vector<float>& values, uint32_t components) {
  AccessorData data;
  data.components = components;
  data.count = values.size() / components;
  data.bytes.resize(values.size() * sizeof(float));
  if (!values.empty()) std::memcpy(data.bytes.data(), values.data(), data.bytes.size());
  return data;
}

AccessorData MakeFloatAccessor(const std::vector<Vec3f>& values) {
  std::vector<float> components;
  components.reserve(3 * values.size());
  for (const Vec3f& value : values) components.insert(components.end(), {value.x, value.y, value.z});
  return MakeFloatAccessor(components, 3);
}

Vec3f VectorAt(const AccessorData& data, uint64_t element) { return {data.Float(element, 0), data.Float(element, 1), data.Float(element, 2)}; }

std::vector<Vec3f> VectorsOf(const AccessorData& data) {
  std::vector<Vec3f> vectors;
  vectors.reserve(static_cast<size_t>(data.count));
  for (uint64_t i = 0; i < data.count; ++i) vectors.push_back(VectorAt(data, i));
  return vectors;
}

std::vector<ComponentRange> ComponentRanges(const AccessorData& data) {
  std::vector<ComponentRange> ranges;
  for (uint32_t c = 0; c < data.components && data.count > 0; ++c) {
    ComponentRange range{data.Float(0, c), data.Float(0, c)};
    for (uint64_t i = 1; i < data.count; ++i) {
      range.low = std::min(range.low, data.Float(i, c));
      range.high = std::max(range.high, data.Float(i, c));
    }
    ranges.push_back(range);
  }
  return ranges;
}

AccessorData MakeIndexAccessor(const std::vector<Triangle>& triangles, uint64_t num_vertices) {
  AccessorData data;
  // The largest value of a type is reserved for primitive restart.
  data.type = num_vertices <= std::numeric_limits<uint16_t>::max() ? ComponentType::kUint16 : ComponentType::kUint32;
  data.count = 3 * triangles.size();
  const size_t size = ComponentSize(data.type);
  data.bytes.reserve(static_cast<size_t>(data.count) * size);
  for (const Triangle& triangle : triangles) {
    for (const uint32_t index : triangle) {
      for (size_t byte = 0; byte < size; ++byte) data.bytes.push_back(static_cast<uint8_t>(index >> (8 * byte)));
    }
  }
  return data;
}

StatusOr<AccessorData> ReadAccessor(const GltfDocument& document, uint64_t index) {
  return ReadNamed(document, index, ReadUnnamed);
}

StatusOr<AccessorData> ReadAccessorOrZeros(const GltfDocument& document, uint64_t index) {
  return ReadNamed(document, index, ReadUnnamedOrZeros);
}

StatusOr<AccessorData> ReadMatrices(const GltfDocument& document, uint64_t index) {
  return ReadNamed(document, index, ReadUnnamedMatrices);
}

Status CheckAccessor(const GltfDocument& document, uint64_t index) {
  const std::string name = "accessor " + std::to_string(index);
  const Json* accessor = FindElement(document.json, "accessors", index);
  if (accessor == nullptr) return InvalidData(name + " does not exist");
  return CheckParts(document, *accessor).WithContext(name);
}

}  // namespace lacerta
