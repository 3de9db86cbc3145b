#include "document/meshopt.h"

#ifdef LACERTA_HAVE_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

#include <set>
#include <string>
#include <utility>

#include "document/buffer_edit.h"

namespace lacerta {
namespace {

constexpr const char* kNames[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

const Json* ExtensionOf(const Json& object, const char** name) {
  const Json* extensions = Find(object, "extensions");
  if (extensions == nullptr) return nullptr;
  for (const char* candidate : kNames) {
    *name = candidate;
    if (const Json* extension = Find(*extensions, candidate); extension != nullptr) return extension;
  }
  return nullptr;
}

#ifdef LACERTA_HAVE_MESHOPTIMIZER

struct CompressedView {
  Span<const uint8_t> bytes;
  uint64_t stride = 0;
  uint64_t count = 0;
  std::string mode, filter;
};

StatusOr<CompressedView> ParseView(const GltfDocument& document, const Json& extension) {
  CompressedView view;
  LACERTA_ASSIGN_OR_RETURN(const uint64_t buffer, GetIndex(extension, "buffer"));
  LACERTA_ASSIGN_OR_RETURN(const uint64_t offset, GetIndex(extension, "byteOffset", 0));
  LACERTA_ASSIGN_OR_RETURN(const uint64_t length, GetIndex(extension, "byteLength"));
  LACERTA_ASSIGN_OR_RETURN(view.stride, GetIndex(extension, "byteStride"));
  LACERTA_ASSIGN_OR_RETURN(view.count, GetIndex(extension, "count"));
  view.mode = AsString(Find(extension, "mode"));
  view.filter = AsString(Find(extension, "filter"));
  if (buffer >= document.buffers.size()) return InvalidData("buffer " + std::to_string(buffer) + " does not exist");
  const Bytes& bytes = document.buffers[static_cast<size_t>(buffer)];
  if (offset > bytes.size() || length > bytes.size() - offset) {
    return InvalidData("its " + std::to_string(length) + " compressed bytes are not all in buffer " +
                       std::to_string(buffer) + "; the file is truncated or damaged");
  }
  view.bytes = Span<const uint8_t>(bytes).Subspan(static_cast<size_t>(offset)).First(static_cast<size_t>(length));
  return view;
}

// A byte of the vertex coder stands for at most 64 bytes, one of the index coders for at most 12.
constexpr uint64_t kMostExpansion = 64;
constexpr uint64_t kSlack = 1 << 16;

// What the decoders of meshoptimizer take for granted.
Status CheckView(const CompressedView& view) {
  const bool attributes = view.mode == "ATTRIBUTES";
  if (!attributes && view.mode != "TRIANGLES" && view.mode != "INDICES") {
    return InvalidData("mode \"" + view.mode + "\" does not exist");
  }
  const bool stride_fits =
      attributes ? view.stride >= 4 && view.stride <= 256 && view.stride % 4 == 0 : view.stride == 2 || view.stride == 4;
  if (!stride_fits) return InvalidData("byteStride " + std::to_string(view.stride) + " does not go with its mode");
  if (view.mode == "TRIANGLES" && view.count % 3 != 0) return InvalidData("count is no multiple of 3");
  if (view.count > (kMostExpansion * view.bytes.size() + kSlack) / view.stride) {
    return InvalidData(std::to_string(view.bytes.size()) + " bytes cannot hold " + std::to_string(view.count) +
                       " elements");
  }
  return Status();
}

Status ApplyFilter(const CompressedView& view, Bytes* decoded) {
  const std::string& filter = view.filter;
  if (filter.empty() || filter == "NONE") return Status();
  const auto count = static_cast<size_t>(view.count);
  const auto stride = static_cast<size_t>(view.stride);
  if (view.mode == "ATTRIBUTES" && filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) {
    meshopt_decodeFilterOct(decoded->data(), count, stride);
  } else if (view.mode == "ATTRIBUTES" && filter == "QUATERNION" && stride == 8) {
    meshopt_decodeFilterQuat(decoded->data(), count, stride);
  } else if (view.mode == "ATTRIBUTES" && filter == "EXPONENTIAL") {
    meshopt_decodeFilterExp(decoded->data(), count, stride);
  } else if (filter == "COLOR") {
    return Unsupported("the filter COLOR is not read; start from the uncompressed asset");
  } else {
    return InvalidData("filter \"" + filter + "\" does not go with its mode and byteStride");
  }
  return Status();
}

// What all views of a document may decode to: they do not share their bytes, or a small file would fill the memory.
uint64_t MostDecodedBytes(const GltfDocument& document) {
  uint64_t bytes = 0;
  for (const Bytes& buffer : document.buffers) bytes += buffer.size();
  return kMostExpansion * bytes + kSlack;
}

// left: bytes that may still be decoded to; lowered by those of this view.
StatusOr<Bytes> DecodeView(const GltfDocument& document, const Json& extension, uint64_t* left) {
  LACERTA_ASSIGN_OR_RETURN(const CompressedView view, ParseView(document, extension));
  LACERTA_RETURN_IF_ERROR(CheckView(view));
  if (view.count * view.stride > *left) return InvalidData("the compressed views decode to more than their buffers can hold: they overlap");
  *left -= view.count * view.stride;
  const auto count = static_cast<size_t>(view.count);
  const auto stride = static_cast<size_t>(view.stride);
  Bytes decoded(count * stride);
  if (decoded.empty()) return decoded;
  int result = 0;
  if (view.mode == "ATTRIBUTES") {
    result = meshopt_decodeVertexBuffer(decoded.data(), count, stride, view.bytes.data(), view.bytes.size());
  } else if (view.mode == "TRIANGLES") {
    result = meshopt_decodeIndexBuffer(decoded.data(), count, stride, view.bytes.data(), view.bytes.size());
  } else {
    result = meshopt_decodeIndexSequence(decoded.data(), count, stride, view.bytes.data(), view.bytes.size());
  }
  if (result == -1) return Unsupported("is of a version of the meshopt format that is not read");
  if (result != 0) return InvalidData("the meshopt stream is damaged");
  LACERTA_RETURN_IF_ERROR(ApplyFilter(view, &decoded));
  return decoded;
}

#else

uint64_t MostDecodedBytes(const GltfDocument&) { return 0; }

StatusOr<Bytes> DecodeView(const GltfDocument&, const Json&, uint64_t*) {
  return Unsupported("is compressed with meshopt, and this build has no meshoptimizer; start from the uncompressed asset");
}

#endif

Status ReplaceView(uint64_t index, uint64_t* left, GltfDocument* document) {
  const char* name = nullptr;
  const Json* extension = ExtensionOf(*FindElement(document->json, "bufferViews", index), &name);
  if (extension == nullptr) return Status();
  LACERTA_ASSIGN_OR_RETURN(Bytes decoded, DecodeView(*document, *extension, left));
  const uint64_t length = decoded.size();
  const uint64_t buffer = AddBuffer(std::move(decoded), document);
  Json& view = document->json["bufferViews"][static_cast<size_t>(index)];
  view["buffer"] = buffer;
  view.erase("byteOffset");
  view["byteLength"] = length;
  if (!RequiresExtension(document->json, name)) DropMeshopt(&view);
  return Status();
}

}  // namespace

Status DecodeMeshoptViews(GltfDocument* document) {
  uint64_t left = MostDecodedBytes(*document);
  for (uint64_t i = 0; i < ArraySize(document->json, "bufferViews"); ++i) {
    const Status status = ReplaceView(i, &left, document);
    if (!status.ok()) return status.WithContext("bufferView " + std::to_string(i));
  }
  for (uint64_t i = 0; i < ArraySize(document->json, "buffers"); ++i) {
    DropMeshopt(&document->json["buffers"][static_cast<size_t>(i)]);
  }
  DeclareMeshopt(document);
  return Status();
}

std::optional<CompressedBytes> FindCompressedBytes(const GltfDocument& document, uint64_t index) {
  CompressedBytes place;
  const Json* view = FindElement(document.json, "bufferViews", index);
  const Json* extension = view == nullptr ? nullptr : ExtensionOf(*view, &place.extension);
  if (extension == nullptr) return std::nullopt;
  place.buffer = AsIndex(Find(*extension, "buffer")).value_or(document.buffers.size());
  place.offset = AsIndex(Find(*extension, "byteOffset")).value_or(0);
  place.length = AsIndex(Find(*extension, "byteLength")).value_or(0);
  if (place.buffer >= document.buffers.size()) return std::nullopt;
  const uint64_t size = document.buffers[static_cast<size_t>(place.buffer)].size();
  if (place.offset > size || place.length > size - place.offset) return std::nullopt;
  return place;
}

std::optional<double> CompressedShare(const GltfDocument& document, uint64_t index) {
  const std::optional<CompressedBytes> compressed = FindCompressedBytes(document, index);
  if (!compressed.has_value()) return std::nullopt;
  const uint64_t decoded = AsIndex(Find(*FindElement(document.json, "bufferViews", index), "byteLength")).value_or(0);
  return decoded == 0 ? 1.0 : static_cast<double>(compressed->length) / static_cast<double>(decoded);
}

void PlaceCompressedBytes(const CompressedBytes& place, Json* view) {
  Json& extension = (*view)["extensions"][place.extension];
  extension["buffer"] = place.buffer;
  PlaceAt(place.offset, &extension);
}

void DropMeshopt(Json* object) {
  Json* extensions = Find(*object, "extensions");
  if (extensions == nullptr) return;
  for (const char* name : kNames) extensions->erase(name);
  if (extensions->empty()) object->erase("extensions");
}

void DeclareMeshopt(GltfDocument* document) {
  std::set<std::string> used;
  for (uint64_t i = 0; i < ArraySize(document->json, "bufferViews"); ++i) {
    const char* name = nullptr;
    if (ExtensionOf(*FindElement(document->json, "bufferViews", i), &name) != nullptr) used.insert(name);
  }
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    for (const char* name : kNames) used.count(name) > 0 ? AddExtension(list, name, document) : RemoveExtension(list, name, document);
  }
}

}  // namespace lacerta
