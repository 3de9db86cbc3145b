// bufferViews compressed with EXT_meshopt_compression or KHR_meshopt_compression.
#ifndef LACERTA_DOCUMENT_MESHOPT_H_
#define LACERTA_DOCUMENT_MESHOPT_H_

#include "document/gltf_document.h"
#include "lacerta/status.h"

namespace lacerta {

// Decodes every compressed bufferView into a buffer of its own and takes the extension away from views, buffers and
// lists: afterwards the document says in core glTF what it said before. Counts are held against what the compressed
// bytes can stand for before memory is taken. Fails with kInvalidData, naming the bufferView, or kUnsupported where
// the library was built without meshoptimizer or the stream is of a version that it does not know.
Status DecodeMeshoptViews(GltfDocument* document);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_MESHOPT_H_
