// Attributes that an asset carries and nothing in it shows, or that readers can do without.
#ifndef LACERTA_PACK_UNUSED_ATTRIBUTES_H_
#define LACERTA_PACK_UNUSED_ATTRIBUTES_H_

#include <string>
#include <vector>

#include "document/gltf_document.h"
#include "document/place.h"

namespace lacerta {

// Whether no material that the primitives at `places` can have, and no skin, makes use of the attribute `name` of theirs: texture coordinates that
// no texture is laid by, normals and tangents of unlit materials, tangents without a normal map or anisotropy, colors beyond COLOR_0, joints and weights
// without a skin. Of application attributes nobody can tell: they count as used.
bool IsUnused(const GltfDocument& document, const std::vector<Place>& places, const std::string& name);

// Whether glTF says how readers get the tangents of the primitives at `places` where there are none: each of their materials with a normal map lays it by a set of
// texture coordinates that they have, and none asks for a direction of anisotropy.
bool AreTangentsDerivable(const GltfDocument& document, const std::vector<Place>& places);

// One sentence on what IsUnused in the asset, for a report; "" where nothing is.
std::string DescribeUnused(const GltfDocument& document);

}  // namespace lacerta

#endif  // LACERTA_PACK_UNUSED_ATTRIBUTES_H_
