#include "pack/unused_attributes.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>

#include "document/materials.h"
#include "pack/source.h"

namespace lacerta {
namespace {

// The n of `name`, if that is PREFIX_n.
std::optional<uint64_t> SetOf(const std::string& name, const std::string& prefix) {
  const bool is_set = name.size() > prefix.size() && name.size() < prefix.size() + 10 && name.compare(0, prefix.size(), prefix) == 0 &&
                      std::all_of(name.begin() + static_cast<std::ptrdiff_t>(prefix.size()), name.end(), [](char c) { return c >= '0' && c <= '9'; });
  return is_set ? std::optional<uint64_t>(std::stoull(name.substr(prefix.size()))) : std::nullopt;
}

bool IsTextured(const GltfDocument& document, const std::vector<Place>& places, uint64_t set) {
  bool is_textured = set == 0 && UsesExtension(document.json, "VRM");  // names textures outside of materials
  for (const Json* material : MaterialsOf(document, places)) {
    VisitTextures(*material, "", [&](const std::string&, const Json& texture) { is_textured = is_textured || TexCoordOf(texture) == set; });
  }
  return is_textured;
}

// normalTexture, or one of an extension's own, such as clearcoatNormalTexture.
// pointer: of a texture in a material.
bool IsNormalMap(const std::string& pointer) { return pointer.find("ormalTexture", pointer.rfind('/')) != std::string::npos; }

bool IsAnisotropic(const Json& material) { return FindExtension(material, "KHR_materials_anisotropy") != nullptr; }

bool HasTangentSpace(const GltfDocument& document, const std::vector<Place>& places) {
  bool has_one = false;
  for (const Json* material : MaterialsOf(document, places)) {
    has_one = has_one || IsAnisotropic(*material);
    VisitTextures(*material, "", [&](const std::string& pointer, const Json&) { has_one = has_one || IsNormalMap(pointer); });
  }
  return has_one;
}

// Of a material that has another extension as well, such as a toon shader's, unlit is only what others show instead.
bool IsUnlit(const Json& material) {
  const Json* extensions = Find(material, "extensions");
  return FindExtension(material, "KHR_materials_unlit") != nullptr && extensions->size() == 1;
}

// Whether light falls on any of them; it does on primitives without a material.
bool IsLit(const GltfDocument& document, const std::vector<Place>& places) {
  if (UsesExtension(document.json, "VRM")) return true;  // has shaders outside of materials
  const std::vector<const Json*> materials = MaterialsOf(document, places);
  return std::any_of(places.begin(), places.end(), [&](const Place& place) { return Find(PrimitiveAt(document, place), "material") == nullptr; }) ||
         !std::all_of(materials.begin(), materials.end(), [](const Json* material) { return IsUnlit(*material); });
}

bool HasSkin(const GltfDocument& document, const std::vector<Place>& places) {
  for (uint64_t n = 0; n < ArraySize(document.json, "nodes"); ++n) {
    const Json& node = *FindElement(document.json, "nodes", n);
    const std::optional<uint64_t> mesh = AsIndex(Find(node, "mesh"));
    if (Find(node, "skin") == nullptr || !mesh.has_value()) continue;
    if (std::any_of(places.begin(), places.end(), [&](const Place& place) { return place.mesh == *mesh; })) return true;
  }
  return false;
}

}  // namespace

bool IsUnused(const GltfDocument& document, const std::vector<Place>& places, const std::string& name) {
  if (const std::optional<uint64_t> set = SetOf(name, "TEXCOORD_")) return !IsTextured(document, places, *set);
  if (const std::optional<uint64_t> set = SetOf(name, "COLOR_")) return *set > 0;
  if (name == "NORMAL") return !IsLit(document, places);
  if (name == "TANGENT") return !IsLit(document, places) || !HasTangentSpace(document, places);
  if (SetOf(name, "JOINTS_") || SetOf(name, "WEIGHTS_")) return !HasSkin(document, places);
  return false;
}

bool AreTangentsDerivable(const GltfDocument& document, const std::vector<Place>& places) {
  const Json* attributes = Find(PrimitiveAt(document, places[0]), "attributes");
  bool are_derivable = true;
  for (const Json* material : MaterialsOf(document, places)) {
    are_derivable = are_derivable && !IsAnisotropic(*material);
    VisitTextures(*material, "", [&](const std::string& pointer, const Json& texture) {
      if (IsNormalMap(pointer)) are_derivable = are_derivable && Find(*attributes, ("TEXCOORD_" + std::to_string(TexCoordOf(texture))).c_str()) != nullptr;
    });
  }
  return are_derivable;
}

std::string DescribeUnused(const GltfDocument& document) {
  std::set<std::string> names;
  size_t num_primitives = 0;
  for (const std::vector<Place>& places : GroupByGeometry(document)) {
    const Json& primitive = PrimitiveAt(document, places[0]);
    const Json* attributes = Find(primitive, "attributes");
    if (!ReasonToKeep(primitive).empty() || attributes == nullptr || !attributes->is_object()) continue;
    bool has_one = false;
    for (const auto& [name, reference] : attributes->items()) {
      if (!IsUnused(document, places, name)) continue;
      names.insert(name);
      has_one = true;
    }
    num_primitives += has_one ? places.size() : 0;
  }
  if (names.empty()) return "";
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text + " of " + std::to_string(num_primitives) + (num_primitives == 1 ? " primitive: " : " primitives: ") + "nothing in the asset shows that";
}

}  // namespace lacerta
