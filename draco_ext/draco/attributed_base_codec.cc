#include "draco/attributed_base_codec.h"

#include <draco/attributes/point_attribute.h>
#include <draco/compression/expert_encode.h>
#include <draco/core/encoder_buffer.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "common/octahedral.h"
#include "draco/base_weights.h"
#include "draco/merge_values.h"
#include "draco/mesh_conversion.h"
#include "draco/recoded_stream.h"
#include "draco/smallest_predictions.h"
#include "draco/stock_stream.h"

namespace lacerta {
namespace {

constexpr int kMostLatticeBits = 22;

// Integers of one attribute as Draco is given them: from `mark` on, as floats. Its options carry floats as text of six decimals, so that
// the marks, no two of them alike, hold the place in the stream where the true grid is then written.
struct MarkedLattice {
  int id = 0;  // of the Draco attribute
  int bits = 1;
  std::vector<float> mark;    // per component
  std::vector<float> origin;  // of the grid, per component
  float range = 1.0f;

  float MarkRange() const { return static_cast<float>((1 << bits) - 1); }
};

Status WriteGrid(const MarkedLattice& lattice, Bytes* stream) {
  std::vector<float> mark = lattice.mark, grid = lattice.origin;
  mark.push_back(lattice.MarkRange());
  grid.push_back(lattice.range);
  Bytes pattern(mark.size() * sizeof(float));
  std::memcpy(pattern.data(), mark.data(), pattern.size());
  const auto found = std::search(stream->begin(), stream->end(), pattern.begin(), pattern.end());
  if (found == stream->end() || std::search(found + 1, stream->end(), pattern.begin(), pattern.end()) != stream->end()) {
    return InternalError("the Draco stream does not tell where its lattices are");
  }
  std::memcpy(&*found, grid.data(), pattern.size());
  return Status();
}

draco::GeometryAttribute::Type DracoType(const AttributeLattice& p) {
  switch (p.kind) {
    case AttributeKind::kNormal:
      return draco::GeometryAttribute::NORMAL;
    case AttributeKind::kTextureCoordinates:
      return p.components == 2 ? draco::GeometryAttribute::TEX_COORD : draco::GeometryAttribute::GENERIC;
    case AttributeKind::kColor:
      return draco::GeometryAttribute::COLOR;
    default:
      return draco::GeometryAttribute::GENERIC;
  }
}

// One group on its way into Draco: its own vertices are points [first, end) of the base.
struct Group {
  uint32_t first_face = 0, num_faces = 0;
  uint32_t first_vertex = 0, num_vertices = 0;
};

std::vector<Group> SplitGroups(const AttributedBase& base) {
  std::vector<Group> groups;
  uint32_t face = 0;
  for (const uint32_t size : base.group_sizes) {
    Group g{face, size, std::numeric_limits<uint32_t>::max(), 0};
    uint32_t last = 0;
    for (uint32_t f = face; f < face + size; ++f) {
      for (const uint32_t v : base.mesh.triangles[f]) {
        g.first_vertex = std::min(g.first_vertex, v);
        last = std::max(last, v);
      }
    }
    g.num_vertices = size == 0 ? 0 : last - g.first_vertex + 1;
    groups.push_back(g);
    face += size;
  }
  return groups;
}

class GroupEncoder {
 public:
  GroupEncoder(const AttributedBase& base, const Group& group, const JointTable& joints)
      : base_(base), group_(group), joints_(joints) {}

  StatusOr<Bytes> Encode(size_t group) {
    mesh_.set_num_points(group_.num_vertices);
    mesh_.SetNumFaces(group_.num_faces);
    for (uint32_t f = 0; f < group_.num_faces; ++f) {
      draco::Mesh::Face face;
      for (size_t k = 0; k < 3; ++k) face[k] = draco::PointIndex(base_.mesh.triangles[group_.first_face + f][k] - group_.first_vertex);
      mesh_.SetFace(draco::FaceIndex(f), face);
    }
    const int32_t* const lattice = base_.mesh.lattice[group_.first_vertex].data();
    LACERTA_RETURN_IF_ERROR(AddLattice(draco::GeometryAttribute::POSITION, 0, base_.mesh.step, lattice, 3));
    for (size_t i = 0; i < base_.attributes.size(); ++i) {
      const BaseAttribute& a = base_.attributes[i];
      if (a.in_group[group] == 0) continue;
      const auto unique_id = static_cast<uint32_t>(i + 1);
      const int32_t* const values = a.values.data() + size_t{group_.first_vertex} * a.numbers_per_value();
      if (a.precision.octahedral_bits > 0) {
        AddNormals(unique_id, a.precision.octahedral_bits, values);
      } else if (a.precision.kind == AttributeKind::kWeights && !joints_.empty()) {
        LACERTA_RETURN_IF_ERROR(
            AddWeights(unique_id, a.precision.step, values).WithContext("attribute " + a.precision.name));
      } else {
        LACERTA_RETURN_IF_ERROR(AddLattice(DracoType(a.precision), unique_id, a.precision.step, values, a.precision.components)
                                    .WithContext("attribute " + a.precision.name));
      }
    }
    MergeEqualValues(&mesh_);
    mesh_.DeduplicatePointIds();
    Bytes best;
    int best_method = 0;
    for (const int method : {draco::MESH_EDGEBREAKER_STANDARD_ENCODING, draco::MESH_EDGEBREAKER_VALENCE_ENCODING}) {
      LACERTA_ASSIGN_OR_RETURN(Bytes bytes, EncodeBy(method, {}));
      if (!best.empty() && bytes.size() >= best.size()) continue;
      best = std::move(bytes);
      best_method = method;
    }
    FindPredictions(mesh_, [&](const Predictions& predictions) { return EncodeBy(best_method, predictions); }, &best);
    for (const MarkedLattice& lattice_of : lattices_) LACERTA_RETURN_IF_ERROR(WriteGrid(lattice_of, &best));
    return RecodeStream(std::move(best));
  }

 private:
  int AddFloats(draco::GeometryAttribute::Type type, uint32_t unique_id, const std::vector<float>& values, uint32_t components) {
    draco::GeometryAttribute description;
    description.Init(type, nullptr, static_cast<int8_t>(components), draco::DT_FLOAT32, false, static_cast<int64_t>(components * sizeof(float)), 0);
    const int id = mesh_.AddAttribute(description, /*identity_mapping=*/true, group_.num_vertices);
    mesh_.attribute(id)->set_unique_id(unique_id);
    mesh_.attribute(id)->buffer()->Write(0, values.data(), values.size() * sizeof(float));
    return id;
  }

  Status AddLattice(draco::GeometryAttribute::Type type, uint32_t unique_id, float step, const int32_t* numbers, uint32_t components) {
    MarkedLattice lattice;
    int32_t extent = 0;
    std::vector<int32_t> least(components);
    for (uint32_t c = 0; c < components; ++c) {
      int32_t low = numbers[c], high = numbers[c];
      for (uint32_t v = 0; v < group_.num_vertices; ++v) {
        low = std::min(low, numbers[v * components + c]);
        high = std::max(high, numbers[v * components + c]);
      }
      least[c] = low;
      extent = std::max(extent, high - low);
      lattice.mark.push_back(-17.0f - static_cast<float>(29 * c + 31 * unique_id));
      lattice.origin.push_back(static_cast<float>(low) * step);
    }
    while (extent >> lattice.bits != 0) ++lattice.bits;
    if (lattice.bits > kMostLatticeBits) return InvalidData("values span more than 22 bits; choose a larger step");
    lattice.range = RangeForStep(step, lattice.bits);
    std::vector<float> values;
    for (uint32_t v = 0; v < group_.num_vertices; ++v) {
      for (uint32_t c = 0; c < components; ++c) values.push_back(static_cast<float>(numbers[v * components + c] - least[c]) + lattice.mark[c]);
    }
    lattice.id = AddFloats(type, unique_id, values, components);
    lattices_.push_back(std::move(lattice));
    return Status();
  }

  void AddNormals(uint32_t unique_id, int bits, const int32_t* points) {
    std::vector<float> values;
    for (uint32_t v = 0; v < group_.num_vertices; ++v) {
      const Vec3f n = NormalFromOctahedral({points[size_t{2} * v], points[size_t{2} * v + 1]}, bits);
      values.insert(values.end(), {n.x, n.y, n.z});
    }
    octahedral_.emplace_back(AddFloats(draco::GeometryAttribute::NORMAL, unique_id, values, 3), bits);
  }

  Status AddWeights(uint32_t unique_id, float step, const int32_t* points) {
    const PlacedWeights placed = PlaceWeights(points, group_.num_vertices, step, joints_);
    constexpr int8_t kKept = 4;
    const bool is_short = *std::max_element(joints_.begin(), joints_.end()) > std::numeric_limits<uint8_t>::max();
    draco::GeometryAttribute description;
    description.Init(draco::GeometryAttribute::GENERIC, nullptr, kKept, is_short ? draco::DT_UINT16 : draco::DT_UINT8,
                     false, is_short ? 2 * kKept : kKept, 0);
    draco::PointAttribute* const to =
        mesh_.attribute(mesh_.AddAttribute(description, /*identity_mapping=*/true, group_.num_vertices));
    to->set_unique_id(static_cast<uint32_t>(base_.attributes.size() + 1));
    if (is_short) {
      to->buffer()->Write(0, placed.joints.data(), placed.joints.size() * sizeof(placed.joints[0]));
    } else {
      const Bytes narrow(placed.joints.begin(), placed.joints.end());
      to->buffer()->Write(0, narrow.data(), narrow.size());
    }
    return AddLattice(draco::GeometryAttribute::GENERIC, unique_id, step, placed.points.data(), kKept);
  }

  StatusOr<Bytes> EncodeBy(int method, const Predictions& predictions) const {
    draco::ExpertEncoder encoder(mesh_);
    encoder.SetSpeedOptions(0, 0);
    LACERTA_RETURN_IF_ERROR(SetEdgebreaker(mesh_, method, &encoder));
    LACERTA_RETURN_IF_ERROR(SetPredictions(predictions, &encoder));
    for (const MarkedLattice& l : lattices_) {
      encoder.SetAttributeExplicitQuantization(l.id, l.bits, static_cast<int>(l.mark.size()), l.mark.data(), l.MarkRange());
    }
    for (const auto& [id, bits] : octahedral_) encoder.SetAttributeQuantization(id, bits);
    draco::EncoderBuffer buffer;
    if (const draco::Status status = encoder.EncodeToBuffer(&buffer); !status.ok()) return FromDracoStatus(status);
    return Bytes(buffer.data(), buffer.data() + buffer.size());
  }

  const AttributedBase& base_;
  const Group group_;
  const JointTable& joints_;
  draco::Mesh mesh_;
  std::vector<MarkedLattice> lattices_;
  std::vector<std::pair<int, int>> octahedral_;  // Draco attribute, bits
};

StatusOr<VertexSoup::Attribute> ReadAttribute(const draco::Mesh& mesh, const draco::PointAttribute& from, const std::string& name) {
  const auto n = static_cast<uint32_t>(from.num_components());
  const draco::DataType type = from.data_type();
  const bool is_usual =
      name == kJointsName ? type == draco::DT_UINT8 || type == draco::DT_UINT16 : type == draco::DT_FLOAT32;
  if (n == 0 || !is_usual || from.byte_stride() < int64_t{n} * draco::DataTypeLength(type))
    return InvalidData("attribute " + name + " of the base is not of " +
                       (name == kJointsName ? "whole numbers" : "floats"));
  VertexSoup::Attribute result{name, AttributeKind::kGeneric, n, std::vector<float>(size_t{n} * mesh.num_points())};
  for (uint32_t v = 0; v < mesh.num_points(); ++v) {
    const draco::AttributeValueIndex index = from.mapped_index(draco::PointIndex(v));
    if (index.value() >= from.size()) return InvalidData("a value of attribute " + name + " is missing in the base");
    if (!from.ConvertValue<float>(index, static_cast<int8_t>(n), &result.values[size_t{n} * v]))
      return InvalidData("attribute " + name + " of the base cannot be read");
  }
  return result;
}

// All integers at the corners of a triangle, from the least corner on, with the group before them.
struct KeyedFace {
  std::vector<int32_t> key;
  uint32_t face = 0, first_corner = 0;
};

std::vector<KeyedFace> KeyFaces(const AttributedBase& base) {
  std::vector<KeyedFace> keyed;
  uint32_t face = 0;
  for (uint32_t g = 0; g < base.group_sizes.size(); ++g) {
    for (const uint32_t end = face + base.group_sizes[g]; face < end; ++face) {
      std::array<std::vector<int32_t>, 3> corners;
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t v = base.mesh.triangles[face][k];
        corners[k].assign(base.mesh.lattice[v].begin(), base.mesh.lattice[v].end());
        for (const BaseAttribute& a : base.attributes) {
          const auto first = a.values.begin() + static_cast<ptrdiff_t>(size_t{v} * a.numbers_per_value());
          if (a.in_group[g] != 0) corners[k].insert(corners[k].end(), first, first + a.numbers_per_value());
        }
      }
      const auto least = static_cast<uint32_t>(std::min_element(corners.begin(), corners.end()) - corners.begin());
      KeyedFace k{{static_cast<int32_t>(g)}, face, least};
      for (uint32_t i = 0; i < 3; ++i) k.key.insert(k.key.end(), corners[(least + i) % 3].begin(), corners[(least + i) % 3].end());
      keyed.push_back(std::move(k));
    }
  }
  std::sort(keyed.begin(), keyed.end(), [](const KeyedFace& a, const KeyedFace& b) { return a.key < b.key; });
  return keyed;
}

// Which given triangle every coded one is.
StatusOr<std::vector<FaceSource>> MatchFaces(const AttributedBase& given, const AttributedBase& coded) {
  const std::vector<KeyedFace> from = KeyFaces(given), to = KeyFaces(coded);
  if (from.size() != to.size()) {
    return InvalidData("Draco made " + std::to_string(to.size()) + " triangles of the base's " + std::to_string(from.size()) + "; keep more vertices in the base");
  }
  std::vector<FaceSource> faces(to.size());
  for (size_t i = 0; i < to.size(); ++i) {
    if (i > 0 && from[i].key == from[i - 1].key) return InvalidData("triangles " + std::to_string(from[i - 1].face) + " and " + std::to_string(from[i].face) + " of the base are the same");
    if (from[i].key != to[i].key) return InvalidData("Draco changed the base mesh; keep more vertices in it");
    faces[to[i].face] = {from[i].face, (from[i].first_corner + 3 - to[i].first_corner) % 3};
  }
  return faces;
}

}  // namespace

StatusOr<CodedAttributedBase> EncodeAttributedBase(const AttributedBase& base, const JointTable& joints) {
  CodedAttributedBase result;
  std::vector<AttributeLattice> precision;
  for (const BaseAttribute& a : base.attributes) precision.push_back(a.precision);
  std::vector<VertexSoup> soups;
  const std::vector<Group> groups = SplitGroups(base);
  for (size_t g = 0; g < groups.size(); ++g) {
    const std::string where = "group " + std::to_string(g) + " of the base";
    if (groups[g].num_faces == 0) return InvalidData(where + " is empty");
    StatusOr<Bytes> stream = GroupEncoder(base, groups[g], joints).Encode(g);
    if (!stream.ok()) return stream.status().WithContext(where);
    StatusOr<VertexSoup> soup = DecodeAttributedGroup(stream.value(), precision, kNoDecodeLimits, joints);
    if (!soup.ok()) return soup.status().WithContext(where);
    soups.push_back(std::move(soup).value());
    result.streams.push_back(std::move(stream).value());
  }
  LACERTA_ASSIGN_OR_RETURN(result.base, AttributedBaseFromSoups(soups, base.mesh.step, precision));
  LACERTA_ASSIGN_OR_RETURN(result.faces, MatchFaces(base, result.base));
  return result;
}

StatusOr<VertexSoup> DecodeAttributedGroup(Span<const uint8_t> stream, const std::vector<std::string>& names,
                                           const DecodeLimits& limits, const JointTable& joints) {
  LACERTA_ASSIGN_OR_RETURN(const StockMesh stock, DecodeStockStream(stream, limits));
  LACERTA_ASSIGN_OR_RETURN(TriangleMesh mesh, FromDracoMesh(*stock.mesh));
  VertexSoup soup{std::move(mesh.positions), std::move(mesh.triangles), {}};
  for (size_t i = 0; i < names.size() + (joints.empty() ? 0 : 1); ++i) {
    const draco::PointAttribute* const from = stock.mesh->GetAttributeByUniqueId(static_cast<uint32_t>(i + 1));
    if (from == nullptr) continue;
    LACERTA_ASSIGN_OR_RETURN(VertexSoup::Attribute attribute,
                             ReadAttribute(*stock.mesh, *from, i < names.size() ? names[i] : kJointsName));
    soup.attributes.push_back(std::move(attribute));
  }
  constexpr uint64_t kMostPerVertex = 4;  // of all that the limits allow: a small base may name many joints
  if (soup.positions.size() * joints.size() > kMostPerVertex * limits.max_vertices)
    return LimitExceeded("the base has too many weights");
  if (!joints.empty()) LACERTA_RETURN_IF_ERROR(SpreadWeights(joints, &soup));
  return soup;
}

StatusOr<VertexSoup> DecodeAttributedGroup(Span<const uint8_t> stream, const std::vector<AttributeLattice>& precision,
                                           const DecodeLimits& limits, const JointTable& joints) {
  std::vector<std::string> names;
  names.reserve(precision.size());
  for (const AttributeLattice& p : precision) names.push_back(p.name);
  LACERTA_ASSIGN_OR_RETURN(VertexSoup soup, DecodeAttributedGroup(stream, names, limits, joints));
  for (VertexSoup::Attribute& attribute : soup.attributes) {
    const auto of = std::find_if(precision.begin(), precision.end(), [&](const AttributeLattice& p) { return p.name == attribute.name; });
    if (of == precision.end() || of->components != attribute.components)
      return InvalidData("attribute " + attribute.name + " of the base, of " + std::to_string(attribute.components) +
                         " floats, is none of the stream's");
    attribute.kind = of->kind;
  }
  return soup;
}

}  // namespace lacerta
