#include "document/materials.h"

#include <optional>
#include <set>

namespace lacerta {
namespace {

void AddMaterial(const Json& object, std::set<uint64_t>* indices) {
  if (const std::optional<uint64_t> index = AsIndex(Find(object, "material"))) indices->insert(*index);
}

}  // namespace

std::vector<const Json*> MaterialsOf(const GltfDocument& document, const std::vector<Place>& places) {
  std::set<uint64_t> indices;
  for (const Place& place : places) {
    const Json& primitive = PrimitiveAt(document, place);
    AddMaterial(primitive, &indices);
    const Json* variants = FindExtension(primitive, "KHR_materials_variants");
    for (uint64_t i = 0; variants != nullptr && i < ArraySize(*variants, "mappings"); ++i) {
      AddMaterial(*FindElement(*variants, "mappings", i), &indices);
    }
  }
  std::vector<const Json*> materials;
  for (const uint64_t index : indices) {
    if (const Json* material = FindElement(document.json, "materials", index); material != nullptr) materials.push_back(material);
  }
  return materials;
}

void VisitTextures(const Json& material, const std::string& pointer, const std::function<void(const std::string& pointer, const Json& texture)>& visit) {
  if (!material.is_structured()) return;
  for (const auto& [key, value] : material.items()) {
    const std::string at = pointer + "/" + key;
    if (value.is_object() && Find(value, "index") != nullptr) visit(at, value);
    VisitTextures(value, at, visit);
  }
}

uint64_t TexCoordOf(const Json& texture) {
  const uint64_t set = AsIndex(Find(texture, "texCoord")).value_or(0);
  const Json* transform = FindExtension(texture, "KHR_texture_transform");
  return transform == nullptr ? set : AsIndex(Find(*transform, "texCoord")).value_or(set);
}

}  // namespace lacerta
