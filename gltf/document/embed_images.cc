#include "document/embed_images.h"

#include <map>
#include <utility>

#include "document/buffer_edit.h"
#include "document/image_size.h"
#include "document/uri.h"

namespace lacerta {
namespace {

struct EmbeddedImage {
  uint64_t view = 0;
  std::string mime_type;
};

StatusOr<EmbeddedImage> Embed(const std::string& uri, GltfDocument* document) {
  LACERTA_ASSIGN_OR_RETURN(Bytes bytes, LoadUri(uri, document->folder));
  std::string mime_type = ImageMimeType(bytes);
  if (mime_type.empty()) return Unsupported("it is neither PNG, JPEG, WebP nor KTX2");
  const uint64_t length = bytes.size();
  return EmbeddedImage{AddBufferView(AddBuffer(std::move(bytes), document), 0, length, document), std::move(mime_type)};
}

}  // namespace

void EmbedImages(ImageFiles files, GltfDocument* document, std::vector<std::string>* notes) {
  std::map<std::string, EmbeddedImage> known;
  for (uint64_t i = 0; i < ArraySize(document->json, "images"); ++i) {
    const auto image = [&]() -> Json& { return document->json["images"][static_cast<size_t>(i)]; };
    const std::string uri = AsString(Find(image(), "uri"));
    const bool is_data = uri.rfind("data:", 0) == 0;
    if (uri.empty() || (!is_data && files == ImageFiles::kReferTo)) continue;
    if (known.count(uri) == 0) {
      const StatusOr<EmbeddedImage> embedded = Embed(uri, document);
      if (!embedded.ok()) {
        if (!is_data) notes->push_back("image " + std::to_string(i) + " stays a reference to \"" + uri.substr(0, 80) + "\": " + embedded.status().message());
        continue;
      }
      known.emplace(uri, embedded.value());
    }
    image().erase("uri");
    image()["bufferView"] = known[uri].view;
    image()["mimeType"] = known[uri].mime_type;
  }
}

}  // namespace lacerta
