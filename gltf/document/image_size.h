// What the textures of an asset are and how large, by the headers of their files.
#ifndef LACERTA_DOCUMENT_IMAGE_SIZE_H_
#define LACERTA_DOCUMENT_IMAGE_SIZE_H_

#include <cstdint>
#include <optional>
#include <string>

#include "document/gltf_document.h"
#include "lacerta/mesh.h"

namespace lacerta {

// The longer side of a PNG, JPEG, WebP or KTX2 image in pixels; empty for anything else.
std::optional<uint64_t> LongerSide(Span<const uint8_t> image);

// "image/png" and so on, by the first bytes of the same four; empty for anything else.
std::string ImageMimeType(Span<const uint8_t> image);

// The longest side of all images, in bufferViews, data URIs and files of the document's folder; 0 where none of them can be read.
uint64_t LargestImageSide(const GltfDocument& document);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_IMAGE_SIZE_H_
