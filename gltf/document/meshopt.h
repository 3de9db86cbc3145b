// bufferViews compressed with EXT_meshopt_compression or KHR_meshopt_compression.
#ifndef LACERTA_DOCUMENT_MESHOPT_H_
#define LACERTA_DOCUMENT_MESHOPT_H_

#include <cstdint>
#include <optional>

#include "document/gltf_document.h"
#include "lacerta/status.h"

namespace lacerta {

// Decodes every compressed bufferView into a buffer of its own. Where the asset requires the extension, views keep it and say
// so where their compressed bytes are: what stays as it is may be stored as it came (MergeBuffers). Else there is a copy that
// is not compressed, and the extension is taken away: the document says in core glTF what it said before. Counts are held
// against what the compressed bytes can stand for before memory is taken. Fails with kInvalidData, naming the bufferView, or
// kUnsupported where the library was built without meshoptimizer or the stream is of a version that it does not know.
Status DecodeMeshoptViews(GltfDocument* document);

// Where the compressed bytes of a decoded view are, in document.buffers.
struct CompressedBytes {
  const char* extension = nullptr;
  uint64_t buffer = 0;
  uint64_t offset = 0;
  uint64_t length = 0;
};
// Of bufferViews[index]; nothing where it is not compressed.
std::optional<CompressedBytes> FindCompressedBytes(const GltfDocument& document, uint64_t index);

// Compressed over decoded bytes of bufferViews[index]; nothing where it is not compressed.
std::optional<double> CompressedShare(const GltfDocument& document, uint64_t index);

// Says that the compressed bytes are elsewhere.
void PlaceCompressedBytes(const CompressedBytes& place, Json* view);

// Takes the extension away from a view or a buffer.
void DropMeshopt(Json* object);

// The extension in the lists of those that are used and required, there where a view has it and nowhere else.
void DeclareMeshopt(GltfDocument* document);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_MESHOPT_H_
