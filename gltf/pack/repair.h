// Numbers that are not finite (NaN and infinities), taken out of an asset before it is packed.
#ifndef LACERTA_PACK_REPAIR_H_
#define LACERTA_PACK_REPAIR_H_

#include <cstdint>
#include <string>
#include <vector>

#include "document/gltf_document.h"
#include "document/primitive.h"
#include "lacerta/status.h"
#include "pack/source.h"

namespace lacerta {

// Fails with kInvalidData where an attribute or a target holds a number that is not finite; names accessor (of `json`, the primitive's) and vertex.
Status CheckFinite(const Json& json, const Primitive& primitive, const std::vector<MorphTarget>& targets);

struct Repaired {
  uint64_t vertices = 0;   // removed, without a finite position
  uint64_t triangles = 0;  // removed with them
  uint64_t values = 0;     // of other attributes, given by their neighbors
  uint64_t offsets = 0;    // of morph targets, set to nothing

  bool IsAny() const { return vertices + values + offsets > 0; }
};

// Removes vertices without a finite position and their triangles, which no renderer draws. Normals become those of the surface, weights 0
// (all of a vertex: its first joint moves it), offsets of morph targets 0, any other value the mean of the vertices beside it. Fails with
// kInvalidData where no triangle is left.
StatusOr<Repaired> RepairPrimitive(Primitive* primitive, std::vector<MorphTarget>* targets);

// All triangle primitives of an asset; those that an extension of their own may refer to stay as they are, as points and lines do. What has
// been repaired is in plain accessors afterwards. Returns a note on each. Fails like ReadSources for damage of other kinds.
StatusOr<std::vector<std::string>> RepairDocument(GltfDocument* document);

}  // namespace lacerta

#endif  // LACERTA_PACK_REPAIR_H_
