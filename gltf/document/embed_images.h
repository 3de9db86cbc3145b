// Images as part of the asset, wherever they came from.
#ifndef LACERTA_DOCUMENT_EMBED_IMAGES_H_
#define LACERTA_DOCUMENT_EMBED_IMAGES_H_

#include <string>
#include <vector>

#include "document/gltf_document.h"

namespace lacerta {

enum class ImageFiles {
  kReferTo,  // they stay files of their own
  kEmbed,
};

// Puts the images of data URIs, and those of files in the document's folder where asked for, into bufferViews, byte for byte; images of
// one URI share a view. What cannot be read, or is neither PNG, JPEG, WebP nor KTX2, stays a reference; for files there is a note then.
void EmbedImages(ImageFiles files, GltfDocument* document, std::vector<std::string>* notes);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_EMBED_IMAGES_H_
