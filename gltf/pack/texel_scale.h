// What a unit of a texture coordinate is in texels.
#ifndef LACERTA_PACK_TEXEL_SCALE_H_
#define LACERTA_PACK_TEXEL_SCALE_H_

#include <cstdint>
#include <vector>

#include "document/gltf_document.h"
#include "document/place.h"

namespace lacerta {

// The side of the texture that texels are of: the longest of the asset's images, but at least 1024. Smaller ones
// often stand in for others, and the geometry outlives them.
uint64_t TexelSide(const GltfDocument& document);

// Texels along one unit of TEXCOORD_`set` where it is stretched most: `side`, times the largest scale by which
// KHR_texture_transform repeats it in any material that the primitives at `places` can have, if that is above 1.
double TexelsPerUnit(const GltfDocument& document, const std::vector<Place>& places, uint64_t set, uint64_t side);

}  // namespace lacerta

#endif  // LACERTA_PACK_TEXEL_SCALE_H_
