// The primitives of an asset as they come in, each surface once.
#ifndef LACERTA_PACK_SOURCE_H_
#define LACERTA_PACK_SOURCE_H_

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "document/gltf_document.h"
#include "document/place.h"
#include "document/primitive.h"
#include "lacerta/status.h"

namespace lacerta {

// Attributes of a morph target: offsets, in the order of the primitive's vertices.
using MorphTarget = std::vector<Attribute>;

struct Source {
  std::vector<Place> places;       // all that show it; at least one
  std::vector<Place> geometries;   // one place for every set of accessors among them
  std::optional<Primitive> primitive;  // empty: cannot be compressed, `reason` says why
  std::vector<MorphTarget> targets;
  std::string reason;
  uint64_t stored_bytes = 0;  // of attributes, indices and targets in one set of accessors; 0 where there is no primitive
  uint64_t held_bytes = 0;    // of these in all sets: what skins, animations or extensions refer to, too, or may
};

// Why a primitive has to stay as it is whatever it holds; empty when it need not.
std::string ReasonToKeep(const Json& primitive);

// The morph targets of the primitive `json`.
StatusOr<std::vector<MorphTarget>> ReadTargets(const GltfDocument& document, const Json& json, uint64_t num_vertices);

// What is left out of what is read.
struct DroppedAttributes {
  bool unused = false;    // those that IsUnused
  bool tangents = false;  // where AreTangentsDerivable
};

// Reads all primitives. Those with equal accessors, and those with other accessors of equal content, are one source.
// Quantized positions, directions and texture coordinates (KHR_mesh_quantization) become floats: they are rounded anew. Normals of
// flat shading, and what targets have of normals and tangents without moving them, are left out; so is what is to be dropped.
// Fails with kInvalidData on damaged data and on numbers that are not finite, naming mesh, primitive, accessor and index; what is legal but cannot be
// compressed ends as a reason.
StatusOr<std::vector<Source>> ReadSources(const GltfDocument& document, const DroppedAttributes& dropped = {});

// The meshes that the sources are in, and the nodes that show each of them.
std::map<uint64_t, std::vector<uint64_t>> NodesByMesh(const GltfDocument& document, const std::vector<const Source*>& sources);

}  // namespace lacerta

#endif  // LACERTA_PACK_SOURCE_H_
