// Giving a primitive other vertices and indices.
#ifndef LACERTA_PACK_REPLACE_GEOMETRY_H_
#define LACERTA_PACK_REPLACE_GEOMETRY_H_

#include <set>
#include <string>
#include <vector>

#include "document/gltf_document.h"
#include "document/place.h"
#include "document/primitive.h"
#include "lacerta/mesh.h"
#include "pack/accessor_pool.h"
#include "pack/source.h"

namespace lacerta {

struct NamedAccessor {
  std::string name;  // of the attribute
  Json json;
};

// What replaces the geometry of a primitive.
struct NewGeometry {
  std::vector<NamedAccessor> attributes;
  Json indices;
  Json extensions = Json::object();  // added to those of the primitive
  std::vector<std::vector<NamedAccessor>> targets;  // empty: the primitive keeps what it has
};

// Core accessors with their data.
NewGeometry PlainGeometry(const TriangleMesh& mesh, bool with_normals, GltfDocument* document);
NewGeometry PlainGeometry(const Primitive& primitive, GltfDocument* document);

// Accessors without data, for geometry that an extension holds.
NewGeometry DescribedGeometry(const TriangleMesh& mesh);
NewGeometry DescribedGeometry(const Primitive& primitive);

// Accessors with the values of morph targets; sparse where that is smaller.
std::vector<std::vector<NamedAccessor>> TargetAccessors(const std::vector<MorphTarget>& targets, GltfDocument* document);

// All `places` show the same surface so far, by one set of accessors for each of `geometries`, and get the same new one.
// What compressed it before goes.
void ReplaceGeometry(const std::vector<Place>& geometries, const std::vector<Place>& places, NewGeometry geometry,
                     AccessorPool* pool, GltfDocument* document);

// The bufferViews that hold Draco streams.
std::set<uint64_t> DracoViews(const GltfDocument& document);

// Lists KHR_draco_mesh_compression as used and required if a primitive has it, else not.
void DeclareDraco(GltfDocument* document);

// Lists KHR_mesh_quantization as used and required if attributes or morph targets are of types that core glTF does not have for them, else not.
void DeclareQuantization(GltfDocument* document);

}  // namespace lacerta

#endif  // LACERTA_PACK_REPLACE_GEOMETRY_H_
