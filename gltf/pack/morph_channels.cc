#include "pack/morph_channels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "extension/target_channels.h"
#include "geometry/value_difference.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;
constexpr std::array<const char*, 3> kNames = {"POSITION", "NORMAL", "TANGENT"};

const Attribute* FindIn(const MorphTarget& target, const std::string& name) {
  const auto found = std::find_if(target.begin(), target.end(), [&](const Attribute& a) { return a.name == name; });
  return found == target.end() ? nullptr : &*found;
}

// Targets without the attribute do not move it.
AccessorData Together(const std::vector<MorphTarget>& targets, size_t first, size_t count, const std::string& name,
                      uint64_t num_vertices) {
  std::vector<float> values(3 * count * num_vertices, 0.0f);
  for (size_t t = 0; t < count; ++t) {
    const Attribute* const offsets = FindIn(targets[first + t], name);
    for (uint64_t v = 0; offsets != nullptr && v < num_vertices; ++v) {
      for (uint32_t c = 0; c < 3; ++c) values[3 * (count * v + t) + c] = offsets->data.Float(v, c);
    }
  }
  return MakeFloatAccessor(values, static_cast<uint32_t>(3 * count));
}

StatusOr<Primitive> WithChannels(const Primitive& primitive, const std::vector<MorphTarget>& targets) {
  // The same refusals, and the same order of magnitude of work.
  LACERTA_RETURN_IF_ERROR(WithTargets(primitive, targets).status());
  Primitive result = primitive;
  for (const char* const name : kNames) {
    if (std::none_of(targets.begin(), targets.end(), [&](const MorphTarget& t) { return FindIn(t, name) != nullptr; }))
      continue;
    for (size_t first = 0; first < targets.size(); first += kMostTargetsTogether) {
      const size_t count = std::min(kMostTargetsTogether, targets.size() - first);
      result.attributes.push_back(
          {NameOf({first, name}), Together(targets, first, count, name, primitive.num_vertices)});
    }
  }
  if (result.attributes.size() == primitive.attributes.size())
    return Unsupported("has morph targets without attributes");
  return result;
}

bool IsOfPositions(const MeshAttribute& attribute) {
  const auto channels = ParseTargetChannels(attribute.name);
  return channels.has_value() && channels->attribute == "POSITION";
}

bool IsOfDirections(const MeshAttribute& attribute) {
  return ParseTargetChannels(attribute.name).has_value() && !IsOfPositions(attribute);
}

// The weights in a mix of the targets that an attribute has; empty where it has no part in it.
std::vector<float> WeightsIn(const TargetMix& mix, const MeshAttribute& attribute) {
  const auto first = mix.begin() + static_cast<std::ptrdiff_t>(ParseTargetChannels(attribute.name)->first);
  std::vector<float> weights(first, first + attribute.components / 3);
  const bool has_part = std::any_of(weights.begin(), weights.end(), [](float w) { return w != 0.0f; });
  return has_part ? weights : std::vector<float>();
}

Vec3f Offset(const MeshAttribute& offsets, uint32_t row, const std::vector<float>& weights) {
  Vec3f sum;
  for (size_t t = 0; t < weights.size(); ++t) {
    const float* const offset = &offsets.values[size_t{row} * offsets.components + 3 * t];
    if (weights[t] != 0.0f) sum += Vec3f{offset[0], offset[1], offset[2]} * weights[t];
  }
  return sum;
}

// Moves the surface by an attribute's targets. Vertices where its offsets have seams become several.
void Move(const MeshAttribute& offsets, const std::vector<float>& weights, TriangleMesh* surface) {
  constexpr uint32_t kUnknown = kNone - 1;
  const std::vector<Vec3f> before = surface->positions;
  const auto moved = [&](uint32_t vertex, uint32_t row) { return row == kNone ? before[vertex] : before[vertex] + Offset(offsets, row, weights); };
  std::vector<uint32_t> row_of(before.size(), kUnknown);
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> further;  // of vertices with a row other than that one
  for (size_t f = 0; f < surface->triangles.size(); ++f) {
    for (size_t k = 0; k < 3; ++k) {
      uint32_t& vertex = surface->triangles[f][k];
      const uint32_t row = offsets.corners[f][k];
      if (row_of[vertex] == kUnknown) {
        row_of[vertex] = row;
        surface->positions[vertex] = moved(vertex, row);
      } else if (row_of[vertex] != row) {
        const auto [found, is_new] = further.try_emplace({vertex, row}, static_cast<uint32_t>(surface->positions.size()));
        if (is_new) surface->positions.push_back(moved(vertex, row));
        vertex = found->second;
      }
    }
  }
}

TriangleMesh Morphed(const AttributedMesh& mesh, const TargetMix& mix) {
  TriangleMesh surface = mesh.surface;
  for (const MeshAttribute& attribute : mesh.attributes) {
    if (!IsOfPositions(attribute)) continue;
    if (const std::vector<float> weights = WeightsIn(mix, attribute); !weights.empty()) Move(attribute, weights, &surface);
  }
  return surface;
}

// Nothing but the targets' directions, an attribute for each.
AttributedMesh DirectionsApart(const AttributedMesh& mesh) {
  AttributedMesh result{mesh.surface, mesh.groups, {}};
  for (const MeshAttribute& attribute : mesh.attributes) {
    if (!IsOfDirections(attribute)) continue;
    for (uint32_t t = 0; t < attribute.components / 3; ++t) {
      MeshAttribute one{attribute.name + "/" + std::to_string(t), attribute.kind, 3, {}, attribute.corners};
      for (size_t row = 0; row < attribute.num_values(); ++row) {
        const auto first = attribute.values.begin() + static_cast<std::ptrdiff_t>(row * attribute.components + size_t{3} * t);
        one.values.insert(one.values.end(), first, first + 3);
      }
      result.attributes.push_back(std::move(one));
    }
  }
  return result;
}

void DropUpTo(double nothing, std::vector<float>* offsets) {
  for (size_t i = 0; i < offsets->size(); i += 3) {
    float* const offset = &(*offsets)[i];
    if (std::hypot(offset[0], offset[1], offset[2]) <= nothing) std::fill_n(offset, 3, 0.0f);
  }
}

}  // namespace

StatusOr<MorphChannels> MorphChannels::Create(const FamilyMeter& plain,
                                              const std::vector<const std::vector<MorphTarget>*>& targets,
                                              const std::vector<TargetMix>& mixes, bool round_targets, uint64_t texel_side) {
  LACERTA_RETURN_IF_ERROR(plain.status());
  MorphChannels result;
  if (round_targets) result.tolerance_ = {kShareOfOffsets * plain.error(), kShareOfOffsets * plain.attribute_targets().normal_degrees / kDegreesPerRadian};
  std::vector<MorphedPrimitive> originals;
  size_t num_targets = 0;
  for (size_t m = 0; m < targets.size(); ++m) {
    const Primitive& primitive = *plain.primitives()[m];
    originals.push_back({&primitive, targets[m]});
    if (targets[m]->empty()) {
      result.primitives_.push_back(primitive);
      continue;
    }
    if (num_targets > 0 && targets[m]->size() != num_targets)
      return Unsupported("its parts have unlike numbers of morph targets");
    num_targets = targets[m]->size();
    LACERTA_ASSIGN_OR_RETURN(Primitive with, WithChannels(primitive, *targets[m]));
    result.primitives_.push_back(std::move(with));
  }
  result.meter_ =
      std::make_unique<const FamilyMeter>(PointersTo(result.primitives_), plain.error(), plain.attribute_targets(),
                                          texel_side, plain.texels_per_unit(), plain.skin());
  LACERTA_RETURN_IF_ERROR(result.meter_->status());
  LACERTA_ASSIGN_OR_RETURN(result.positions_, MorphMeter::Create(originals, mixes));
  const AttributedMesh directions = DirectionsApart(result.meter_->original());
  if (!directions.attributes.empty()) {
    LACERTA_ASSIGN_OR_RETURN(result.directions_,
                             SurfaceErrorMeter::Create(directions, static_cast<double>(texel_side)));
  }
  return result;
}

Status MorphChannels::Measure(const AttributedMesh& mesh, uint64_t num_samples, SurfaceErrors* errors) const {
  constexpr uint64_t kShare = 4, kFewest = 3000;  // of the samples, with each target
  SurfaceErrors apart;
  if (directions_.has_value()) {
    LACERTA_ASSIGN_OR_RETURN(apart, directions_->Measure(DirectionsApart(mesh), num_samples));
  }
  size_t next = 0;  // of those apart
  for (size_t a = 0; a < mesh.attributes.size(); ++a) {
    AttributeError& error = errors->attributes[a];
    if (IsOfPositions(mesh.attributes[a])) error.rms = error.rms_99 = 0.0;  // raised by mixes below
    if (!IsOfDirections(mesh.attributes[a])) continue;
    error = apart.attributes[next++];
    for (size_t t = 1; t < mesh.attributes[a].components / 3; ++t, ++next) {
      if (apart.attributes[next].rms_99 > error.rms_99) error = apart.attributes[next];
    }
  }
  for (size_t m = 0; m < positions_->mixes().size(); ++m) {
    const TargetMix& mix = positions_->mixes()[m];
    LACERTA_ASSIGN_OR_RETURN(const double distance, positions_->Distance(m, Morphed(mesh, mix), std::max(num_samples / kShare, kFewest)));
    for (size_t a = 0; a < mesh.attributes.size(); ++a) {
      AttributeError& error = errors->attributes[a];
      if (IsOfPositions(mesh.attributes[a]) && !WeightsIn(mix, mesh.attributes[a]).empty()) error.rms = error.rms_99 = std::max(error.rms, distance);
    }
  }
  return Status();
}

std::vector<std::vector<MorphTarget>> MorphChannels::PlainTargets(const AttributedBase& base) const {
  std::vector<std::vector<MorphTarget>> groups;
  size_t face = 0, first_vertex = 0;
  for (size_t g = 0; g < base.group_sizes.size(); ++g) {
    size_t end = first_vertex;
    for (const size_t last = face + base.group_sizes[g]; face < last; ++face) {
      for (const uint32_t v : base.mesh.triangles[face]) end = std::max(end, size_t{v} + 1);
    }
    VertexSoup soup;
    soup.positions.resize(end - first_vertex);
    for (const BaseAttribute& attribute : base.attributes) {
      if (attribute.in_group[g] == 0 || !ParseTargetChannels(attribute.precision.name).has_value()) continue;
      const uint32_t n = attribute.precision.components;
      VertexSoup::Attribute values{attribute.precision.name, attribute.precision.kind, n, {}};
      for (size_t i = first_vertex * n; i < end * n; ++i)
        values.values.push_back(static_cast<float>(attribute.values[i]) * attribute.precision.step);
      soup.attributes.push_back(std::move(values));
    }
    first_vertex = end;
    groups.emplace_back();
    const auto targets = TakeTargetChannels(&soup);
    for (const std::vector<VertexSoup::Attribute>& target : targets.value()) {
      groups.back().emplace_back();
      for (const VertexSoup::Attribute& offsets : target) {
        std::vector<float> values = offsets.values;
        if (offsets.name == "POSITION") DropUpTo(meter_->error(), &values);
        groups.back().back().push_back({offsets.name, MakeFloatAccessor(values, 3)});
      }
    }
    groups.back() = RoundTargets(std::move(groups.back()), tolerance_);
  }
  return groups;
}

uint64_t MorphChannels::BytesOfPlainTargets(const AttributedBase& base) const {
  uint64_t sum = 0;
  for (const std::vector<MorphTarget>& targets : PlainTargets(base)) sum += BytesOfTargets(targets);
  return sum;
}

}  // namespace lacerta
