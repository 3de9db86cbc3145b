#include "document/references.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include "document/materials.h"

namespace lacerta {
namespace {

using Visit = std::function<void(const std::string& pointer, const Json& value)>;

// Where indices are, and the array that they index. "*" stands for every element or member.
struct Reference {
  std::string_view path, array;
};

constexpr Reference kReferences[] = {
    {"/scene", "/scenes"},
    {"/scenes/*/nodes/*", "/nodes"},
    {"/nodes/*/children/*", "/nodes"},
    {"/nodes/*/mesh", "/meshes"},
    {"/nodes/*/skin", "/skins"},
    {"/nodes/*/camera", "/cameras"},
    {"/nodes/*/extensions/KHR_lights_punctual/light", "/extensions/KHR_lights_punctual/lights"},
    {"/nodes/*/extensions/EXT_mesh_gpu_instancing/attributes/*", "/accessors"},
    {"/skins/*/joints/*", "/nodes"},
    {"/skins/*/skeleton", "/nodes"},
    {"/skins/*/inverseBindMatrices", "/accessors"},
    {"/animations/*/samplers/*/input", "/accessors"},
    {"/animations/*/samplers/*/output", "/accessors"},
    {"/animations/*/channels/*/target/node", "/nodes"},
    {"/meshes/*/primitives/*/indices", "/accessors"},
    {"/meshes/*/primitives/*/attributes/*", "/accessors"},
    {"/meshes/*/primitives/*/targets/*/*", "/accessors"},
    {"/meshes/*/primitives/*/material", "/materials"},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/bufferView", "/bufferViews"},
    {"/meshes/*/primitives/*/extensions/KHR_materials_variants/mappings/*/material", "/materials"},
    {"/meshes/*/primitives/*/extensions/KHR_materials_variants/mappings/*/variants/*", "/extensions/KHR_materials_variants/variants"},
    {"/textures/*/source", "/images"},
    {"/textures/*/sampler", "/samplers"},
    {"/textures/*/extensions/KHR_texture_basisu/source", "/images"},
    {"/textures/*/extensions/EXT_texture_webp/source", "/images"},
    {"/textures/*/extensions/EXT_texture_avif/source", "/images"},
    {"/textures/*/extensions/MSFT_texture_dds/source", "/images"},
    {"/images/*/bufferView", "/bufferViews"},
    {"/accessors/*/bufferView", "/bufferViews"},
    {"/accessors/*/sparse/indices/bufferView", "/bufferViews"},
    {"/accessors/*/sparse/values/bufferView", "/bufferViews"},
    {"/bufferViews/*/buffer", "/buffers"},
};

// Calls visit on all values at a path; pointer: of `json`.
void VisitPath(const Json& json, std::string_view path, const std::string& pointer, const Visit& visit) {
  if (path.empty()) return visit(pointer, json);
  const size_t end = std::min(path.find('/', 1), path.size());
  const std::string key(path.substr(1, end - 1));
  const std::string_view rest = path.substr(end);
  if (key != "*") {
    if (const Json* member = Find(json, key.c_str()); member != nullptr) VisitPath(*member, rest, pointer + "/" + key, visit);
  } else if (json.is_structured()) {
    for (const auto& [name, value] : json.items()) VisitPath(value, rest, pointer + "/" + name, visit);
  }
}

// Whether a textureInfo of a material, by its JSON pointer, is one: anything may stand in extras, and have an "index" in extensions.
bool IsTexture(const std::string& pointer) {
  constexpr std::string_view kEnding = "Texture";
  return pointer.find("/extras/") == std::string::npos && pointer.size() > kEnding.size() &&
         pointer.compare(pointer.size() - kEnding.size(), kEnding.size(), kEnding) == 0;
}

uint64_t SizeAt(const Json& json, std::string_view path) {
  uint64_t size = 0;
  VisitPath(json, path, "", [&](const std::string&, const Json& value) { size = value.is_array() ? value.size() : 0; });
  return size;
}

}  // namespace

std::vector<std::string> DanglingReferences(const Json& json) {
  std::vector<std::string> dangling;
  const auto check_into = [&](std::string array, uint64_t size) {
    return [&dangling, array = std::move(array), size](const std::string& pointer, const Json& value) {
      const std::optional<uint64_t> index = AsIndex(&value);
      if (index.has_value() && *index >= size) dangling.push_back(pointer + " refers to " + array + "/" + std::to_string(*index) + ", which does not exist");
    };
  };
  for (const Reference& reference : kReferences) {
    VisitPath(json, reference.path, "", check_into(std::string(reference.array), SizeAt(json, reference.array)));
  }
  const Visit check_texture = check_into("/textures", ArraySize(json, "textures"));
  VisitPath(json, "/materials/*", "", [&](const std::string& pointer, const Json& material) {
    VisitTextures(material, pointer, [&](const std::string& at, const Json& texture) {
      if (IsTexture(at)) check_texture(at + "/index", *Find(texture, "index"));
    });
  });
  VisitPath(json, "/animations/*", "", [&](const std::string& pointer, const Json& animation) {
    VisitPath(animation, "/channels/*/sampler", pointer, check_into(pointer + "/samplers", ArraySize(animation, "samplers")));
  });
  return dangling;
}

Status CheckReferences(const Json& json) {
  const std::vector<std::string> dangling = DanglingReferences(json);
  if (dangling.empty()) return Status();
  const std::string others = dangling.size() > 1 ? ", and " + std::to_string(dangling.size() - 1) + " more like it" : "";
  return InvalidData(dangling.front() + others + "; mend the asset or export it anew");
}

}  // namespace lacerta
