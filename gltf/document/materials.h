// What the materials of primitives show.
#ifndef LACERTA_DOCUMENT_MATERIALS_H_
#define LACERTA_DOCUMENT_MATERIALS_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "document/gltf_document.h"
#include "document/place.h"

namespace lacerta {

// The materials that the primitives at `places` can have: their own, and those of KHR_materials_variants; each once.
std::vector<const Json*> MaterialsOf(const GltfDocument& document, const std::vector<Place>& places);

// Calls visit(pointer, texture) on every textureInfo in a material, extensions included: the objects with "index", and their JSON pointers, `pointer` being
// that of the material. The last key tells what a texture is for.
void VisitTextures(const Json& material, const std::string& pointer, const std::function<void(const std::string& pointer, const Json& texture)>& visit);

// The set of texture coordinates that a textureInfo is shown by (KHR_texture_transform may name another one).
uint64_t TexCoordOf(const Json& texture);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_MATERIALS_H_
