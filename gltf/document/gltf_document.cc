#include "document/gltf_document.h"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "document/alignment.h"
#include "document/meshopt.h"
#include "document/uri.h"

namespace lacerta {
namespace {

constexpr uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr uint32_t kBinChunk = 0x004E4942;   // "BIN\0"

uint32_t ReadUint32(Span<const uint8_t> bytes, size_t offset) {
  const uint8_t* p = bytes.data() + offset;
  return static_cast<uint32_t>(p[0]) | static_cast<uint32_t>(p[1]) << 8 | static_cast<uint32_t>(p[2]) << 16 |
         static_cast<uint32_t>(p[3]) << 24;
}

void AppendUint32(uint64_t value, Bytes* bytes) {
  for (int shift = 0; shift < 32; shift += 8) bytes->push_back(static_cast<uint8_t>(value >> shift));
}

struct Chunks {
  std::string_view json;
  Span<const uint8_t> bin;
  bool has_bin = false;
};

StatusOr<Chunks> SplitGlb(Span<const uint8_t> bytes) {
  if (bytes.size() < 20)
    return InvalidData("the GLB header is cut off after " + std::to_string(bytes.size()) + " bytes");
  const uint32_t version = ReadUint32(bytes, 4);
  if (version != 2) return Unsupported("GLB version " + std::to_string(version) + "; only version 2 is read");
  const uint32_t json_length = ReadUint32(bytes, 12);
  if (ReadUint32(bytes, 16) != kJsonChunk) return InvalidData("byte 16: the first chunk of the GLB is not JSON");
  if (json_length > bytes.size() - 20) {
    return InvalidData("byte 12: the JSON chunk has " + std::to_string(json_length) + " bytes, but only " +
                       std::to_string(bytes.size() - 20) + " are there; the file is truncated");
  }
  Chunks chunks;
  chunks.json = {reinterpret_cast<const char*>(bytes.data()) + 20, json_length};
  const size_t bin = 20 + size_t{json_length};
  if (bytes.size() - bin >= 8 && ReadUint32(bytes, bin + 4) == kBinChunk) {
    chunks.has_bin = true;
    const size_t available = bytes.size() - bin - 8;
    chunks.bin = bytes.Subspan(bin + 8).First(std::min<size_t>(available, ReadUint32(bytes, bin)));
  }
  return chunks;
}

// Whether buffer `index` holds refinements alone: the asset is whole without them.
bool IsDispensable(const Json& json, uint64_t index) {
  const Json* progressive = FindExtension(json, "LACERTA_mesh_progressive");
  const std::optional<uint64_t> refinements =
      progressive == nullptr ? std::nullopt : AsIndex(Find(*progressive, "refinements"));
  if (!refinements.has_value()) return false;
  bool found = false;
  for (uint64_t v = 0; v < ArraySize(json, "bufferViews"); ++v) {
    if (AsIndex(Find(*FindElement(json, "bufferViews", v), "buffer")) != index) continue;
    if (v != *refinements) return false;
    found = true;
  }
  return found;
}

StatusOr<Bytes> LoadBuffer(const Json& buffer, bool first, bool dispensable, const Chunks& chunks,
                           const std::string& folder) {
  LACERTA_ASSIGN_OR_RETURN(const uint64_t length, GetIndex(buffer, "byteLength"));
  const Json* uri = Find(buffer, "uri");
  if (uri == nullptr) {
    if (!first || !chunks.has_bin) return Bytes();  // what refers to it fails later, by name
    return Bytes(chunks.bin.begin(), chunks.bin.begin() + std::min<uint64_t>(length, chunks.bin.size()));
  }
  if (!uri->is_string()) return InvalidData("\"uri\" is no string");
  StatusOr<Bytes> loaded = LoadUri(uri->get_ref<const std::string&>(), folder);
  if (dispensable && loaded.status().code() == StatusCode::kNotFound) return Bytes();
  LACERTA_ASSIGN_OR_RETURN(Bytes bytes, std::move(loaded));
  if (bytes.size() < length && dispensable) return bytes;
  if (bytes.size() < length) {
    return InvalidData("announces " + std::to_string(length) + " bytes, but its data has " +
                       std::to_string(bytes.size()));
  }
  bytes.resize(static_cast<size_t>(length));
  return bytes;
}

// Members named "extensions" are objects wherever they are, but in extras, which are anybody's.
bool ExtensionsAreObjects(const Json& json) {
  if (!json.is_structured()) return true;
  if (json.is_array()) return std::all_of(json.begin(), json.end(), ExtensionsAreObjects);
  for (const auto& [key, value] : json.items()) {
    if (key == "extras") continue;
    if (key == "extensions" && !value.is_object()) return false;
    if (!ExtensionsAreObjects(value)) return false;
  }
  return true;
}

bool IsArrayOfObjects(const Json& json) {
  return json.is_array() &&
         std::all_of(json.begin(), json.end(), [](const Json& element) { return element.is_object(); });
}

// So that what is changed later may be taken for what it should be.
Status CheckShape(const Json& json) {
  for (const char* key :
       {"accessors", "animations", "buffers", "bufferViews", "images", "meshes", "nodes", "scenes", "skins"}) {
    const Json* array = Find(json, key);
    if (array != nullptr && !IsArrayOfObjects(*array))
      return InvalidData(std::string("\"") + key + "\" is no array of objects");
  }
  for (uint64_t m = 0; m < ArraySize(json, "meshes"); ++m) {
    const Json* primitives = Find(*FindElement(json, "meshes", m), "primitives");
    if (primitives == nullptr || !IsArrayOfObjects(*primitives)) {
      return InvalidData("mesh " + std::to_string(m) + ": \"primitives\" is no array of objects");
    }
  }
  for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
    const Json* list = Find(json, key);
    if (list != nullptr && !list->is_array()) return InvalidData(std::string("\"") + key + "\" is no array");
  }
  if (!ExtensionsAreObjects(json)) return InvalidData("a member \"extensions\" is no object");
  return Status();
}

bool IsListed(const Json& json, const char* key, const char* name) {
  const Json* list = Find(json, key);
  return list != nullptr && list->is_array() && std::find(list->begin(), list->end(), name) != list->end();
}

Status CheckReadable(const Json& json) {
  const Json* asset = Find(json, "asset");
  const std::string version = asset == nullptr ? "" : AsString(Find(*asset, "version"));
  if (version.substr(0, 2) != "2.") return Unsupported("glTF version \"" + version + "\"; only 2.x is read");
  return Status();
}

}  // namespace

StatusOr<Json> ParseGltfJson(std::string_view text) {
  LACERTA_ASSIGN_OR_RETURN(Json json, ParseJson(text));
  LACERTA_RETURN_IF_ERROR(CheckReadable(json));
  LACERTA_RETURN_IF_ERROR(CheckShape(json));
  return json;
}

bool IsGlb(Span<const uint8_t> bytes) { return bytes.size() >= 4 && ReadUint32(bytes, 0) == kMagic; }

StatusOr<GltfDocument> ParseGltf(Span<const uint8_t> bytes, const std::string& folder) {
  Chunks chunks;
  chunks.json = {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  if (IsGlb(bytes)) {
    LACERTA_ASSIGN_OR_RETURN(chunks, SplitGlb(bytes));
  }
  GltfDocument document;
  document.folder = folder;
  document.is_glb = IsGlb(bytes);
  LACERTA_ASSIGN_OR_RETURN(document.json, ParseGltfJson(chunks.json));
  for (uint64_t i = 0; i < ArraySize(document.json, "buffers"); ++i) {
    StatusOr<Bytes> buffer = LoadBuffer(*FindElement(document.json, "buffers", i), i == 0,
                                        IsDispensable(document.json, i), chunks, folder);
    if (!buffer.ok()) return buffer.status().WithContext("buffer " + std::to_string(i));
    document.buffers.push_back(std::move(buffer).value());
  }
  LACERTA_RETURN_IF_ERROR(DecodeMeshoptViews(&document));
  return document;
}

Bytes FormatGlb(const GltfDocument& document) {
  std::string json = document.json.dump(-1, ' ', false, Json::error_handler_t::replace);
  const uint64_t alignment = AlignmentOf(document.json);
  json.resize(Aligned(20 + json.size(), alignment) - 20, ' ');
  const Bytes empty;
  const Bytes& bin = document.buffers.empty() ? empty : document.buffers[0];
  const size_t padding = Aligned(bin.size(), alignment) - bin.size();
  const size_t bin_chunk = bin.empty() ? 0 : 8 + bin.size() + padding;
  Bytes bytes;
  bytes.reserve(20 + json.size() + bin_chunk);
  AppendUint32(kMagic, &bytes);
  AppendUint32(2, &bytes);
  AppendUint32(20 + json.size() + bin_chunk, &bytes);
  AppendUint32(json.size(), &bytes);
  AppendUint32(kJsonChunk, &bytes);
  bytes.insert(bytes.end(), json.begin(), json.end());
  if (!bin.empty()) {
    AppendUint32(bin.size() + padding, &bytes);
    AppendUint32(kBinChunk, &bytes);
    bytes.insert(bytes.end(), bin.begin(), bin.end());
    bytes.insert(bytes.end(), padding, 0);
  }
  return bytes;
}

StatusOr<Span<const uint8_t>> AvailableViewBytes(const GltfDocument& document, uint64_t index) {
  const std::string name = "bufferView " + std::to_string(index);
  const Json* view = FindElement(document.json, "bufferViews", index);
  if (view == nullptr) return InvalidData(name + " does not exist");
  const StatusOr<uint64_t> buffer = GetIndex(*view, "buffer");
  const StatusOr<uint64_t> offset = GetIndex(*view, "byteOffset", 0);
  const StatusOr<uint64_t> length = GetIndex(*view, "byteLength");
  for (const Status& status : {buffer.status(), offset.status(), length.status()}) {
    if (!status.ok()) return status.WithContext(name);
  }
  const bool borrowed = !document.borrowed_buffers.empty();
  if (buffer.value() >= (borrowed ? document.borrowed_buffers.size() : document.buffers.size())) {
    return InvalidData(name + ": buffer " + std::to_string(buffer.value()) + " does not exist");
  }
  const auto buffer_index = static_cast<size_t>(buffer.value());
  const Span<const uint8_t> bytes =
      borrowed ? document.borrowed_buffers[buffer_index] : Span<const uint8_t>(document.buffers[buffer_index]);
  const uint64_t begin = std::min<uint64_t>(offset.value(), bytes.size());
  return bytes.Subspan(static_cast<size_t>(begin))
      .First(static_cast<size_t>(std::min(length.value(), bytes.size() - begin)));
}

StatusOr<Span<const uint8_t>> BufferViewBytes(const GltfDocument& document, uint64_t index) {
  LACERTA_ASSIGN_OR_RETURN(const Span<const uint8_t> bytes, AvailableViewBytes(document, index));
  const uint64_t length = *AsIndex(Find(*FindElement(document.json, "bufferViews", index), "byteLength"));
  if (bytes.size() < length) {
    const uint64_t buffer = *AsIndex(Find(*FindElement(document.json, "bufferViews", index), "buffer"));
    const Json* described = FindElement(document.json, "buffers", buffer);
    const bool is_of_bin_chunk = document.is_glb && buffer == 0;  // which may have been cut off
    if (bytes.empty() && !is_of_bin_chunk && described != nullptr && Find(*described, "uri") == nullptr) {
      return Unsupported("bufferView " + std::to_string(index) + ": its bytes are not in the file: buffer " + std::to_string(buffer) +
                         " has no \"uri\", and there is no BIN chunk for it");
    }
    return InvalidData("bufferView " + std::to_string(index) + ": only " + std::to_string(bytes.size()) + " of its " +
                       std::to_string(length) + " bytes are in its buffer; the file is truncated or damaged");
  }
  return bytes;
}

uint64_t AlignmentOf(const Json& json) {
  constexpr uint64_t kOfDoubles = 8;
  return UsesExtension(json, "EXT_structural_metadata") ? kOfDoubles : kAlignment;
}

bool UsesExtension(const Json& json, const char* name) { return IsListed(json, "extensionsUsed", name); }
bool RequiresExtension(const Json& json, const char* name) { return IsListed(json, "extensionsRequired", name); }

void AddExtension(const char* key, const char* name, GltfDocument* document) {
  Json& list = document->json[key];
  if (!list.is_array()) list = Json::array();
  if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
}

void RemoveExtension(const char* key, const char* name, GltfDocument* document) {
  Json* list = Find(document->json, key);
  if (list == nullptr || !list->is_array()) return;
  const auto found = std::find(list->begin(), list->end(), name);
  if (found != list->end()) list->erase(found);
  if (list->empty()) document->json.erase(key);
}

}  // namespace lacerta
