// Progressive meshes for hosts that read glTF with a library of their own: its JSON and buffers in, vertex and index
// arrays out. No type of any glTF library here; lacerta/tinygltf.h builds on this for tinygltf.
#ifndef LACERTA_PARSED_GLTF_H_
#define LACERTA_PARSED_GLTF_H_

#include <cstdint>
#include <string>
#include <vector>

#include "lacerta/gltf.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

struct PrimitiveIndex {
  uint64_t mesh = 0;       // index of the glTF mesh
  uint64_t primitive = 0;  // of the primitive in it
};

struct RefinedAttribute {
  std::string name;         // as in glTF
  uint32_t components = 1;  // 1..4: SCALAR, VEC2, VEC3, VEC4
  Bytes values;             // #V x components
  uint32_t component_type = 5126;  // glTF componentType: floats, or of JOINTS_0 5121 or 5123 (8 or 16 bits)
};

// What primitives with LACERTA_mesh_progressive are to show instead of their fallback. The arrays are little endian and
// without gaps, as glTF accessors want them.
struct RefinedGeometry {
  std::vector<PrimitiveIndex> primitives;  // all that show it: those with equal attributes, indices and extensions
  bool from_fallback = false;              // the primitives keep what they have; only `note` says more
  std::string note;    // why the level is not the one asked for, or why the fallback is kept; else empty
  int level = 0;       // of the arrays
  int num_levels = 0;  // levels above the base that the asset announces
  uint64_t num_vertices = 0;
  Vec3f min, max;            // bounds of the positions
  Bytes positions;           // #V x 3 floats
  Bytes normals;             // #V x 3 floats of length 1; empty where the asset asks for flat shading
  std::vector<RefinedAttribute> attributes;  // all others that the stream carries
  // Of each morph target its POSITION, NORMAL and TANGENT, as far as the stream has them: floats of three components.
  std::vector<std::vector<RefinedAttribute>> targets;
  uint64_t num_indices = 0;  // 3 #F
  uint32_t index_type = 0;   // glTF componentType: 5123 (16 bits) or 5125 (32 bits)
  Bytes indices;             // #F x 3
};

// Decodes the progressive primitives of an asset. `json` is the asset's, or as much of it as matters here:
// asset.version, extensions, bufferViews (buffer, byteOffset, byteLength), accessors (bufferView, min, max) and meshes
// (of targets, how many there are). `buffers` are its buffers in their order; they are only read. UnpackOptions::folder
// is not used. References that lead nowhere and damaged streams end in `from_fallback`; fails with kInvalidArgument for
// a negative level, with kInvalidData or kUnsupported where the JSON is at fault or a primitive has neither a usable
// stream nor a fallback. Safe on untrusted input.
StatusOr<std::vector<RefinedGeometry>> RefineParsedGltf(const std::string& json,
                                                        const std::vector<Span<const uint8_t>>& buffers,
                                                        const UnpackOptions& options);

}  // namespace lacerta

#endif  // LACERTA_PARSED_GLTF_H_
