#include "document/draco_encode.h"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "draco/component_order.h"
#include "draco/merge_values.h"
#include "draco/recoded_stream.h"
#include "draco/stock_stream.h"

namespace lacerta {
namespace {

// What is rounded to a lattice goes to Draco as integers of this one with a step of 1, because its options carry floats
// as text of six decimals. The numbers, others for each attribute, mark the place in the stream where the true lattice
// is then written.
std::array<float, 4> MarkOf(size_t attribute) {
  const float shift = 100.0f * static_cast<float>(attribute);
  return {-17.0f - shift, -29.0f - shift, -43.0f - shift, -61.0f - shift};
}

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

// Null where the values are not rounded to one.
const Lattice* LatticeOf(const Attribute& attribute, const DracoPrecision& precision) {
  if (attribute.data.type != ComponentType::kFloat) return nullptr;
  if (attribute.name == "POSITION") return &precision.positions;
  const auto found = precision.lattices.find(attribute.name);
  return found != precision.lattices.end() ? &found->second : nullptr;
}

// 0 where the values are not rounded as directions.
int OctahedralBits(const Attribute& attribute, const DracoPrecision& precision) {
  const AccessorData& data = attribute.data;
  const bool is_normal = attribute.name == "NORMAL" && data.components == 3 && data.type == ComponentType::kFloat;
  return is_normal ? precision.normal_bits : 0;
}

Bytes MarkedValues(const AccessorData& rounded, const Lattice& lattice, const std::array<float, 4>& mark) {
  Bytes bytes(rounded.bytes.size());
  for (uint64_t i = 0; i < rounded.count; ++i) {
    for (uint32_t c = 0; c < rounded.components; ++c) {
      const float value = static_cast<float>(lattice.Round(rounded.Float(i, c), c)) + mark[c];
      std::memcpy(bytes.data() + (rounded.components * i + c) * sizeof(float), &value, sizeof(value));
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
    const Lattice* lattice = LatticeOf(attribute, precision);
    const Bytes& bytes =
        lattice != nullptr ? MarkedValues(data, *lattice, MarkOf(static_cast<size_t>(id))) : data.bytes;
    mesh->attribute(id)->buffer()->Write(0, bytes.data(), bytes.size());
  }
  MergeEqualValues(mesh.get());
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

// Stock Draco counts how often each integer occurs up to the largest difference between two of an attribute.
bool CanBeCounted(const AccessorData& data) {
  constexpr uint32_t kMostDifference = uint32_t{1} << kMostLatticeBits;
  if (data.type != ComponentType::kUint32) return true;
  uint32_t least = std::numeric_limits<uint32_t>::max(), most = 0;
  for (uint64_t i = 0; i < data.count * data.components; ++i) {
    const uint32_t value = data.Uint(i / data.components, static_cast<uint32_t>(i % data.components));
    least = std::min(least, value);
    most = std::max(most, value);
  }
  return most < least || most - least <= kMostDifference;
}

Status CheckEncodable(const Primitive& primitive) {
  if (primitive.triangles.empty()) return Unsupported("holds no triangles");
  for (const Attribute& attribute : primitive.attributes) {
    if (!AllFinite(attribute)) return Unsupported(attribute.name + " holds values that are not finite");
    if (!CanBeCounted(attribute.data)) return Unsupported(attribute.name + " holds integers that are too far apart for Draco, which would take gigabytes for them");
  }
  return Status();
}

float MarkRange(const Lattice& lattice) { return static_cast<float>((int64_t{1} << lattice.bits) - 1); }

// Writes the true lattice over the mark.
Status SetLattice(const Lattice& lattice, size_t attribute, uint32_t components, Bytes* stream) {
  std::array<float, 5> mark = {};
  std::array<float, 5> wanted = {};
  for (uint32_t c = 0; c < components; ++c) {
    mark[c] = MarkOf(attribute)[c];
    wanted[c] = lattice.origin[c];
  }
  mark[components] = MarkRange(lattice);
  wanted[components] = lattice.range;
  uint8_t pattern[sizeof(mark)];
  std::memcpy(pattern, mark.data(), sizeof(mark));
  const auto end = std::begin(pattern) + static_cast<std::ptrdiff_t>((components + 1) * sizeof(float));
  const auto found = std::search(stream->begin(), stream->end(), std::begin(pattern), end);
  if (found == stream->end() || std::search(found + 1, stream->end(), std::begin(pattern), end) != stream->end()) {
    return InternalError("the Draco stream does not tell where its lattices are");
  }
  std::memcpy(stream->data() + (found - stream->begin()), wanted.data(), (components + 1) * sizeof(float));
  return Status();
}

using Connectivity = DracoCoding::Connectivity;

StatusOr<Bytes> EncodeStock(const draco::Mesh& mesh, const Primitive& primitive, const DracoPrecision& precision, const DracoCoding& coding) {
  const Connectivity connectivity = coding.connectivity;
  draco::ExpertEncoder encoder(mesh);
  encoder.SetSpeedOptions(0, 0);
  LACERTA_RETURN_IF_ERROR(SetPredictions(coding.predictions, &encoder));
  if (connectivity == Connectivity::kSequential) {
    encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
  } else {
    const bool valence = connectivity == Connectivity::kValence;
    LACERTA_RETURN_IF_ERROR(
        SetEdgebreaker(mesh, valence ? draco::MESH_EDGEBREAKER_VALENCE_ENCODING : draco::MESH_EDGEBREAKER_STANDARD_ENCODING, &encoder));
  }
  for (size_t i = 0; i < primitive.attributes.size(); ++i) {
    const Attribute& attribute = primitive.attributes[i];
    const int id = static_cast<int>(i);
    if (const Lattice* lattice = LatticeOf(attribute, precision); lattice != nullptr) {
      encoder.SetAttributeExplicitQuantization(id, lattice->bits, static_cast<int>(attribute.data.components),
                                               MarkOf(i).data(), MarkRange(*lattice));
    } else if (const int bits = OctahedralBits(attribute, precision); bits > 0) {
      encoder.SetAttributeQuantization(id, bits);
    }
  }
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeToBuffer(&buffer);
  if (!status.ok()) return Unsupported("Draco cannot encode the primitive (" + status.error_msg_string() + ")");
  Bytes bytes(buffer.data(), buffer.data() + buffer.size());
  for (size_t i = 0; i < primitive.attributes.size(); ++i) {
    const Lattice* lattice = LatticeOf(primitive.attributes[i], precision);
    if (lattice == nullptr) continue;
    LACERTA_RETURN_IF_ERROR(SetLattice(*lattice, i, primitive.attributes[i].data.components, &bytes));
  }
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
    if (const auto chosen = precision.values.find(attribute.name); chosen != precision.values.end()) {
      attribute.data = chosen->second;
    } else if (const Lattice* lattice = LatticeOf(attribute, precision); lattice != nullptr) {
      const bool is_weights = BeginsWith(attribute.name, "WEIGHTS_");
      attribute.data = is_weights ? RoundKeepingSums(attribute.data, *lattice) : RoundToLattice(attribute.data, *lattice);
    } else if (const int bits = OctahedralBits(attribute, precision); bits > 0) {
      attribute.data = RoundOctahedral(attribute.data, bits);
    }
  }
  return rounded;
}

StatusOr<DracoEncoded> EncodeDracoPrimitive(const Primitive& primitive, const DracoPrecision& precision, DracoSearch search) {
  LACERTA_RETURN_IF_ERROR(CheckEncodable(primitive));
  const Primitive rounded = RoundAttributes(primitive, precision);
  LACERTA_ASSIGN_OR_RETURN(const std::unique_ptr<draco::Mesh> mesh, ToDraco(rounded, precision));
  DracoEncoded result;
  Status refused;
  for (const Connectivity connectivity : {Connectivity::kStandard, Connectivity::kValence, Connectivity::kSequential}) {
    StatusOr<Bytes> bytes = EncodeStock(*mesh, rounded, precision, {connectivity});
    if (!bytes.ok()) {
      refused = bytes.status();
    } else if (result.bytes.empty() || bytes.value().size() < result.bytes.size()) {
      result.bytes = std::move(bytes).value();
      result.coding.connectivity = connectivity;
    }
  }
  if (result.bytes.empty()) return refused;
  if (search == DracoSearch::kPredictions && result.coding.connectivity != Connectivity::kSequential) {
    const auto encode = [&](const Predictions& predictions) { return EncodeStock(*mesh, rounded, precision, {result.coding.connectivity, predictions}); };
    result.coding.predictions = FindPredictions(*mesh, encode, &result.bytes);
    result.bytes = RecodeStream(std::move(result.bytes));
  }
  for (size_t i = 0; i < primitive.attributes.size(); ++i) {
    result.ids.push_back({primitive.attributes[i].name, mesh->attribute(static_cast<int>(i))->unique_id()});
  }
  LACERTA_ASSIGN_OR_RETURN(result.decoded, DecodeDracoPrimitive(result.bytes, result.ids, DecodeLimits{}));
  if (result.decoded.triangles.empty()) return Unsupported("holds only degenerate triangles");
  return result;
}

StatusOr<uint64_t> DracoPrimitiveBytes(const Primitive& primitive, const DracoPrecision& precision, const DracoCoding& coding) {
  LACERTA_RETURN_IF_ERROR(CheckEncodable(primitive));
  const Primitive rounded = RoundAttributes(primitive, precision);
  LACERTA_ASSIGN_OR_RETURN(const std::unique_ptr<draco::Mesh> mesh, ToDraco(rounded, precision));
  LACERTA_ASSIGN_OR_RETURN(const Bytes bytes, EncodeStock(*mesh, rounded, precision, coding));
  return bytes.size();
}

StatusOr<DracoEncoded> EncodeInOtherOrder(const Primitive& primitive, const DracoPrecision& precision, const DracoEncoded& encoded) {
  constexpr size_t kMostStarts = 16, kTriangleBudget = 1u << 15;
  if (encoded.coding.connectivity == Connectivity::kSequential) return encoded;
  Primitive rounded = RoundAttributes(primitive, precision);
  std::vector<Triangle> order = rounded.triangles;
  Bytes smallest;
  // Whether it takes fewer bytes than all before.
  const auto try_order = [&](std::vector<Triangle> triangles) -> StatusOr<bool> {
    rounded.triangles = std::move(triangles);
    LACERTA_ASSIGN_OR_RETURN(const std::unique_ptr<draco::Mesh> mesh, ToDraco(rounded, precision));
    LACERTA_ASSIGN_OR_RETURN(Bytes bytes, EncodeStock(*mesh, rounded, precision, encoded.coding));
    if (!smallest.empty() && bytes.size() >= smallest.size()) return false;
    smallest = std::move(bytes);
    return true;
  };
  LACERTA_RETURN_IF_ERROR(try_order(order).status());
  if (std::vector<Triangle> nearest = ByNearestComponents(Surface(rounded), kManyComponents); nearest != order) {
    LACERTA_ASSIGN_OR_RETURN(const bool is_smaller, try_order(nearest));
    if (is_smaller) order = std::move(nearest);
  }
  const size_t num_starts = std::min(kMostStarts, kTriangleBudget / order.size());
  for (size_t start = 1; start < num_starts; ++start) {
    std::vector<Triangle> rotated = order;
    std::rotate(rotated.begin(), rotated.begin() + static_cast<std::ptrdiff_t>(start * order.size() / num_starts), rotated.end());
    LACERTA_RETURN_IF_ERROR(try_order(std::move(rotated)).status());
  }
  DracoEncoded result = encoded;
  result.bytes = RecodeStream(std::move(smallest));
  if (result.bytes.size() >= encoded.bytes.size()) return encoded;
  LACERTA_ASSIGN_OR_RETURN(result.decoded, DecodeDracoPrimitive(result.bytes, result.ids, DecodeLimits{}));
  return result;
}

}  // namespace lacerta
