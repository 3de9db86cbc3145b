// One progressive primitive out of a document, or its fallback where the asset was edited or damaged.
#ifndef LACERTA_UNPACK_SURFACE_READER_H_
#define LACERTA_UNPACK_SURFACE_READER_H_

#include "document/gltf_document.h"
#include "document/place.h"
#include "extension/progressive.h"
#include "lacerta/gltf.h"

namespace lacerta {

// `progressive` is what ParseProgressive said of the document. The primitive at `place` has the extension.
// Fails only where neither the stream nor a fallback gives a mesh.
StatusOr<ProgressiveSurface> ReadSurface(const GltfDocument& document, const StatusOr<Progressive>& progressive,
                                         const Place& place, const UnpackOptions& options);

}  // namespace lacerta

#endif  // LACERTA_UNPACK_SURFACE_READER_H_
