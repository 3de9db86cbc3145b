#include "pack/texel_scale.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "document/image_size.h"

namespace lacerta {
namespace {

constexpr char kTransformName[] = "KHR_texture_transform";

// The largest scale of `set` in any textureInfo inside a material, which are the objects with "index".
double LargestScale(const Json& json, uint64_t set) {
  double largest = 1.0;
  if (!json.is_structured()) return largest;
  if (json.is_object() && Find(json, "index") != nullptr) {
    const Json* extensions = Find(json, "extensions");
    const Json* transform = extensions == nullptr ? nullptr : Find(*extensions, kTransformName);
    uint64_t shown = AsIndex(Find(json, "texCoord")).value_or(0);
    if (transform == nullptr) return largest;
    shown = AsIndex(Find(*transform, "texCoord")).value_or(shown);
    if (shown != set) return largest;
    for (uint64_t axis = 0; axis < 2; ++axis) {
      largest = std::max(largest, std::abs(AsNumber(FindElement(*transform, "scale", axis)).value_or(1.0)));
    }
    return largest;
  }
  for (const Json& element : json) largest = std::max(largest, LargestScale(element, set));
  return largest;
}

std::set<uint64_t> MaterialsOf(const Json& primitive) {
  std::set<uint64_t> materials;
  if (const std::optional<uint64_t> material = AsIndex(Find(primitive, "material"))) materials.insert(*material);
  if (const Json* variants = PrimitiveExtension(primitive, "KHR_materials_variants"); variants != nullptr) {
    for (uint64_t i = 0; i < ArraySize(*variants, "mappings"); ++i) {
      const std::optional<uint64_t> material = AsIndex(Find(*FindElement(*variants, "mappings", i), "material"));
      if (material.has_value()) materials.insert(*material);
    }
  }
  return materials;
}

}  // namespace

uint64_t TexelSide(const GltfDocument& document) {
  constexpr uint64_t kLeastSide = 1024;
  return std::max(LargestImageSide(document), kLeastSide);
}

double TexelsPerUnit(const GltfDocument& document, const std::vector<Place>& places, uint64_t set, uint64_t side) {
  constexpr double kMostRepeats = 1e4;  // an absurd transform shall not ask for absurd bits
  double scale = 1.0;
  for (const Place& place : places) {
    for (const uint64_t material : MaterialsOf(PrimitiveAt(document, place))) {
      const Json* json = FindElement(document.json, "materials", material);
      if (json != nullptr) scale = std::max(scale, LargestScale(*json, set));
    }
  }
  return std::min(scale, kMostRepeats) * static_cast<double>(side);
}

}  // namespace lacerta
