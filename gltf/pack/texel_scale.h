// What a unit of a texture coordinate is in texels.
#ifndef LACERTA_PACK_TEXEL_SCALE_H_
#define LACERTA_PACK_TEXEL_SCALE_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "document/gltf_document.h"
#include "document/place.h"
#include "document/primitive.h"

namespace lacerta {

// Texels along one unit of TEXCOORD_`set` of a member of a family.
using TexelScale = std::function<double(size_t member, uint64_t set)>;

// The n of TEXCOORD_n.
uint64_t SetOfTexCoord(const std::string& name);

// The side of the texture that texels are of: the longest of the asset's images, but at least 1024. Smaller ones
// often stand in for others, and the geometry outlives them.
uint64_t TexelSide(const GltfDocument& document);

// A primitive, and the places that show it.
struct PlacedPrimitive {
  const std::vector<Place>* places = nullptr;
  const Primitive* primitive = nullptr;
};

// Where it is stretched most: `side`, times the largest scale by which KHR_texture_transform repeats the set in any material that the member can
// have, if that is above 1. Sets that no member shows have four textures at most over the range of all their values: nobody knows how often one would
// repeat. Refers to nothing.
TexelScale TexelScaleOf(const GltfDocument& document, const std::vector<PlacedPrimitive>& members, uint64_t side);

}  // namespace lacerta

#endif  // LACERTA_PACK_TEXEL_SCALE_H_
