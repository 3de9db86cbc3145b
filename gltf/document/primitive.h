// A triangle primitive of a glTF mesh with all its attributes, however it was stored.
#ifndef LACERTA_DOCUMENT_PRIMITIVE_H_
#define LACERTA_DOCUMENT_PRIMITIVE_H_

#include <string>
#include <vector>

#include "document/accessor.h"
#include "document/gltf_document.h"
#include "lacerta/decoder.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

struct Attribute {
  std::string name;  // POSITION, NORMAL, TEXCOORD_0, ...
  AccessorData data;
};

struct Primitive {
  uint64_t num_vertices = 0;
  std::vector<Triangle> triangles;    // indices < num_vertices
  std::vector<Attribute> attributes;  // of num_vertices elements each; POSITION first

  const Attribute* Find(const std::string& name) const;
};

// Pointers to all of them, in order.
std::vector<const Primitive*> PointersTo(const std::vector<Primitive>& primitives);

// Reads an element of meshes[].primitives: triangles, strips and fans, core accessors, or KHR_draco_mesh_compression with those of the
// attributes that are not in its stream.
// Positions are finite and indices in range afterwards. Fails with kUnsupported for points and lines and where there are no positions,
// kInvalidData for what breaks the format; messages name accessor and index.
StatusOr<Primitive> ReadPrimitive(const GltfDocument& document, const Json& primitive, const DecodeLimits& limits);

// The same, but positions may be anything.
StatusOr<Primitive> ReadUncheckedPrimitive(const GltfDocument& document, const Json& primitive, const DecodeLimits& limits);

// Positions (as float, normalized integers scaled) and triangles alone.
TriangleMesh Surface(const Primitive& primitive);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_PRIMITIVE_H_
