#include "document/place.h"

#include <map>

namespace lacerta {
namespace {

// Equal for primitives that show the same vertices and indices in the same way.
std::string GeometryKey(const Json& primitive) {
  std::string key;
  for (const char* member : {"attributes", "indices", "mode", "targets"}) {
    if (const Json* value = Find(primitive, member); value != nullptr) key += value->dump();
    key += '|';
  }
  const Json* extensions = Find(primitive, "extensions");
  if (extensions != nullptr && extensions->is_object()) {
    for (const auto& [name, value] : extensions->items()) {
      if (name != "KHR_materials_variants") key += name + value.dump();
    }
  }
  return key;
}

}  // namespace

std::string PlaceName(const GltfDocument& document, const Place& place) {
  std::string text = "mesh " + std::to_string(place.mesh);
  if (const Json* mesh = FindElement(document.json, "meshes", place.mesh); mesh != nullptr) {
    if (const std::string name = AsString(Find(*mesh, "name")); !name.empty()) text += " (" + name + ")";
  }
  return text + ", primitive " + std::to_string(place.primitive);
}

const Json& PrimitiveAt(const GltfDocument& document, const Place& place) {
  return *FindElement(*FindElement(document.json, "meshes", place.mesh), "primitives", place.primitive);
}

Json& PrimitiveAt(GltfDocument* document, const Place& place) {
  return const_cast<Json&>(PrimitiveAt(static_cast<const GltfDocument&>(*document), place));
}

std::vector<Place> AllPlaces(const GltfDocument& document) {
  std::vector<Place> places;
  for (uint64_t m = 0; m < ArraySize(document.json, "meshes"); ++m) {
    const uint64_t count = ArraySize(*FindElement(document.json, "meshes", m), "primitives");
    for (uint64_t p = 0; p < count; ++p) places.push_back({m, p});
  }
  return places;
}

std::vector<std::vector<Place>> GroupByGeometry(const GltfDocument& document) {
  std::vector<std::vector<Place>> groups;
  std::map<std::string, size_t> known;
  for (const Place& place : AllPlaces(document)) {
    const auto [entry, is_new] = known.emplace(GeometryKey(PrimitiveAt(document, place)), groups.size());
    if (is_new) groups.emplace_back();
    groups[entry->second].push_back(place);
  }
  return groups;
}

}  // namespace lacerta
