#include "document/view_references.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include "document/accessor.h"

namespace lacerta {

void VisitViewReferences(Json& json, const std::function<void(Json&)>& visit) {
  if (json.is_array()) {
    for (Json& element : json) VisitViewReferences(element, visit);
  } else if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      if (key == "extras") continue;
      if (key == "bufferView") {
        visit(value);
      } else if (key == "LACERTA_mesh_progressive") {
        for (const char* member : {"data", "refinements"}) {
          if (Json* view = Find(value, member); view != nullptr) visit(*view);
        }
      } else {
        VisitViewReferences(value, visit);
      }
    }
  }
}

bool RefersToNoData(const std::string& extension) {
  // Those of Khronos and of several vendors; of avatars (VRM), engines and web platforms, which name nodes, meshes, materials and textures.
  constexpr const char* kPrefixes[] = {"KHR_", "LACERTA_", "MSFT_", "EXT_texture_", "EXT_lights_", "EXT_meshopt_", "ADOBE_", "GODOT_", "MOZ_", "NEEDLE_", "OMI_", "VRMC_"};
  return extension == "VRM" || std::any_of(std::begin(kPrefixes), std::end(kPrefixes), [&](const char* prefix) { return extension.rfind(prefix, 0) == 0; });
}

bool AreViewReferencesKnown(const GltfDocument& document) {
  const Json* used = Find(document.json, "extensionsUsed");
  if (used == nullptr || !used->is_array()) return true;
  return std::all_of(used->begin(), used->end(), [](const Json& entry) {
    const std::string name = AsString(&entry);
    return RefersToNoData(name) || name == "EXT_mesh_gpu_instancing";  // accessors
  });
}

std::set<uint64_t> ViewsOfAccessor(const GltfDocument& document, uint64_t index) {
  std::set<uint64_t> views;
  const Json* accessor = FindElement(document.json, "accessors", index);
  if (accessor == nullptr) return views;
  Json copy = *accessor;
  VisitViewReferences(copy, [&](Json& reference) {
    if (const std::optional<uint64_t> view = AsIndex(&reference); view.has_value()) views.insert(*view);
  });
  return views;
}

void VisitAccessorParts(Json& json, const std::function<void(Json& part, uint64_t size, uint64_t count)>& visit) {
  Json* accessors = Find(json, "accessors");
  if (accessors == nullptr || !accessors->is_array()) return;
  for (Json& accessor : *accessors) VisitParts(accessor, visit);
}

}  // namespace lacerta
