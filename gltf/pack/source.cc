#include "pack/source.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "document/buffer_edit.h"
#include "document/lattice.h"
#include "document/meshopt.h"
#include "document/normals.h"
#include "extension/progressive.h"
#include "pack/accessor_pool.h"
#include "pack/repair.h"
#include "pack/unused_attributes.h"

namespace lacerta {
namespace {

// Of an accessor that takes `bytes`, or where its view is compressed its part of that.
uint64_t SizeOf(const GltfDocument& document, const Json* reference, const AccessorData& data, uint64_t bytes) {
  const Json* accessor = FindElement(document.json, "accessors", AsIndex(reference).value_or(~uint64_t{0}));
  const std::optional<uint64_t> view = accessor == nullptr ? std::nullopt : AsIndex(Find(*accessor, "bufferView"));
  const std::optional<double> share = view.has_value() ? CompressedShare(document, *view) : std::nullopt;
  if (!share.has_value()) return bytes;
  const uint64_t size = data.components * ComponentSize(data.type);
  const uint64_t stride = AsIndex(Find(*FindElement(document.json, "bufferViews", *view), "byteStride")).value_or(size);
  return static_cast<uint64_t>(*share * static_cast<double>(data.count * stride));
}

// Sets the bytes of `source`. other_users: by accessor.
void CountBytes(const GltfDocument& document, const std::vector<uint64_t>& other_users, const Json& json, const Primitive& primitive,
                const std::vector<MorphTarget>& targets, Source* source) {
  const auto add = [&](const Json* reference, const AccessorData& data, uint64_t stored) {
    const uint64_t bytes = SizeOf(document, reference, data, stored), index = AsIndex(reference).value_or(~uint64_t{0});
    source->stored_bytes += bytes;
    if (index < other_users.size() && other_users[static_cast<size_t>(index)] > 0) source->held_bytes += bytes;
  };
  for (size_t t = 0; t < targets.size(); ++t) {
    const Json& references = *FindElement(json, "targets", t);
    for (const Attribute& attribute : targets[t]) {
      add(Find(references, attribute.name.c_str()), attribute.data, StoredSize(attribute.data));
    }
  }
  const Json* draco = FindExtension(json, kDracoName);
  if (draco != nullptr) {
    const StatusOr<Span<const uint8_t>> bytes =
        BufferViewBytes(document, AsIndex(Find(*draco, "bufferView")).value_or(0));
    source->stored_bytes += bytes.ok() ? bytes.value().size() : 0;
  }
  for (const Attribute& attribute : primitive.attributes) {
    if (draco != nullptr && Find(*Find(*draco, "attributes"), attribute.name.c_str()) != nullptr) continue;
    const Json* reference = Find(*Find(json, "attributes"), attribute.name.c_str());
    add(reference, attribute.data, attribute.data.bytes.size());
  }
  if (const Json* index = Find(json, "indices"); draco == nullptr && AsIndex(index).has_value()) {
    const StatusOr<AccessorData> indices = ReadAccessor(document, *AsIndex(index));
    if (indices.ok()) add(index, indices.value(), indices.value().bytes.size());
  }
}

void RoundAnew(Primitive* primitive) {
  for (Attribute& attribute : primitive->attributes) {
    const std::string& name = attribute.name;
    if (name == "POSITION" || name == "NORMAL" || name == "TANGENT" || name.rfind("TEXCOORD_", 0) == 0) {
      attribute.data = AsFloat(attribute.data);
    }
  }
}

// Takes NORMAL off where it says what its absence says: flat shading. Tangents, normal maps, and normals that targets move, need it.
void TakeOffFlatNormals(const GltfDocument& document, Source* source) {
  Primitive& primitive = *source->primitive;
  const Attribute* normal = primitive.Find("NORMAL");
  const bool has_map = !IsUnused(document, source->places, "TANGENT");
  if (normal == nullptr || normal->data.components != 3 || has_map || primitive.Find("TANGENT") != nullptr || !source->targets.empty()) return;
  const auto position_at = [&](uint32_t v) { return VectorAt(primitive.attributes[0].data, v); };
  if (NormalsAreFlat(primitive.triangles, position_at, primitive.triangles, [&](uint32_t v) { return VectorAt(normal->data, v); })) {
    primitive.attributes.erase(primitive.attributes.begin() + (normal - primitive.attributes.data()));
  }
}

// Takes off what is_idle(attribute) says, unless a target would be left with nothing; whether it did.
template <typename IsIdle>
bool TakeOffTargets(const IsIdle& is_idle, std::vector<MorphTarget>* targets) {
  if (std::any_of(targets->begin(), targets->end(), [&](const MorphTarget& t) { return std::all_of(t.begin(), t.end(), is_idle); })) return false;
  for (MorphTarget& target : *targets) target.erase(std::remove_if(target.begin(), target.end(), is_idle), target.end());
  return true;
}

// Takes off what moves nothing in any target, as programs write it for normals and tangents that they do not morph: it is what its
// absence says. Offsets of positions stay.
void TakeOffZeroOffsets(std::vector<MorphTarget>* targets) {
  std::set<std::string> kept = {"POSITION"};
  for (const MorphTarget& target : *targets) {
    for (const Attribute& attribute : target) {
      for (uint64_t v = 0; v < attribute.data.count && kept.count(attribute.name) == 0; ++v) {
        for (uint32_t c = 0; c < attribute.data.components; ++c) {
          if (attribute.data.Float(v, c) != 0.0f) kept.insert(attribute.name);
        }
      }
    }
  }
  TakeOffTargets([&](const Attribute& attribute) { return kept.count(attribute.name) == 0; }, targets);
}

void TakeOff(const DroppedAttributes& dropped, const GltfDocument& document, Source* source) {
  const bool no_tangents = dropped.tangents && AreTangentsDerivable(document, source->places);
  const auto is_dropped = [&](const Attribute& attribute) {
    return (dropped.unused && IsUnused(document, source->places, attribute.name)) || (no_tangents && attribute.name == "TANGENT");
  };
  if (!TakeOffTargets(is_dropped, &source->targets)) return;
  std::vector<Attribute>& attributes = source->primitive->attributes;
  attributes.erase(std::remove_if(attributes.begin(), attributes.end(), is_dropped), attributes.end());
}

// source: its places are set.
Status ReadSource(const GltfDocument& document, const std::vector<uint64_t>& other_users, const DroppedAttributes& dropped, Source* source) {
  const Json& json = PrimitiveAt(document, source->places[0]);
  source->reason = ReasonToKeep(json);
  if (!source->reason.empty()) return Status();
  StatusOr<Primitive> primitive = ReadPrimitive(document, json, DecodeLimits{});
  StatusOr<std::vector<MorphTarget>> targets = std::vector<MorphTarget>();
  if (primitive.ok()) targets = ReadTargets(document, json, primitive.value().num_vertices);
  for (const Status& status : {primitive.status(), targets.status()}) {
    if (status.code() == StatusCode::kUnsupported) source->reason = status.message();
    if (!status.ok()) return status.code() == StatusCode::kUnsupported ? Status() : status;
  }
  LACERTA_RETURN_IF_ERROR(CheckFinite(json, primitive.value(), targets.value()));
  CountBytes(document, other_users, json, primitive.value(), targets.value(), source);
  source->primitive = std::move(primitive).value();
  source->targets = std::move(targets).value();
  RoundAnew(&*source->primitive);
  TakeOffZeroOffsets(&source->targets);
  TakeOff(dropped, document, source);
  TakeOffFlatNormals(document, source);
  return Status();
}

uint64_t Hash(const void* data, size_t size, uint64_t hash) {
  for (size_t i = 0; i < size; ++i) hash = (hash ^ static_cast<const uint8_t*>(data)[i]) * 0x100000001b3;  // FNV-1a
  return hash;
}

uint64_t Hash(const Primitive& primitive) {
  uint64_t hash = Hash(primitive.triangles.data(), primitive.triangles.size() * sizeof(Triangle), 0xcbf29ce484222325);
  for (const Attribute& a : primitive.attributes) hash = Hash(a.data.bytes.data(), a.data.bytes.size(), hash);
  return hash;
}

bool Same(const Primitive& a, const Primitive& b) {
  const auto same = [](const Attribute& x, const Attribute& y) {
    return x.name == y.name && x.data.type == y.data.type && x.data.components == y.data.components &&
           x.data.normalized == y.data.normalized && x.data.bytes == y.data.bytes;
  };
  return a.num_vertices == b.num_vertices && a.triangles == b.triangles &&
         std::equal(a.attributes.begin(), a.attributes.end(), b.attributes.begin(), b.attributes.end(), same);
}

// One source for all with the same content. Targets are not compared: morphed surfaces are seldom there twice.
std::vector<Source> Merge(std::vector<Source> sources) {
  std::vector<Source> merged;
  std::multimap<uint64_t, size_t> by_hash;
  for (Source& source : sources) {
    size_t same = merged.size();
    if (source.primitive.has_value() && source.targets.empty()) {
      const uint64_t hash = Hash(*source.primitive);
      const auto [begin, end] = by_hash.equal_range(hash);
      for (auto i = begin; i != end && same == merged.size(); ++i) {
        if (Same(*merged[i->second].primitive, *source.primitive)) same = i->second;
      }
      if (same == merged.size()) by_hash.emplace(hash, same);
    }
    if (same == merged.size()) {
      merged.push_back(std::move(source));
    } else {
      Source& known = merged[same];
      known.places.insert(known.places.end(), source.places.begin(), source.places.end());
      known.held_bytes += source.held_bytes;
      known.geometries.insert(known.geometries.end(), source.geometries.begin(), source.geometries.end());
    }
  }
  return merged;
}

}  // namespace

std::string ReasonToKeep(const Json& primitive) {
  if (AsIndex(Find(primitive, "mode")).value_or(4) < 4) return "holds points or lines";
  if (const Json* extensions = Find(primitive, "extensions"); extensions != nullptr && extensions->is_object()) {
    for (const auto& [name, value] : extensions->items()) {
      if (name != kDracoName && name != "KHR_materials_variants")
        return "has the extension " + name + ", which may refer to its vertices";
    }
  }
  return "";
}

StatusOr<std::vector<MorphTarget>> ReadTargets(const GltfDocument& document, const Json& json, uint64_t num_vertices) {
  std::vector<MorphTarget> targets;
  for (uint64_t t = 0; t < ArraySize(json, "targets"); ++t) {
    const Json& attributes = *FindElement(json, "targets", t);
    const std::string where = "morph target " + std::to_string(t);
    if (!attributes.is_object()) return InvalidData(where + " is no object");
    MorphTarget target;
    for (const auto& [name, index] : attributes.items()) {
      const std::optional<uint64_t> accessor = AsIndex(&index);
      if (!accessor.has_value()) return InvalidData(where + ": " + name + " is no accessor index");
      StatusOr<AccessorData> data = ReadAccessor(document, *accessor);
      if (!data.ok()) return data.status().WithContext(where + ": " + name);
      if (data.value().count != num_vertices) {
        return InvalidData(where + ": " + name + " has " + std::to_string(data.value().count) +
                           " elements, the primitive has " + std::to_string(num_vertices) + " vertices");
      }
      target.push_back({name, std::move(data).value()});
    }
    targets.push_back(std::move(target));
  }
  return targets;
}

StatusOr<std::vector<Source>> ReadSources(const GltfDocument& document, const DroppedAttributes& dropped) {
  const std::vector<uint64_t> other_users = CountOtherUsers(document);
  std::vector<Source> sources;
  for (const std::vector<Place>& places : GroupByGeometry(document)) {
    Source source;
    source.places = places;
    source.geometries = {places[0]};
    const Status status = ReadSource(document, other_users, dropped, &source);
    if (!status.ok()) return status.WithContext(PlaceName(document, places[0]));
    sources.push_back(std::move(source));
  }
  return Merge(std::move(sources));
}

std::map<uint64_t, std::vector<uint64_t>> NodesByMesh(const GltfDocument& document, const std::vector<const Source*>& sources) {
  std::map<uint64_t, std::vector<uint64_t>> nodes_by_mesh;
  for (const Source* source : sources) {
    for (const Place& place : source->places) nodes_by_mesh[place.mesh];
  }
  for (uint64_t n = 0; n < ArraySize(document.json, "nodes"); ++n) {
    const std::optional<uint64_t> mesh = AsIndex(Find(*FindElement(document.json, "nodes", n), "mesh"));
    const auto known = mesh.has_value() ? nodes_by_mesh.find(*mesh) : nodes_by_mesh.end();
    if (known != nodes_by_mesh.end()) known->second.push_back(n);
  }
  return nodes_by_mesh;
}

}  // namespace lacerta
