#include "document/draco_primitive.h"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <utility>

#include "draco/stock_stream.h"
#include "lacerta/decoder.h"

namespace lacerta {
namespace {

constexpr int kNormalBits = 10;
constexpr int kTextureBits = 12;

bool BeginsWith(const std::string& text, const char* prefix) { return text.rfind(prefix, 0) == 0; }

draco::GeometryAttribute::Type DracoType(const std::string& name) {
  if (name == "POSITION") return draco::GeometryAttribute::POSITION;
  if (name == "NORMAL") return draco::GeometryAttribute::NORMAL;
  if (BeginsWith(name, "TEXCOORD_")) return draco::GeometryAttribute::TEX_COORD;
  if (BeginsWith(name, "COLOR_")) return draco::GeometryAttribute::COLOR;
  return draco::GeometryAttribute::GENERIC;
}

draco::DataType DracoDataType(ComponentType type) {
  switch (type) {
    case ComponentType::kInt8:
      return draco::DT_INT8;
    case ComponentType::kUint8:
      return draco::DT_UINT8;
    case ComponentType::kInt16:
      return draco::DT_INT16;
    case ComponentType::kUint16:
      return draco::DT_UINT16;
    case ComponentType::kUint32:
      return draco::DT_UINT32;
    case ComponentType::kFloat:
      return draco::DT_FLOAT32;
  }
  return draco::DT_INVALID;
}

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

StatusOr<std::unique_ptr<draco::Mesh>> ToDraco(const Primitive& primitive) {
  auto mesh = std::make_unique<draco::Mesh>();
  mesh->set_num_points(static_cast<uint32_t>(primitive.num_vertices));
  mesh->SetNumFaces(primitive.triangles.size());
  for (size_t f = 0; f < primitive.triangles.size(); ++f) {
    const Triangle& t = primitive.triangles[f];
    mesh->SetFace(draco::FaceIndex(static_cast<uint32_t>(f)),
                  {{draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])}});
  }
  for (const Attribute& attribute : primitive.attributes) {
    const AccessorData& data = attribute.data;
    const size_t size = data.components * ComponentSize(data.type);
    draco::GeometryAttribute description;
    description.Init(DracoType(attribute.name), nullptr, static_cast<int8_t>(data.components), DracoDataType(data.type),
                     data.normalized, static_cast<int64_t>(size), 0);
    const int id = mesh->AddAttribute(description, true, static_cast<uint32_t>(data.count));
    if (id < 0) return Unsupported("Draco refuses the attribute " + attribute.name);
    mesh->attribute(id)->buffer()->Write(0, data.bytes.data(), data.bytes.size());
  }
  if (!mesh->DeduplicateAttributeValues()) return Unsupported("Draco refuses the attributes");
  mesh->DeduplicatePointIds();
  return mesh;
}

int QuantizationBits(const Attribute& attribute) {
  if (attribute.data.type != ComponentType::kFloat) return 0;
  if (attribute.name == "NORMAL" || attribute.name == "TANGENT") return kNormalBits;
  for (const char* prefix : {"TEXCOORD_", "COLOR_", "WEIGHTS_"}) {
    if (BeginsWith(attribute.name, prefix)) return kTextureBits;
  }
  return 0;
}

bool AllFinite(const Attribute& attribute) {
  if (attribute.data.type != ComponentType::kFloat) return true;
  for (uint64_t i = 0; i < attribute.data.count; ++i) {
    for (uint32_t c = 0; c < attribute.data.components; ++c) {
      if (!std::isfinite(attribute.data.Float(i, c))) return false;
    }
  }
  return true;
}

StatusOr<Bytes> EncodeStock(const draco::Mesh& mesh, const Primitive& primitive, const PositionGrid& grid) {
  draco::ExpertEncoder encoder(mesh);
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetSpeedOptions(0, 0);
  for (size_t i = 0; i < primitive.attributes.size(); ++i) {
    const Attribute& attribute = primitive.attributes[i];
    const int id = static_cast<int>(i);
    if (attribute.name == "POSITION" && attribute.data.type == ComponentType::kFloat && !grid.shareable) {
      encoder.SetAttributeQuantization(id, grid.bits);
    } else if (attribute.name == "POSITION" && attribute.data.type == ComponentType::kFloat) {
      const float origin[3] = {grid.origin.x, grid.origin.y, grid.origin.z};
      encoder.SetAttributeExplicitQuantization(id, grid.bits, 3, origin, grid.range);
    } else if (const int bits = QuantizationBits(attribute); bits > 0) {
      encoder.SetAttributeQuantization(id, bits);
    }
  }
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeToBuffer(&buffer);
  if (!status.ok()) return Unsupported("Draco cannot encode the primitive (" + status.error_msg_string() + ")");
  return Bytes(buffer.data(), buffer.data() + buffer.size());
}

}  // namespace

StatusOr<Primitive> DecodeDracoPrimitive(Span<const uint8_t> bytes, const std::vector<DracoAttributeId>& ids,
                                         const DecodeLimits& limits) {
  LACERTA_ASSIGN_OR_RETURN(const std::unique_ptr<draco::Mesh> mesh, DecodeStock(bytes, limits));
  return ToPrimitive(*mesh, ids);
}

StatusOr<uint32_t> DracoPositionId(Span<const uint8_t> bytes) {
  LACERTA_ASSIGN_OR_RETURN(const std::unique_ptr<draco::Mesh> mesh, DecodeStock(bytes, DecodeLimits{}));
  const draco::PointAttribute* position = mesh->GetNamedAttribute(draco::GeometryAttribute::POSITION);
  if (position == nullptr) return InvalidData("the Draco stream has no positions");
  return position->unique_id();
}

PositionGrid MakePositionGrid(const Vec3f& min, const Vec3f& max, double psnr) {
  constexpr float kGridMargin = 2e-6f;        // model units
  constexpr double kLeastSharedRange = 1e-2;  // below, the margin would cost precision
  constexpr int kLeastBits = 8;
  constexpr int kMostBits = 24;  // beyond, floats have no more bits to keep
  const Vec3d extent = Vec3Cast<double>(max) - Vec3Cast<double>(min);
  PositionGrid grid;
  const double range = std::max({extent.x, extent.y, extent.z});
  // Draco's options keep six decimals of these numbers, so they are widened to what six decimals can say.
  grid.shareable = range >= kLeastSharedRange;
  grid.origin = min - Vec3f{kGridMargin, kGridMargin, kGridMargin};
  grid.range = range > 0.0 ? static_cast<float>(range) + 4 * kGridMargin : 1.0f;
  grid.bits = kLeastBits;
  const auto psnr_of = [&](int bits) {
    return 20.0 * std::log10(2.0 * Norm(extent) * (std::pow(2.0, bits) - 1.0) / grid.range);
  };
  while (grid.bits < kMostBits && psnr_of(grid.bits) < psnr) ++grid.bits;
  return grid;
}

StatusOr<DracoEncoded> EncodeDracoPrimitive(const Primitive& primitive, const PositionGrid& grid) {
  if (primitive.triangles.empty()) return Unsupported("holds no triangles");
  for (const Attribute& attribute : primitive.attributes) {
    if (!AllFinite(attribute)) return Unsupported(attribute.name + " holds values that are not finite");
  }
  LACERTA_ASSIGN_OR_RETURN(const std::unique_ptr<draco::Mesh> mesh, ToDraco(primitive));
  DracoEncoded result;
  LACERTA_ASSIGN_OR_RETURN(result.bytes, EncodeStock(*mesh, primitive, grid));
  for (size_t i = 0; i < primitive.attributes.size(); ++i) {
    result.ids.push_back({primitive.attributes[i].name, mesh->attribute(static_cast<int>(i))->unique_id()});
  }
  LACERTA_ASSIGN_OR_RETURN(result.decoded, DecodeDracoPrimitive(result.bytes, result.ids, DecodeLimits{}));
  if (result.decoded.triangles.empty()) return Unsupported("holds only degenerate triangles");
  return result;
}

}  // namespace lacerta
