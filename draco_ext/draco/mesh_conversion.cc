#include "draco/mesh_conversion.h"

#include <draco/attributes/geometry_attribute.h>
#include <draco/attributes/point_attribute.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace lacerta {
namespace {

constexpr size_t kMaxCount = std::numeric_limits<int32_t>::max() / 3;  // Draco numbers corners with 32 bits

bool IsFinite(const Vec3f& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

// Reads value `index` of three components of type T. Draco's ConvertValue is not used: it reads the attribute's
// `normalized` flag, a bool that a damaged stream sets to 255.
template <typename T>
Vec3f ReadAs(const draco::PointAttribute& attribute, draco::AttributeValueIndex index) {
  std::array<T, 3> value{};
  attribute.GetValue(index, value.data());
  return {static_cast<float>(value[0]), static_cast<float>(value[1]), static_cast<float>(value[2])};
}

using Reader = Vec3f (*)(const draco::PointAttribute&, draco::AttributeValueIndex);

// How positions of a type are read, or nullptr.
Reader PositionReader(draco::DataType type) {
  switch (type) {
    case draco::DT_FLOAT32:
      return &ReadAs<float>;
    case draco::DT_FLOAT64:
      return &ReadAs<double>;
    case draco::DT_INT8:
      return &ReadAs<int8_t>;
    case draco::DT_UINT8:
      return &ReadAs<uint8_t>;
    case draco::DT_INT16:
      return &ReadAs<int16_t>;
    case draco::DT_UINT16:
      return &ReadAs<uint16_t>;
    case draco::DT_INT32:
      return &ReadAs<int32_t>;
    case draco::DT_UINT32:
      return &ReadAs<uint32_t>;
    default:
      return nullptr;
  }
}

}  // namespace

Status CheckEncodable(const TriangleMesh& mesh) {
  if (mesh.positions.empty() || mesh.triangles.empty()) {
    return InvalidData("mesh has " + std::to_string(mesh.positions.size()) + " vertices and " +
                       std::to_string(mesh.triangles.size()) + " triangles; at least one of each is needed");
  }
  if (mesh.positions.size() > kMaxCount || mesh.triangles.size() > kMaxCount) {
    return InvalidData("mesh has more than " + std::to_string(kMaxCount) + " vertices or triangles; split it");
  }
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    if (!IsFinite(mesh.positions[v])) return InvalidData("position of vertex " + std::to_string(v) + " is not finite");
  }
  for (size_t f = 0; f < mesh.triangles.size(); ++f) {
    for (const uint32_t v : mesh.triangles[f]) {
      if (v >= mesh.positions.size()) {
        return InvalidData("triangle " + std::to_string(f) + " refers to vertex " + std::to_string(v) + " of " +
                           std::to_string(mesh.positions.size()));
      }
    }
  }
  return {};
}

void FillDracoMesh(const TriangleMesh& mesh, draco::Mesh* result) {
  const auto num_vertices = static_cast<uint32_t>(mesh.positions.size());
  result->set_num_points(num_vertices);
  draco::GeometryAttribute description;
  description.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 3 * sizeof(float), 0);
  const int id = result->AddAttribute(description, /*identity_mapping=*/true, num_vertices);
  draco::PointAttribute* const positions = result->attribute(id);
  for (uint32_t v = 0; v < num_vertices; ++v) {
    const std::array<float, 3> p = {mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z};
    positions->SetAttributeValue(draco::AttributeValueIndex(v), p.data());
  }
  result->SetNumFaces(mesh.triangles.size());
  for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    draco::Mesh::Face face;
    for (size_t k = 0; k < 3; ++k) face[k] = draco::PointIndex(mesh.triangles[f][k]);
    result->SetFace(draco::FaceIndex(f), face);
  }
}

std::unique_ptr<draco::Mesh> ToDracoMesh(const TriangleMesh& mesh) {
  auto result = std::make_unique<draco::Mesh>();
  FillDracoMesh(mesh, result.get());
  return result;
}

StatusOr<TriangleMesh> FromDracoMesh(const draco::Mesh& mesh) {
  const draco::PointAttribute* const positions = mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  if (positions == nullptr || positions->num_components() != 3) {
    return InvalidData("Draco mesh has no POSITION attribute of three components");
  }
  const Reader read = PositionReader(positions->data_type());
  if (read == nullptr || positions->byte_stride() < int64_t{3} * draco::DataTypeLength(positions->data_type())) {
    return InvalidData("POSITION attribute of the Draco mesh has the unknown type " +
                       std::to_string(static_cast<int>(positions->data_type())));
  }
  TriangleMesh result;
  result.positions.resize(mesh.num_points());
  for (uint32_t v = 0; v < mesh.num_points(); ++v) {
    const draco::AttributeValueIndex value = positions->mapped_index(draco::PointIndex(v));
    if (value.value() >= positions->size()) {
      return InvalidData("position of vertex " + std::to_string(v) + " is missing in the Draco mesh");
    }
    result.positions[v] = read(*positions, value);
    if (!IsFinite(result.positions[v])) {
      return InvalidData("position of vertex " + std::to_string(v) + " is not finite");
    }
  }
  result.triangles.resize(mesh.num_faces());
  for (uint32_t f = 0; f < mesh.num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(f));
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = face[k].value();
      if (v >= mesh.num_points()) {
        return InvalidData("triangle " + std::to_string(f) + " refers to vertex " + std::to_string(v) + " of " +
                           std::to_string(mesh.num_points()));
      }
      result.triangles[f][k] = v;
    }
  }
  return result;
}

draco::Status ToDracoStatus(const Status& status) {
  switch (status.code()) {
    case StatusCode::kOk:
      return draco::OkStatus();
    case StatusCode::kInvalidArgument:
      return {draco::Status::INVALID_PARAMETER, status.message()};
    case StatusCode::kUnsupported:
      return {draco::Status::UNSUPPORTED_FEATURE, status.message()};
    case StatusCode::kIoError:
      return {draco::Status::IO_ERROR, status.message()};
    default:
      return {draco::Status::DRACO_ERROR, status.message()};
  }
}

Status FromDracoStatus(const draco::Status& status) {
  switch (status.code()) {
    case draco::Status::OK:
      return {};
    case draco::Status::INVALID_PARAMETER:
      return InvalidArgument("Draco: " + status.error_msg_string());
    case draco::Status::UNSUPPORTED_VERSION:
    case draco::Status::UNKNOWN_VERSION:
    case draco::Status::UNSUPPORTED_FEATURE:
      return Unsupported("Draco: " + status.error_msg_string());
    default:
      return InvalidData("Draco: " + status.error_msg_string());
  }
}

}  // namespace lacerta
