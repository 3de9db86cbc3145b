#include "document/draco_encode.h"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

namespace lacerta {
namespace {

// Positions go to Draco as integers of this lattice with a step of 1, because its options carry floats as text of six
// decimals. The four numbers mark the place in the stream where the true lattice is then written.
constexpr std::array<float, 3> kMark = {-17.0f, -29.0f, -43.0f};

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

bool IsFloatPosition(const Attribute& attribute) {
  return attribute.name == "POSITION" && attribute.data.type == ComponentType::kFloat;
}

int BitsOf(const Attribute& attribute, const DracoPrecision& precision) {
  const auto found = precision.bits.find(attribute.name);
  return attribute.data.type == ComponentType::kFloat && found != precision.bits.end() ? found->second : 0;
}

bool IsOctahedral(const Attribute& attribute) { return attribute.name == "NORMAL" && attribute.data.components == 3; }

Bytes MarkedPositions(const AccessorData& rounded, const Lattice& lattice) {
  Bytes bytes(rounded.bytes.size());
  for (uint64_t i = 0; i < rounded.count; ++i) {
    for (uint32_t c = 0; c < 3; ++c) {
      const float value = static_cast<float>(lattice.Round(rounded.Float(i, c), c)) + kMark[c];
      std::memcpy(bytes.data() + (3 * i + c) * sizeof(float), &value, sizeof(value));
    }
  }
  return bytes;
}

StatusOr<std::unique_ptr<draco::Mesh>> ToDraco(const Primitive& rounded, const DracoPrecision& precision) {
  auto mesh = std::make_unique<draco::Mesh>();
  mesh->set_num_points(static_cast<uint32_t>(rounded.num_vertices));
  mesh->SetNumFaces(rounded.triangles.size());
  for (size_t f = 0; f < rounded.triangles.size(); ++f) {
    const Triangle& t = rounded.triangles[f];
    mesh->SetFace(draco::FaceIndex(static_cast<uint32_t>(f)),
                  {{draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])}});
  }
  for (const Attribute& attribute : rounded.attributes) {
    const AccessorData& data = attribute.data;
    const size_t size = data.components * ComponentSize(data.type);
    draco::GeometryAttribute description;
    description.Init(DracoType(attribute.name), nullptr, static_cast<int8_t>(data.components), DracoDataType(data.type),
                     data.normalized, static_cast<int64_t>(size), 0);
    const int id = mesh->AddAttribute(description, true, static_cast<uint32_t>(data.count));
    if (id < 0) return Unsupported("Draco refuses the attribute " + attribute.name);
    const Bytes& bytes = IsFloatPosition(attribute) ? MarkedPositions(data, precision.positions) : data.bytes;
    mesh->attribute(id)->buffer()->Write(0, bytes.data(), bytes.size());
  }
  if (!mesh->DeduplicateAttributeValues()) return Unsupported("Draco refuses the attributes");
  mesh->DeduplicatePointIds();
  return mesh;
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

float MarkRange(const Lattice& lattice) { return static_cast<float>((int64_t{1} << lattice.bits) - 1); }

// Writes the true lattice over the mark.
Status SetLattice(const Lattice& lattice, Bytes* stream) {
  const std::array<float, 4> mark = {kMark[0], kMark[1], kMark[2], MarkRange(lattice)};
  const std::array<float, 4> wanted = {lattice.origin[0], lattice.origin[1], lattice.origin[2], lattice.range};
  uint8_t pattern[sizeof(mark)];
  std::memcpy(pattern, mark.data(), sizeof(mark));
  const auto found = std::search(stream->begin(), stream->end(), std::begin(pattern), std::end(pattern));
  if (found == stream->end() ||
      std::search(found + 1, stream->end(), std::begin(pattern), std::end(pattern)) != stream->end()) {
    return InternalError("the Draco stream does not tell where its lattice of positions is");
  }
  std::memcpy(stream->data() + (found - stream->begin()), wanted.data(), sizeof(wanted));
  return Status();
}

enum class Connectivity { kStandard, kValence, kSequential };

StatusOr<Bytes> EncodeStock(const draco::Mesh& mesh, const Primitive& primitive, const DracoPrecision& precision,
                            Connectivity connectivity) {
  draco::ExpertEncoder encoder(mesh);
  encoder.SetSpeedOptions(0, 0);
  const bool sequential = connectivity == Connectivity::kSequential;
  encoder.SetEncodingMethod(sequential ? draco::MESH_SEQUENTIAL_ENCODING : draco::MESH_EDGEBREAKER_ENCODING);
  if (!sequential) {
    encoder.SetEncodingSubmethod(connectivity == Connectivity::kValence ? draco::MESH_EDGEBREAKER_VALENCE_ENCODING
                                                                        : draco::MESH_EDGEBREAKER_STANDARD_ENCODING);
  }
  bool has_lattice = false;
  for (size_t i = 0; i < primitive.attributes.size(); ++i) {
    const Attribute& attribute = primitive.attributes[i];
    const int id = static_cast<int>(i);
    if (IsFloatPosition(attribute)) {
      encoder.SetAttributeExplicitQuantization(id, precision.positions.bits, 3, kMark.data(),
                                               MarkRange(precision.positions));
      has_lattice = true;
    } else if (const int bits = BitsOf(attribute, precision); bits > 0) {
      encoder.SetAttributeQuantization(id, bits);
    }
  }
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeToBuffer(&buffer);
  if (!status.ok()) return Unsupported("Draco cannot encode the primitive (" + status.error_msg_string() + ")");
  Bytes bytes(buffer.data(), buffer.data() + buffer.size());
  if (has_lattice) LACERTA_RETURN_IF_ERROR(SetLattice(precision.positions, &bytes));
  return bytes;
}

}  // namespace

Lattice PositionLattice(const Vec3f& min, const Vec3f& max, int bits) {
  const Vec3f extent = max - min;
  const float range = std::max({extent.x, extent.y, extent.z});
  return {{min.x, min.y, min.z, 0.0f}, range > 0.0f ? range : 1.0f, bits};
}

Primitive RoundAttributes(const Primitive& primitive, const DracoPrecision& precision) {
  Primitive rounded = primitive;
  for (Attribute& attribute : rounded.attributes) {
    if (IsFloatPosition(attribute)) {
      attribute.data = RoundToLattice(attribute.data, precision.positions);
    } else if (const int bits = BitsOf(attribute, precision); bits > 0) {
      attribute.data = IsOctahedral(attribute) ? RoundOctahedral(attribute.data, bits)
                                               : RoundToLattice(attribute.data, FitLattice(attribute.data, bits));
    }
  }
  return rounded;
}

StatusOr<DracoEncoded> EncodeDracoPrimitive(const Primitive& primitive, const DracoPrecision& precision) {
  if (primitive.triangles.empty()) return Unsupported("holds no triangles");
  for (const Attribute& attribute : primitive.attributes) {
    if (!AllFinite(attribute)) return Unsupported(attribute.name + " holds values that are not finite");
  }
  const Primitive rounded = RoundAttributes(primitive, precision);
  LACERTA_ASSIGN_OR_RETURN(const std::unique_ptr<draco::Mesh> mesh, ToDraco(rounded, precision));
  DracoEncoded result;
  Status refused;
  for (const Connectivity connectivity : {Connectivity::kStandard, Connectivity::kValence, Connectivity::kSequential}) {
    StatusOr<Bytes> bytes = EncodeStock(*mesh, rounded, precision, connectivity);
    if (!bytes.ok()) {
      refused = bytes.status();
    } else if (result.bytes.empty() || bytes.value().size() < result.bytes.size()) {
      result.bytes = std::move(bytes).value();
    }
  }
  if (result.bytes.empty()) return refused;
  for (size_t i = 0; i < primitive.attributes.size(); ++i) {
    result.ids.push_back({primitive.attributes[i].name, mesh->attribute(static_cast<int>(i))->unique_id()});
  }
  LACERTA_ASSIGN_OR_RETURN(result.decoded, DecodeDracoPrimitive(result.bytes, result.ids, DecodeLimits{}));
  if (result.decoded.triangles.empty()) return Unsupported("holds only degenerate triangles");
  return result;
}

}  // namespace lacerta
