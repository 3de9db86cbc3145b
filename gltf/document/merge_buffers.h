// One buffer at the end.
#ifndef LACERTA_DOCUMENT_MERGE_BUFFERS_H_
#define LACERTA_DOCUMENT_MERGE_BUFFERS_H_

#include "document/gltf_document.h"
#include "lacerta/status.h"

namespace lacerta {

// Moves all that bufferViews refer to into one buffer and drops the rest: first what is needed to show anything, then the
// data of LACERTA_mesh_progressive, then images, each in the order of the buffers (decision 0022). Of views that only
// accessors refer to, the bytes between these are dropped, too, so that accessors which share a view do not keep those of
// others alive. Views that came compressed (DecodeMeshoptViews) are stored as they came where that takes less than what is
// needed of them; what they decode to is then the second buffer, which is not written. Fails with kUnsupported beyond 4 GB
// and with kInvalidData where a view refers to bytes that are not there.
Status MergeBuffers(GltfDocument* document);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_MERGE_BUFFERS_H_
