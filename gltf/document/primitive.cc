#include "document/primitive.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "document/draco_primitive.h"

namespace lacerta {
namespace {

constexpr uint64_t kTriangles = 4;
constexpr uint64_t kTriangleFan = 6;  // 5 is a strip

std::vector<Triangle> Assemble(const std::vector<uint32_t>& corners, uint64_t mode) {
  std::vector<Triangle> triangles;
  if (mode == kTriangles) {
    triangles.reserve(corners.size() / 3);
    for (size_t i = 0; i + 2 < corners.size(); i += 3)
      triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    return triangles;
  }
  for (size_t i = 2; i < corners.size(); ++i) {
    if (mode == kTriangleFan) {
      triangles.push_back({corners[i - 1], corners[i], corners[0]});
    } else {
      const size_t odd = i % 2;  // every other triangle of a strip is turned around
      triangles.push_back({corners[i - 2], corners[i - 1 + odd], corners[i - odd]});
    }
  }
  return triangles;
}

StatusOr<std::vector<uint32_t>> ReadCorners(const GltfDocument& document, const Json& primitive,
                                            uint64_t num_vertices) {
  std::vector<uint32_t> corners;
  if (Find(primitive, "indices") == nullptr) {
    corners.resize(static_cast<size_t>(num_vertices));
    for (size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<uint32_t>(i);
    return corners;
  }
  LACERTA_ASSIGN_OR_RETURN(const uint64_t accessor, GetIndex(primitive, "indices"));
  LACERTA_ASSIGN_OR_RETURN(const AccessorData data, ReadAccessor(document, accessor));
  const std::string name = "accessor " + std::to_string(accessor);
  const bool is_unsigned =
      data.type == ComponentType::kUint8 || data.type == ComponentType::kUint16 || data.type == ComponentType::kUint32;
  if (data.components != 1 || !is_unsigned) return InvalidData(name + ": indices have to be unsigned integer scalars");
  corners.reserve(static_cast<size_t>(data.count));
  for (uint64_t i = 0; i < data.count; ++i) {
    const uint32_t index = data.Uint(i, 0);
    if (index >= num_vertices) {
      return InvalidData(name + ": index " + std::to_string(index) + " at position " + std::to_string(i) +
                         " is out of range, the primitive has " + std::to_string(num_vertices) + " vertices");
    }
    corners.push_back(index);
  }
  return corners;
}

// Legal: an extension that is not known here may tell where the vertices are.
Status NoPosition() { return Unsupported("has no POSITION"); }

// Appends what is in core accessors of the attributes that `primitive` has not got yet.
Status ReadAccessors(const GltfDocument& document, const Json& attributes, Primitive* primitive) {
  for (const auto& [name, index] : attributes.items()) {
    if (primitive->Find(name) != nullptr) continue;
    const std::optional<uint64_t> accessor = AsIndex(&index);
    if (!accessor.has_value()) return InvalidData("attribute " + name + " is no accessor index");
    // Positions that are nowhere are those of a base that was left out.
    StatusOr<AccessorData> data = name == "POSITION" ? ReadAccessor(document, *accessor) : ReadAccessorOrZeros(document, *accessor);
    if (!data.ok()) return data.status().WithContext(name);
    primitive->attributes.push_back({name, std::move(data).value()});
  }
  return Status();
}

StatusOr<Primitive> ReadPlain(const GltfDocument& document, const Json& primitive, uint64_t mode) {
  Primitive result;
  const Json* attributes = Find(primitive, "attributes");
  if (attributes == nullptr || !attributes->is_object()) return InvalidData("has no attributes");
  LACERTA_RETURN_IF_ERROR(ReadAccessors(document, *attributes, &result));
  const Attribute* position = result.Find("POSITION");
  if (position == nullptr) return NoPosition();
  result.num_vertices = position->data.count;
  for (const Attribute& attribute : result.attributes) {
    if (attribute.data.count != result.num_vertices) {
      return InvalidData(attribute.name + ": has " + std::to_string(attribute.data.count) + " elements, POSITION has " +
                         std::to_string(result.num_vertices));
    }
  }
  LACERTA_ASSIGN_OR_RETURN(const std::vector<uint32_t> corners, ReadCorners(document, primitive, result.num_vertices));
  result.triangles = Assemble(corners, mode);
  return result;
}

// Whether integers stand for fractions is what the accessors say: streams often do not tell.
void SetNormalized(const GltfDocument& document, const Json& primitive, Primitive* decoded) {
  const Json* attributes = Find(primitive, "attributes");
  if (attributes == nullptr || !attributes->is_object()) return;
  for (Attribute& attribute : decoded->attributes) {
    const std::optional<uint64_t> index = AsIndex(Find(*attributes, attribute.name.c_str()));
    const Json* accessor = index.has_value() ? FindElement(document.json, "accessors", *index) : nullptr;
    if (accessor != nullptr) attribute.data.normalized = IsTrue(Find(*accessor, "normalized"));
  }
}

StatusOr<Primitive> ReadDraco(const GltfDocument& document, const Json& primitive, const Json& extension, const DecodeLimits& limits) {
  LACERTA_ASSIGN_OR_RETURN(const uint64_t view, GetIndex(extension, "bufferView"));
  LACERTA_ASSIGN_OR_RETURN(const Span<const uint8_t> bytes, BufferViewBytes(document, view));
  const Json* attributes = Find(extension, "attributes");
  if (attributes == nullptr || !attributes->is_object())
    return InvalidData("KHR_draco_mesh_compression has no attributes");
  std::vector<DracoAttributeId> ids;
  for (const auto& [name, id] : attributes->items()) {
    const std::optional<uint64_t> index = AsIndex(&id);
    if (!index.has_value() || *index > std::numeric_limits<uint32_t>::max()) {
      return InvalidData("KHR_draco_mesh_compression: attribute " + name + " is no attribute id");
    }
    ids.push_back({name, static_cast<uint32_t>(*index)});
  }
  StatusOr<Primitive> decoded = DecodeDracoPrimitive(bytes, ids, limits);
  if (!decoded.ok()) return decoded.status().WithContext("bufferView " + std::to_string(view));
  Primitive& result = decoded.value();
  SetNormalized(document, primitive, &result);
  // What the stream has not got is beside it, for the vertices that it decodes to.
  const size_t num_decoded = result.attributes.size();
  const Json* all = Find(primitive, "attributes");
  if (all != nullptr && all->is_object()) LACERTA_RETURN_IF_ERROR(ReadAccessors(document, *all, &result));
  for (size_t i = num_decoded; i < result.attributes.size(); ++i) {
    const Attribute& beside = result.attributes[i];
    if (beside.data.count != result.num_vertices) {
      return Unsupported("has " + std::to_string(beside.data.count) + " elements of " + beside.name + " beside a Draco stream of " +
                         std::to_string(result.num_vertices) + " vertices");
    }
  }
  return decoded;
}

// accessor: of the positions, for messages.
Status CheckFinite(const Primitive& primitive, const std::string& accessor) {
  const Attribute* position = primitive.Find("POSITION");
  for (uint64_t v = 0; v < primitive.num_vertices; ++v) {
    for (uint32_t axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(position->data.Float(v, axis))) {
        return InvalidData(accessor + "POSITION: vertex " + std::to_string(v) + " is not finite; repair or remove it");
      }
    }
  }
  return Status();
}

}  // namespace

const Attribute* Primitive::Find(const std::string& name) const {
  const auto found =
      std::find_if(attributes.begin(), attributes.end(), [&](const Attribute& a) { return a.name == name; });
  return found == attributes.end() ? nullptr : &*found;
}

std::vector<const Primitive*> PointersTo(const std::vector<Primitive>& primitives) {
  std::vector<const Primitive*> pointers;
  pointers.reserve(primitives.size());
  for (const Primitive& primitive : primitives) pointers.push_back(&primitive);
  return pointers;
}

StatusOr<Primitive> ReadUncheckedPrimitive(const GltfDocument& document, const Json& primitive, const DecodeLimits& limits) {
  LACERTA_ASSIGN_OR_RETURN(const uint64_t mode, GetIndex(primitive, "mode", kTriangles));
  if (mode < kTriangles || mode > kTriangleFan) return Unsupported("holds points or lines, no triangles");
  const Json* draco = FindExtension(primitive, "KHR_draco_mesh_compression");
  StatusOr<Primitive> result =
      draco != nullptr ? ReadDraco(document, primitive, *draco, limits) : ReadPlain(document, primitive, mode);
  if (!result.ok()) return result.status();
  const Attribute* position = result.value().Find("POSITION");
  if (position == nullptr) return NoPosition();
  if (position->data.components != 3) return InvalidData("POSITION is not of type VEC3");
  std::vector<Attribute>& attributes = result.value().attributes;
  std::stable_partition(attributes.begin(), attributes.end(), [](const Attribute& a) { return a.name == "POSITION"; });
  return result;
}

StatusOr<Primitive> ReadPrimitive(const GltfDocument& document, const Json& primitive, const DecodeLimits& limits) {
  LACERTA_ASSIGN_OR_RETURN(Primitive result, ReadUncheckedPrimitive(document, primitive, limits));
  const Json* attributes = Find(primitive, "attributes");
  const std::optional<uint64_t> accessor = attributes == nullptr ? std::nullopt : AsIndex(Find(*attributes, "POSITION"));
  LACERTA_RETURN_IF_ERROR(CheckFinite(result, accessor.has_value() ? "accessor " + std::to_string(*accessor) + ": " : ""));
  return result;
}

TriangleMesh Surface(const Primitive& primitive) {
  return TriangleMesh{VectorsOf(primitive.Find("POSITION")->data), primitive.triangles};
}

}  // namespace lacerta
