// A glTF 2.0 asset in memory: its JSON and its buffers, not interpreted any further.
#ifndef LACERTA_DOCUMENT_GLTF_DOCUMENT_H_
#define LACERTA_DOCUMENT_GLTF_DOCUMENT_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "document/json.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

struct GltfDocument {
  Json json = Json::object();
  std::vector<Bytes> buffers;  // parallel to json["buffers"]
  // Instead of `buffers`, where a host keeps them itself; such a document is only read.
  std::vector<Span<const uint8_t>> borrowed_buffers;
  std::string folder;  // where relative URIs lead
  bool is_glb = false;  // read from one
};

// The JSON of an asset, checked as far as everything here relies on it. Fails with kInvalidData or kUnsupported
// (version).
StatusOr<Json> ParseGltfJson(std::string_view text);

// Whether the bytes begin as a GLB does.
bool IsGlb(Span<const uint8_t> bytes);

// Reads a .glb (by its magic) or .gltf. External buffers are looked for in `folder`; one that holds nothing but
// refinements of LACERTA_mesh_progressive may be missing or short, as if it had been trimmed. A GLB whose BIN chunk was cut off
// is accepted with the bytes that are there; what refers to the missing ones fails when it is looked at. Every
// "byteLength" is held against the bytes that are really there. bufferViews under EXT_meshopt_compression are decoded
// (DecodeMeshoptViews). Fails with kInvalidData, kUnsupported (version) or what LoadUri and DecodeMeshoptViews
// return.
StatusOr<GltfDocument> ParseGltf(Span<const uint8_t> bytes, const std::string& folder);

// Of the parts of a GLB and of what else begins in a buffer, bytes: 8 where EXT_structural_metadata, which asks for that, is used; else kAlignment.
uint64_t AlignmentOf(const Json& json);

// A GLB of the document. Its first buffer is in it; others must have a URI, or be what MergeBuffers leaves out.
Bytes FormatGlb(const GltfDocument& document);

// The bytes of bufferViews[index]. Fails with kInvalidData when the view or its range is not there, kUnsupported where its
// buffer never was in the file.
StatusOr<Span<const uint8_t>> BufferViewBytes(const GltfDocument& document, uint64_t index);

// The same, but cut short where the buffer ends early. Fails when the view is not there.
StatusOr<Span<const uint8_t>> AvailableViewBytes(const GltfDocument& document, uint64_t index);

// Whether a name is in the asset's extensionsUsed, or in extensionsRequired.
bool UsesExtension(const Json& json, const char* name);
bool RequiresExtension(const Json& json, const char* name);

// Adds a name to the list `key` ("extensionsUsed" or "extensionsRequired"), or takes it away together with an empty
// list.
void AddExtension(const char* key, const char* name, GltfDocument* document);
void RemoveExtension(const char* key, const char* name, GltfDocument* document);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_GLTF_DOCUMENT_H_
