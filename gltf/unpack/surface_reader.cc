#include "unpack/surface_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "decoder/smooth_normals.h"
#include "document/accessor.h"
#include "document/view_references.h"
#include "document/draco_primitive.h"

namespace lacerta {
namespace {

// Decoders may differ in the last bits of a float, editors change far more.
bool Near(const Bounds& a, const Bounds& b) {
  const float tolerance = 1e-5f * (Norm(a.max - a.min) + Norm(a.min) + Norm(a.max));
  return Norm(a.min - b.min) <= tolerance && Norm(a.max - b.max) <= tolerance;
}

bool AccessorVec3(const Json& accessor, const char* key, Vec3f* value) {
  for (uint64_t axis = 0; axis < 3; ++axis) {
    const std::optional<double> number = AsNumber(FindElement(accessor, key, axis));
    if (!number.has_value()) return false;
    (*value)[static_cast<int>(axis)] = static_cast<float>(*number);
  }
  return true;
}

// The fallback must still be the base of the stream, else somebody changed the one without knowing of the other.
Status CheckFallback(const GltfDocument& document, const Json& primitive, Span<const uint8_t> base_bytes,
                     const std::vector<Vec3f>& base_positions) {
  const Status edited =
      InvalidData("the fallback geometry is no longer the base of the stream; a tool that does not know " +
                  std::string(kProgressiveName) + " edited the asset");
  if (const Json* draco = FindExtension(primitive, kDracoName); draco != nullptr) {
    LACERTA_ASSIGN_OR_RETURN(const uint64_t view, GetIndex(*draco, "bufferView"));
    LACERTA_ASSIGN_OR_RETURN(const Span<const uint8_t> bytes, BufferViewBytes(document, view));
    if (bytes.size() != base_bytes.size() || std::memcmp(bytes.data(), base_bytes.data(), bytes.size()) != 0)
      return edited;
  }
  const Json* attributes = Find(primitive, "attributes");
  const std::optional<uint64_t> index = attributes == nullptr ? std::nullopt : AsIndex(Find(*attributes, "POSITION"));
  const Json* accessor = index.has_value() ? FindElement(document.json, "accessors", *index) : nullptr;
  Bounds bounds;
  if (accessor == nullptr || !AccessorVec3(*accessor, "min", &bounds.min) ||
      !AccessorVec3(*accessor, "max", &bounds.max)) {
    return InvalidData("the fallback has no accessor POSITION with min and max");
  }
  if (!Near(BoundsOf(base_positions), bounds)) return edited;
  return Status();
}

bool HasFallback(const GltfDocument& document, const Json& primitive) {
  if (FindExtension(primitive, kDracoName) != nullptr) return true;
  const Json* attributes = Find(primitive, "attributes");
  const std::optional<uint64_t> index = attributes == nullptr ? std::nullopt : AsIndex(Find(*attributes, "POSITION"));
  return index.has_value() && !ViewsOfAccessor(document, *index).empty();
}

StatusOr<TriangleMesh> DecodeBase(const GatheredStream& stream, const DecodeLimits& limits) {
  DecodeOptions options;
  options.max_level = 0;
  options.limits = limits;
  LACERTA_ASSIGN_OR_RETURN(DecodedMesh base, DecodeMesh(stream.bytes, options));
  return std::move(base.mesh);
}

// limited: the decoder was told to stop at a level, and states of a stream with quality layers are not those that the asset announces.
Status CheckCounts(const ProgressiveStream& announced, const DecodedMesh& decoded, bool limited) {
  const auto state = static_cast<size_t>(decoded.state);
  if (decoded.has_layers && limited) return Status();
  if (state >= announced.vertex_counts.size() || announced.vertex_counts[state] != decoded.mesh.positions.size() ||
      announced.triangle_counts[state] != decoded.mesh.triangles.size()) {
    return InvalidData("level " + std::to_string(decoded.level) +
                       " of the stream does not have the size that the asset announces");
  }
  const bool finest = state + 1 == announced.vertex_counts.size();
  if (finest && !Near(BoundsOf(decoded.mesh.positions), {announced.min, announced.max})) {
    return InvalidData("the finest level does not have the bounds that the asset announces");
  }
  return Status();
}

// A group of a stream with attributes.
StatusOr<ProgressiveSurface> ReadGroup(const GltfDocument& document, const GatheredStream& stream,
                                       const ProgressiveStream& announced, uint64_t index, uint64_t group,
                                       const Json& primitive, const UnpackOptions& options, AttributedCache* cache) {
  if (group >= announced.base_lengths.size())
    return InvalidData("group " + std::to_string(group) + " of stream " + std::to_string(index) + " does not exist");
  const Span<const uint8_t> part = BaseParts(stream, announced)[static_cast<size_t>(group)];
  if (HasFallback(document, primitive)) {
    LACERTA_ASSIGN_OR_RETURN(const Primitive base, DecodeDracoPrimitive(part, {{"POSITION", 0}}, options.limits));
    LACERTA_RETURN_IF_ERROR(CheckFallback(document, primitive, part, Surface(base).positions));
  }
  const StatusOr<AttributedLevel>& decoded = cache->Get(index, stream, announced, options);
  if (!decoded.ok()) return decoded.status();
  const VertexSoup& soup = decoded.value().groups[static_cast<size_t>(group)];
  ProgressiveSurface surface;
  surface.surface = {soup.positions, soup.triangles};
  surface.attributes = soup.attributes;
  surface.targets = decoded.value().targets[static_cast<size_t>(group)];
  if (surface.targets.size() != ArraySize(primitive, "targets"))
    return InvalidData("the stream has " + std::to_string(surface.targets.size()) + " morph targets, the primitive " +
                       std::to_string(ArraySize(primitive, "targets")));
  surface.level = decoded.value().level;
  surface.num_levels = static_cast<int>(announced.vertex_counts.size()) - 1;
  if (surface.level < std::min(options.level.value_or(surface.num_levels), surface.num_levels)) {
    const Status& refinement = decoded.value().refinement;
    surface.note = "decoded to level " + std::to_string(surface.level) + " of " + std::to_string(surface.num_levels) + ": " +
                   (refinement.ok() ? "the rest of the data was cut off" : refinement.message());
  }
  return surface;
}

StatusOr<ProgressiveSurface> ReadStream(const GltfDocument& document, const StatusOr<Progressive>& progressive,
                                        const Json& primitive, const UnpackOptions& options, AttributedCache* cache) {
  if (!progressive.ok()) return progressive.status();
  const Json& extension = *FindExtension(primitive, kProgressiveName);
  LACERTA_ASSIGN_OR_RETURN(const uint64_t index, GetIndex(extension, "stream"));
  LACERTA_ASSIGN_OR_RETURN(const uint64_t group, GetIndex(extension, "group", 0));
  if (index >= progressive.value().streams.size())
    return InvalidData("stream " + std::to_string(index) + " does not exist");
  const ProgressiveStream& announced = progressive.value().streams[static_cast<size_t>(index)];
  LACERTA_ASSIGN_OR_RETURN(const GatheredStream stream, GatherStream(document, progressive.value(), index));
  if (!announced.base_lengths.empty()) return ReadGroup(document, stream, announced, index, group, primitive, options, cache);
  if (group != 0) return InvalidData("group " + std::to_string(group) + " of stream " + std::to_string(index) + " does not exist");
  if (HasFallback(document, primitive)) {
    LACERTA_ASSIGN_OR_RETURN(const TriangleMesh base, DecodeBase(stream, options.limits));
    const auto base_length = static_cast<size_t>(std::min<uint64_t>(stream.base_length, stream.bytes.size()));
    LACERTA_RETURN_IF_ERROR(
        CheckFallback(document, primitive, Span<const uint8_t>(stream.bytes).First(base_length), base.positions));
  }
  DecodeOptions decode;
  decode.max_level = options.level;
  decode.limits = options.limits;
  LACERTA_ASSIGN_OR_RETURN(DecodedMesh decoded, DecodeMesh(stream.bytes, decode));
  LACERTA_RETURN_IF_ERROR(CheckCounts(announced, decoded, options.level.has_value()));
  ProgressiveSurface surface;
  surface.level = decoded.level;
  const int num_states = static_cast<int>(announced.vertex_counts.size()) - 1;
  surface.num_levels = decoded.has_layers ? decoded.num_levels : num_states;
  surface.smooth_normals = announced.smooth_normals;
  surface.surface = std::move(decoded.mesh);
  const int wanted = std::min(options.level.value_or(surface.num_levels), surface.num_levels);
  if (decoded.has_layers && !decoded.refinement.ok()) {
    surface.note = "decoded to quality " + std::to_string(decoded.state) + " of " + std::to_string(num_states) + ": " + decoded.refinement.message();
  } else if (surface.level < wanted) {
    surface.note = "decoded to level " + std::to_string(surface.level) + " of " + std::to_string(surface.num_levels) +
                   ": " + (decoded.refinement.ok() ? "the rest of the data was cut off" : decoded.refinement.message());
  }
  return surface;
}

}  // namespace

Bounds BoundsOf(const std::vector<Vec3f>& positions) {
  Bounds bounds;
  if (positions.empty()) return bounds;
  bounds = {positions[0], positions[0]};
  for (const Vec3f& position : positions) {
    for (int axis = 0; axis < 3; ++axis) {
      bounds.min[axis] = std::min(bounds.min[axis], position[axis]);
      bounds.max[axis] = std::max(bounds.max[axis], position[axis]);
    }
  }
  return bounds;
}

StatusOr<ProgressiveSurface> ReadRefinedSurface(const GltfDocument& document, const StatusOr<Progressive>& progressive,
                                                const Place& place, const UnpackOptions& options, AttributedCache* cache) {
  const Json& primitive = PrimitiveAt(document, place);
  StatusOr<ProgressiveSurface> surface = ReadStream(document, progressive, primitive, options, cache);
  if (!surface.ok()) {
    if (!HasFallback(document, primitive)) return surface.status();
    ProgressiveSurface drawn;
    drawn.from_fallback = true;
    drawn.note = "the fallback is used: " + surface.status().message();
    surface = std::move(drawn);
  }
  surface.value().mesh = place.mesh;
  surface.value().primitive = place.primitive;
  return surface;
}

StatusOr<ProgressiveSurface> ReadSurface(const GltfDocument& document, const StatusOr<Progressive>& progressive,
                                         const Place& place, const UnpackOptions& options, AttributedCache* cache) {
  LACERTA_ASSIGN_OR_RETURN(ProgressiveSurface surface, ReadRefinedSurface(document, progressive, place, options, cache));
  if (!surface.from_fallback) return surface;
  StatusOr<Primitive> fallback = ReadPrimitive(document, PrimitiveAt(document, place), options.limits);
  if (!fallback.ok()) return fallback.status().WithContext(surface.note + "; but it is damaged too");
  surface.surface = Surface(fallback.value());
  return surface;
}

AccessorData ToAccessor(const VertexSoup::Attribute& attribute) {
  AccessorData data = MakeFloatAccessor(attribute.values, attribute.components);
  if (attribute.name != kJointsName) return data;
  const bool is_short = std::any_of(attribute.values.begin(), attribute.values.end(),
                                    [](float joint) { return joint > std::numeric_limits<uint8_t>::max(); });
  data.type = is_short ? ComponentType::kUint16 : ComponentType::kUint8;
  data.bytes.clear();
  for (const float joint : attribute.values) {
    const auto index = static_cast<uint16_t>(joint);
    data.bytes.push_back(static_cast<uint8_t>(index));
    if (is_short) data.bytes.push_back(static_cast<uint8_t>(index >> 8));
  }
  return data;
}

std::vector<MorphTarget> ToTargets(const ProgressiveSurface& surface) {
  std::vector<MorphTarget> targets;
  for (const std::vector<VertexSoup::Attribute>& target : surface.targets) {
    targets.emplace_back();
    for (const VertexSoup::Attribute& offsets : target) targets.back().push_back({offsets.name, ToAccessor(offsets)});
  }
  return targets;
}

Primitive ToPrimitive(const ProgressiveSurface& surface) {
  const TriangleMesh& mesh = surface.surface;
  Primitive primitive{mesh.positions.size(), mesh.triangles, {{"POSITION", MakeFloatAccessor(mesh.positions)}}};
  if (surface.smooth_normals) primitive.attributes.push_back({"NORMAL", MakeFloatAccessor(SmoothNormals(mesh.positions, mesh.triangles))});
  for (const VertexSoup::Attribute& attribute : surface.attributes) {
    primitive.attributes.push_back({attribute.name, ToAccessor(attribute)});
  }
  return primitive;
}

}  // namespace lacerta
