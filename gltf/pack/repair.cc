#include "pack/repair.h"

#include <cmath>
#include <cstring>
#include <optional>
#include <set>
#include <utility>

#include "decoder/smooth_normals.h"
#include "document/buffer_edit.h"
#include "document/place.h"
#include "pack/accessor_pool.h"
#include "pack/replace_geometry.h"

namespace lacerta {
namespace {

constexpr size_t kFloatSize = sizeof(float);

bool IsFloat(const Attribute& attribute) { return attribute.data.type == ComponentType::kFloat; }

bool IsFinite(const AccessorData& data, uint64_t element) {
  for (uint32_t c = 0; c < data.components; ++c) {
    if (!std::isfinite(data.Float(element, c))) return false;
  }
  return true;
}

std::optional<uint64_t> FirstNotFinite(const Attribute& attribute) {
  if (!IsFloat(attribute)) return std::nullopt;
  for (uint64_t v = 0; v < attribute.data.count; ++v) {
    if (!IsFinite(attribute.data, v)) return v;
  }
  return std::nullopt;
}

Status CheckOne(const Json* references, const Attribute& attribute) {
  const std::optional<uint64_t> vertex = FirstNotFinite(attribute);
  if (!vertex.has_value()) return Status();
  const std::optional<uint64_t> accessor = references == nullptr ? std::nullopt : AsIndex(Find(*references, attribute.name.c_str()));
  const std::string where = accessor.has_value() ? "accessor " + std::to_string(*accessor) + ": " : "";
  return InvalidData(where + attribute.name + ": vertex " + std::to_string(*vertex) + " is not finite; repair or remove it");
}

void Set(uint64_t element, uint32_t component, float value, AccessorData* data) {
  std::memcpy(data->bytes.data() + (element * data->components + component) * kFloatSize, &value, kFloatSize);
}

// Keeps the elements marked, in their order.
void Compact(const std::vector<uint8_t>& keep, AccessorData* data) {
  const size_t size = data->components * ComponentSize(data->type);
  size_t kept = 0;
  for (size_t v = 0; v < keep.size(); ++v) {
    if (keep[v] == 0) continue;
    std::memmove(data->bytes.data() + kept * size, data->bytes.data() + v * size, size);
    ++kept;
  }
  data->bytes.resize(kept * size);
  data->count = kept;
}

void RemoveVertices(Primitive* primitive, std::vector<MorphTarget>* targets, Repaired* repaired) {
  const AccessorData& positions = primitive->Find("POSITION")->data;
  std::vector<uint8_t> keep(static_cast<size_t>(primitive->num_vertices));
  std::vector<uint32_t> moved(keep.size());
  uint32_t kept = 0;
  for (size_t v = 0; v < keep.size(); ++v) {
    keep[v] = IsFinite(positions, v) ? 1 : 0;
    moved[v] = kept;
    kept += keep[v];
  }
  if (kept == keep.size()) return;
  std::vector<Triangle> triangles;
  for (const Triangle& t : primitive->triangles) {
    if (keep[t[0]] + keep[t[1]] + keep[t[2]] == 3) triangles.push_back({moved[t[0]], moved[t[1]], moved[t[2]]});
  }
  repaired->vertices = keep.size() - kept;
  repaired->triangles = primitive->triangles.size() - triangles.size();
  primitive->triangles = std::move(triangles);
  primitive->num_vertices = kept;
  for (Attribute& attribute : primitive->attributes) Compact(keep, &attribute.data);
  for (MorphTarget& target : *targets) {
    for (Attribute& attribute : target) Compact(keep, &attribute.data);
  }
}

// The vertices that share a triangle with each vertex, some of them several times.
struct Neighbors {
  std::vector<size_t> begins;  // #V + 1
  std::vector<uint32_t> vertices;
};

Neighbors FindNeighbors(const Primitive& primitive) {
  Neighbors neighbors;
  neighbors.begins.assign(static_cast<size_t>(primitive.num_vertices) + 1, 0);
  for (const Triangle& t : primitive.triangles) {
    for (const uint32_t v : t) neighbors.begins[v + 1] += 2;
  }
  for (size_t v = 0; v + 1 < neighbors.begins.size(); ++v) neighbors.begins[v + 1] += neighbors.begins[v];
  neighbors.vertices.resize(neighbors.begins.back());
  std::vector<size_t> next(neighbors.begins.begin(), neighbors.begins.end() - 1);
  for (const Triangle& t : primitive.triangles) {
    for (size_t i = 0; i < 3; ++i) {
      neighbors.vertices[next[t[i]]++] = t[(i + 1) % 3];
      neighbors.vertices[next[t[i]]++] = t[(i + 2) % 3];
    }
  }
  return neighbors;
}

// From those that have a value outwards, ring by ring; 0 where none of a component has any.
void FillFromNeighbors(const Primitive& primitive, std::vector<uint8_t> known, AccessorData* data) {
  const Neighbors neighbors = FindNeighbors(primitive);
  std::vector<uint8_t> is_due(known.size());  // in the next ring, or one before
  std::vector<uint32_t> ring, next;
  const auto add_around = [&](uint32_t v) {
    for (size_t n = neighbors.begins[v]; n < neighbors.begins[v + 1]; ++n) {
      const uint32_t neighbor = neighbors.vertices[n];
      if (known[neighbor] != 0 || is_due[neighbor] != 0) continue;
      is_due[neighbor] = 1;
      next.push_back(neighbor);
    }
  };
  for (uint32_t v = 0; v < known.size(); ++v) {
    if (known[v] != 0) add_around(v);
  }
  while (!next.empty()) {
    ring.swap(next);
    next.clear();
    for (const uint32_t v : ring) {
      double sums[4] = {};
      double count = 0;
      for (size_t n = neighbors.begins[v]; n < neighbors.begins[v + 1]; ++n) {
        const uint32_t neighbor = neighbors.vertices[n];
        if (known[neighbor] == 0) continue;
        for (uint32_t c = 0; c < data->components; ++c) sums[c] += data->Float(neighbor, c);
        ++count;
      }
      for (uint32_t c = 0; c < data->components; ++c) Set(v, c, static_cast<float>(sums[c] / count), data);
    }
    for (const uint32_t v : ring) known[v] = 1;
    for (const uint32_t v : ring) add_around(v);
  }
  for (uint32_t v = 0; v < known.size(); ++v) {
    for (uint32_t c = 0; c < data->components && known[v] == 0; ++c) Set(v, c, 0.0f, data);
  }
}

// Directions of unit length with a sign; where the mean is no direction, one across the normal as far as there is one.
void MakeTangents(const Primitive& primitive, const std::vector<uint8_t>& known, AccessorData* tangents) {
  const Attribute* normals = primitive.Find("NORMAL");
  for (uint64_t v = 0; v < tangents->count; ++v) {
    if (known[static_cast<size_t>(v)] != 0) continue;
    Vec3d tangent = Vec3Cast<double>(VectorAt(*tangents, v));
    if (!(Norm(tangent) > 0)) {
      const bool along_x = normals != nullptr && std::abs(normals->data.Float(v, 0)) > 0.9f;
      tangent = along_x ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    }
    tangent = Normalized(tangent);
    for (uint32_t c = 0; c < 3; ++c) Set(v, c, static_cast<float>(tangent[static_cast<int>(c)]), tangents);
    if (tangents->components == 4) Set(v, 3, tangents->Float(v, 3) < 0 ? -1.0f : 1.0f, tangents);
  }
}

bool IsWeights(const Attribute& attribute) { return attribute.name.rfind("WEIGHTS_", 0) == 0; }

// What is left keeps its proportions; a vertex that nothing moves any more hangs on its first joint.
void ScaleWeights(const std::vector<uint8_t>& was_finite, Primitive* primitive) {
  for (size_t v = 0; v < was_finite.size(); ++v) {
    if (was_finite[v] != 0) continue;
    double sum = 0;
    for (const Attribute& attribute : primitive->attributes) {
      if (!IsWeights(attribute)) continue;
      for (uint32_t c = 0; c < attribute.data.components; ++c) sum += attribute.data.Float(v, c);
    }
    for (Attribute& attribute : primitive->attributes) {
      if (!IsWeights(attribute) || !IsFloat(attribute)) continue;
      AccessorData& data = attribute.data;
      if (!(sum > 0) && attribute.name == "WEIGHTS_0") Set(v, 0, 1.0f, &data);
      for (uint32_t c = 0; c < data.components && sum > 0; ++c) Set(v, c, static_cast<float>(data.Float(v, c) / sum), &data);
    }
  }
}

// Sets components that are not finite to 0; which vertices had any.
uint64_t SetToZero(AccessorData* data, std::vector<uint8_t>* was_finite) {
  uint64_t count = 0;
  for (uint64_t v = 0; v < data->count; ++v) {
    if (IsFinite(*data, v)) continue;
    ++count;
    if (was_finite != nullptr) (*was_finite)[static_cast<size_t>(v)] = 0;
    for (uint32_t c = 0; c < data->components; ++c) {
      if (!std::isfinite(data->Float(v, c))) Set(v, c, 0.0f, data);
    }
  }
  return count;
}

uint64_t RepairValues(const Primitive& primitive, Attribute* attribute) {
  AccessorData& data = attribute->data;
  std::vector<uint8_t> known(static_cast<size_t>(data.count));
  uint64_t missing = 0;
  for (size_t v = 0; v < known.size(); ++v) {
    known[v] = IsFinite(data, v) ? 1 : 0;
    missing += known[v] == 0 ? 1 : 0;
  }
  if (missing == 0) return 0;
  if (attribute->name == "NORMAL" && data.components == 3) {
    const TriangleMesh surface = Surface(primitive);
    const std::vector<Vec3f> normals = SmoothNormals(surface.positions, surface.triangles);
    for (size_t v = 0; v < known.size(); ++v) {
      for (uint32_t c = 0; c < 3 && known[v] == 0; ++c) Set(v, c, normals[v][static_cast<int>(c)], &data);
    }
    return missing;
  }
  FillFromNeighbors(primitive, known, &data);
  if (attribute->name == "TANGENT" && data.components >= 3) MakeTangents(primitive, known, &data);
  return missing;
}

std::string Describe(const Repaired& repaired) {
  std::string text = "repaired: ";
  const char* separator = "";
  const auto add = [&](uint64_t count, const std::string& what) {
    if (count == 0) return;
    text += separator + std::to_string(count) + what;
    separator = ", ";
  };
  const std::string& triangles = std::to_string(repaired.triangles);
  add(repaired.vertices, " vertices without a finite position removed with " + triangles + " triangles");
  add(repaired.values, " attribute values that were not finite made from what is beside them");
  add(repaired.offsets, " offsets of morph targets that were not finite set to 0");
  return text;
}

Status RepairPlaces(const std::vector<Place>& places, AccessorPool* pool, GltfDocument* document, std::vector<std::string>* notes) {
  const Json json = PrimitiveAt(*document, places[0]);
  if (!ReasonToKeep(json).empty()) return Status();
  StatusOr<Primitive> primitive = ReadUncheckedPrimitive(*document, json, DecodeLimits{});
  if (primitive.status().code() == StatusCode::kUnsupported) return Status();
  LACERTA_RETURN_IF_ERROR(primitive.status());
  StatusOr<std::vector<MorphTarget>> targets = ReadTargets(*document, json, primitive.value().num_vertices);
  if (targets.status().code() == StatusCode::kUnsupported) return Status();
  LACERTA_RETURN_IF_ERROR(targets.status());
  LACERTA_ASSIGN_OR_RETURN(const Repaired repaired, RepairPrimitive(&primitive.value(), &targets.value()));
  if (!repaired.IsAny()) return Status();
  NewGeometry geometry = PlainGeometry(primitive.value(), document);
  geometry.targets = TargetAccessors(targets.value(), document);
  ReplaceGeometry({places[0]}, places, std::move(geometry), pool, document);
  notes->push_back(PlaceName(*document, places[0]) + ": " + Describe(repaired));
  return Status();
}

}  // namespace

Status CheckFinite(const Json& json, const Primitive& primitive, const std::vector<MorphTarget>& targets) {
  for (const Attribute& attribute : primitive.attributes) LACERTA_RETURN_IF_ERROR(CheckOne(Find(json, "attributes"), attribute));
  for (size_t t = 0; t < targets.size(); ++t) {
    for (const Attribute& attribute : targets[t]) {
      const Status status = CheckOne(FindElement(json, "targets", t), attribute);
      if (!status.ok()) return status.WithContext("morph target " + std::to_string(t));
    }
  }
  return Status();
}

StatusOr<Repaired> RepairPrimitive(Primitive* primitive, std::vector<MorphTarget>* targets) {
  Repaired repaired;
  RemoveVertices(primitive, targets, &repaired);
  if (repaired.triangles > 0 && primitive->triangles.empty()) return InvalidData("has no triangle with finite positions; it cannot be repaired");
  std::vector<uint8_t> was_finite(static_cast<size_t>(primitive->num_vertices), 1);
  for (Attribute& attribute : primitive->attributes) {
    if (!IsFloat(attribute)) continue;
    repaired.values += IsWeights(attribute) ? SetToZero(&attribute.data, &was_finite) : RepairValues(*primitive, &attribute);
  }
  ScaleWeights(was_finite, primitive);
  for (MorphTarget& target : *targets) {
    for (Attribute& attribute : target) {
      if (IsFloat(attribute)) repaired.offsets += SetToZero(&attribute.data, nullptr);
    }
  }
  return repaired;
}

StatusOr<std::vector<std::string>> RepairDocument(GltfDocument* document) {
  const std::vector<std::vector<Place>> groups = GroupByGeometry(*document);
  std::vector<Place> geometries;
  for (const std::vector<Place>& places : groups) geometries.push_back(places[0]);
  std::set<uint64_t> unused_views = DracoViews(*document);
  AccessorPool pool(*document, geometries);
  std::vector<std::string> notes;
  for (const std::vector<Place>& places : groups) {
    LACERTA_RETURN_IF_ERROR(RepairPlaces(places, &pool, document, &notes).WithContext(PlaceName(*document, places[0])));
  }
  if (notes.empty()) return notes;
  DeclareDraco(document);
  unused_views.insert(pool.released_views().begin(), pool.released_views().end());
  DropUnusedViews(unused_views, document);
  return notes;
}

}  // namespace lacerta
