#include "document/draco_primitive.h"

#include <draco/mesh/mesh.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <utility>

#include "draco/stock_stream.h"
#include "lacerta/decoder.h"

namespace lacerta {
namespace {

StatusOr<ComponentType> FromDracoDataType(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return ComponentType::kInt8;
    case draco::DT_UINT8:
      return ComponentType::kUint8;
    case draco::DT_INT16:
      return ComponentType::kInt16;
    case draco::DT_UINT16:
      return ComponentType::kUint16;
    case draco::DT_UINT32:
      return ComponentType::kUint32;
    case draco::DT_FLOAT32:
      return ComponentType::kFloat;
    default:
      return Unsupported("the Draco stream holds an attribute of a type that glTF does not have");
  }
}

// Draco throws nothing itself, but its containers do when a damaged stream asks for too much memory.
StatusOr<std::unique_ptr<draco::Mesh>> DecodeStock(Span<const uint8_t> bytes, const DecodeLimits& limits) {
  try {
    LACERTA_ASSIGN_OR_RETURN(StockMesh stock, DecodeStockStream(bytes, limits));
    return std::move(stock.mesh);
  } catch (const std::exception& error) {
    return InvalidData(std::string("the Draco stream is damaged (") + error.what() + ")");
  }
}

StatusOr<AccessorData> CopyAttribute(const draco::PointAttribute& attribute, uint32_t num_points) {
  AccessorData data;
  LACERTA_ASSIGN_OR_RETURN(data.type, FromDracoDataType(attribute.data_type()));
  data.components = static_cast<uint32_t>(attribute.num_components());
  if (data.components < 1 || data.components > 4) return Unsupported("a Draco attribute has more than four components");
  data.normalized = attribute.normalized();
  data.count = num_points;
  const size_t size = data.components * ComponentSize(data.type);
  if (static_cast<size_t>(attribute.byte_stride()) < size)
    return InvalidData("a Draco attribute has too small a stride");
  data.bytes.resize(size * num_points);
  for (uint32_t p = 0; p < num_points; ++p) {
    const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(p));
    if (value.value() >= attribute.size()) return InvalidData("a Draco attribute has fewer values than points");
    std::copy_n(attribute.GetAddress(value), size, data.bytes.begin() + static_cast<std::ptrdiff_t>(p * size));
  }
  return data;
}

StatusOr<std::vector<Triangle>> CopyTriangles(const draco::Mesh& mesh) {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.num_faces());
  for (uint32_t f = 0; f < mesh.num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(f));
    Triangle triangle;
    for (size_t corner = 0; corner < 3; ++corner) {
      triangle[corner] = face[corner].value();
      if (triangle[corner] >= mesh.num_points()) {
        return InvalidData("the Draco stream has an index out of range in triangle " + std::to_string(f));
      }
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

StatusOr<Primitive> ToPrimitive(const draco::Mesh& mesh, const std::vector<DracoAttributeId>& ids) {
  Primitive primitive;
  primitive.num_vertices = mesh.num_points();
  LACERTA_ASSIGN_OR_RETURN(primitive.triangles, CopyTriangles(mesh));
  for (const DracoAttributeId& id : ids) {
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id.id);
    if (attribute == nullptr) {
      return InvalidData("the Draco stream has no attribute " + std::to_string(id.id) + " for " + id.name);
    }
    LACERTA_ASSIGN_OR_RETURN(AccessorData data, CopyAttribute(*attribute, mesh.num_points()));
    primitive.attributes.push_back({id.name, std::move(data)});
  }
  return primitive;
}

}  // namespace

StatusOr<Primitive> DecodeDracoPrimitive(Span<const uint8_t> bytes, const std::vector<DracoAttributeId>& ids,
                                         const DecodeLimits& limits) {
  LACERTA_ASSIGN_OR_RETURN(const std::unique_ptr<draco::Mesh> mesh, DecodeStock(bytes, limits));
  return ToPrimitive(*mesh, ids);
}

StatusOr<std::vector<std::string>> DracoAttributeKinds(Span<const uint8_t> bytes) {
  LACERTA_ASSIGN_OR_RETURN(const std::unique_ptr<draco::Mesh> mesh, DecodeStock(bytes, DecodeLimits{}));
  std::vector<std::string> kinds;
  for (int i = 0; i < mesh->num_attributes(); ++i) {
    const draco::GeometryAttribute::Type type = mesh->attribute(i)->attribute_type();
    if (type != draco::GeometryAttribute::POSITION) kinds.push_back(draco::GeometryAttribute::TypeToString(type));
  }
  return kinds;
}

StatusOr<uint32_t> DracoPositionId(Span<const uint8_t> bytes) {
  LACERTA_ASSIGN_OR_RETURN(const std::unique_ptr<draco::Mesh> mesh, DecodeStock(bytes, DecodeLimits{}));
  const draco::PointAttribute* position = mesh->GetNamedAttribute(draco::GeometryAttribute::POSITION);
  if (position == nullptr) return InvalidData("the Draco stream has no positions");
  return position->unique_id();
}

StatusOr<DracoShape> DecodeDracoShape(Span<const uint8_t> bytes) {
  DracoShape shape;
  LACERTA_ASSIGN_OR_RETURN(const uint32_t id, DracoPositionId(bytes));
  shape.ids = {{"POSITION", id}};
  LACERTA_ASSIGN_OR_RETURN(shape.primitive, DecodeDracoPrimitive(bytes, shape.ids, DecodeLimits{}));
  return shape;
}

}  // namespace lacerta
