#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

#include "document/buffer_edit.h"
#include "document/merge_buffers.h"
#include "document/embed_images.h"
#include "document/gltf_document.h"
#include "document/lattice.h"
#include "document/place.h"
#include "document/primitive.h"
#include "extension/progressive.h"
#include "lacerta/gltf.h"
#include "pack/accessor_pool.h"
#include "pack/replace_geometry.h"
#include "pack/round_targets.h"
#include "pack/source.h"
#include "unpack/surface_reader.h"

namespace lacerta {
namespace {

// Scales the first three numbers of every element to length 1.
void Normalize(AccessorData* data) {
  for (uint64_t i = 0; i < data->count; ++i) {
    float values[3] = {};
    double norm = 0.0;
    for (uint32_t c = 0; c < 3; ++c) {
      values[c] = data->Float(i, c);
      norm += static_cast<double>(values[c]) * values[c];
    }
    norm = std::sqrt(norm);
    if (!(norm > 0.0)) continue;
    for (float& value : values) value = static_cast<float>(value / norm);
    std::memcpy(data->bytes.data() + i * data->components * sizeof(float), values, sizeof(values));
  }
}

// Scales what all sets of weights have at a vertex to the sum 1; each was rounded by itself.
void NormalizeWeights(Primitive* primitive) {
  std::vector<AccessorData*> sets;
  for (Attribute& attribute : primitive->attributes) {
    if (attribute.name.rfind("WEIGHTS_", 0) != 0) continue;
    if (attribute.data.type != ComponentType::kFloat) return;
    sets.push_back(&attribute.data);
  }
  for (uint64_t i = 0; i < primitive->num_vertices; ++i) {
    double sum = 0.0;
    for (const AccessorData* set : sets) {
      for (uint32_t c = 0; c < set->components; ++c) sum += static_cast<double>(set->Float(i, c));
    }
    if (!(sum > 0.0)) continue;
    for (AccessorData* set : sets) {
      for (uint32_t c = 0; c < set->components; ++c) {
        const auto weight = static_cast<float>(static_cast<double>(set->Float(i, c)) / sum);
        std::memcpy(set->bytes.data() + (i * set->components + c) * sizeof(float), &weight, sizeof(weight));
      }
    }
  }
}

// Quantization leaves normals, tangents and weights slightly off what glTF demands of them. Those of streams are of unit length but for
// tangents, whose signs are interpolated, too.
void RestoreTangents(Primitive* primitive) {
  for (Attribute& attribute : primitive->attributes) {
    AccessorData& data = attribute.data;
    if (attribute.name != "TANGENT" || data.components != 4 || data.type != ComponentType::kFloat) continue;
    Normalize(&data);
    for (uint64_t i = 0; i < data.count; ++i) {
      const float sign = data.Float(i, 3) < 0.0f ? -1.0f : 1.0f;
      std::memcpy(data.bytes.data() + (4 * i + 3) * sizeof(float), &sign, sizeof(sign));
    }
  }
}

// Fits and lattices go a little beyond the values that were there.
void RestoreColors(Primitive* primitive) {
  for (Attribute& attribute : primitive->attributes) {
    AccessorData& data = attribute.data;
    if (attribute.name.rfind("COLOR_", 0) != 0 || data.type != ComponentType::kFloat) continue;
    for (uint64_t i = 0; i < data.count * data.components; ++i) {
      float value = 0.0f;
      std::memcpy(&value, data.bytes.data() + i * sizeof(float), sizeof(float));
      value = std::clamp(value, 0.0f, 1.0f);
      std::memcpy(data.bytes.data() + i * sizeof(float), &value, sizeof(float));
    }
  }
}

// Slots without weight are those of joint 0.
void RestoreJoints(Primitive* primitive) {
  for (Attribute& attribute : primitive->attributes) {
    if (attribute.name.rfind("JOINTS_", 0) != 0) continue;
    const Attribute* weights = primitive->Find("WEIGHTS_" + attribute.name.substr(7));
    AccessorData& data = attribute.data;
    if (weights == nullptr || weights->data.components != data.components) continue;
    const size_t size = ComponentSize(data.type);
    for (uint64_t i = 0; i < data.count; ++i) {
      for (uint32_t c = 0; c < data.components; ++c) {
        if (weights->data.Float(i, c) == 0.0f) std::memset(data.bytes.data() + (i * data.components + c) * size, 0, size);
      }
    }
  }
}

// What all readers have to be shown, whichever way a primitive was stored.
void RestoreLegalValues(Primitive* primitive) {
  RestoreTangents(primitive);
  RestoreColors(primitive);
  RestoreJoints(primitive);
}

void RestoreUnits(Primitive* primitive) {
  for (Attribute& attribute : primitive->attributes) {
    AccessorData& data = attribute.data;
    if (data.type != ComponentType::kFloat) continue;
    if (attribute.name == "NORMAL" && data.components == 3) Normalize(&data);
  }
  NormalizeWeights(primitive);
  RestoreLegalValues(primitive);
}

void DropProgressive(GltfDocument* document) {
  if (Json* extensions = Find(document->json, "extensions"); extensions != nullptr && extensions->is_object()) {
    if (extensions->erase(kProgressiveName) > 0 && extensions->empty()) document->json.erase("extensions");
  }
  RemoveExtension("extensionsUsed", kProgressiveName, document);
  RemoveExtension("extensionsRequired", kProgressiveName, document);
}

// What a primitive in Draco form is in core glTF.
StatusOr<NewGeometry> FromDraco(const Json& primitive, const DecodeLimits& limits, GltfDocument* document) {
  LACERTA_ASSIGN_OR_RETURN(Primitive decoded, ReadPrimitive(*document, primitive, limits));
  StatusOr<std::vector<MorphTarget>> targets = ReadTargets(*document, primitive, decoded.num_vertices);
  RestoreUnits(&decoded);
  NewGeometry geometry = PlainGeometry(decoded, document);
  if (!targets.ok() || !AreQuantized(targets.value())) return geometry;  // which keeps them as they are, accessors without data too
  for (MorphTarget& target : targets.value()) {
    for (Attribute& offsets : target) offsets.data = AsFloat(offsets.data);
  }
  geometry.targets = TargetAccessors(targets.value(), document);
  return geometry;
}

}  // namespace

StatusOr<std::vector<ProgressiveSurface>> ReadProgressive(Span<const uint8_t> asset, const UnpackOptions& options) {
  LACERTA_ASSIGN_OR_RETURN(const GltfDocument document, ParseGltf(asset, options.folder));
  const StatusOr<Progressive> progressive = ParseProgressive(document);
  std::vector<ProgressiveSurface> surfaces;
  AttributedCache cache;
  for (const Place& place : AllPlaces(document)) {
    if (FindExtension(PrimitiveAt(document, place), kProgressiveName) == nullptr) continue;
    StatusOr<ProgressiveSurface> surface = ReadSurface(document, progressive, place, options, &cache);
    if (!surface.ok()) return surface.status().WithContext(PlaceName(document, place));
    surfaces.push_back(std::move(surface).value());
  }
  return surfaces;
}

StatusOr<UnpackResult> UnpackGltf(Span<const uint8_t> asset, const UnpackOptions& options) {
  LACERTA_ASSIGN_OR_RETURN(GltfDocument document, ParseGltf(asset, options.folder));
  const StatusOr<Progressive> progressive = ParseProgressive(document);
  const std::vector<std::vector<Place>> groups = GroupByGeometry(document);
  std::vector<Place> geometries;
  geometries.reserve(groups.size());
  for (const std::vector<Place>& places : groups) geometries.push_back(places[0]);
  std::set<uint64_t> unused_views = DracoViews(document);
  if (progressive.ok()) {
    unused_views.insert(progressive.value().data);
    if (progressive.value().refinements.has_value()) unused_views.insert(*progressive.value().refinements);
  }
  AccessorPool pool(document, geometries);
  UnpackResult result;
  if (options.embed_images) EmbedImages(ImageFiles::kEmbed, &document, &result.notes);
  AttributedCache cache;
  for (const std::vector<Place>& places : groups) {
    const Json primitive = PrimitiveAt(document, places[0]);
    Status status;
    if (FindExtension(primitive, kProgressiveName) != nullptr) {
      StatusOr<ProgressiveSurface> surface = ReadSurface(document, progressive, places[0], options, &cache);
      if (!surface.ok()) return surface.status().WithContext(PlaceName(document, places[0]));
      if (!surface.value().note.empty())
        result.notes.push_back(PlaceName(document, places[0]) + ": " + surface.value().note);
      Primitive plain = ToPrimitive(surface.value());
      RestoreLegalValues(&plain);
      NewGeometry geometry = PlainGeometry(plain, &document);
      geometry.targets = TargetAccessors(ToTargets(surface.value()), &document);
      ReplaceGeometry({places[0]}, places, std::move(geometry), &pool, &document);
    } else if (FindExtension(primitive, kDracoName) != nullptr) {
      StatusOr<NewGeometry> geometry = FromDraco(primitive, options.limits, &document);
      if (!geometry.ok()) return geometry.status().WithContext(PlaceName(document, places[0]));
      ReplaceGeometry({places[0]}, places, std::move(geometry).value(), &pool, &document);
    }
  }
  DropProgressive(&document);
  DeclareDraco(&document);
  DeclareQuantization(&document);
  unused_views.insert(pool.released_views().begin(), pool.released_views().end());
  DropUnusedViews(unused_views, &document);
  LACERTA_RETURN_IF_ERROR(MergeBuffers(&document));
  result.glb = FormatGlb(document);
  return result;
}

}  // namespace lacerta
