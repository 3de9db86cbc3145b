#include "document/buffer_edit.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "document/alignment.h"
#include "document/view_references.h"

namespace lacerta {
namespace {

const char* TypeName(uint32_t components) {
  constexpr const char* kNames[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  return kNames[components - 1];  // NOLINT(clang-analyzer-core.uninitialized.UndefReturn): attributes have one to four
}

// Of what the accessor stores: normalization does not count (glTF 2.0, section 3.6.2.5).
void AddBounds(AccessorData data, Json* accessor) {
  Json min = Json::array();
  Json max = Json::array();
  data.normalized = false;
  for (const ComponentRange& range : ComponentRanges(data)) {
    min.push_back(ShortNumber(range.low));
    max.push_back(ShortNumber(range.high));
  }
  (*accessor)["min"] = std::move(min);
  (*accessor)["max"] = std::move(max);
}

std::vector<uint32_t> NonZeroElements(const AccessorData& data) {
  std::vector<uint32_t> elements;
  for (uint64_t i = 0; i < data.count; ++i) {
    bool zero = true;  // -0 is 0
    for (uint32_t c = 0; c < data.components && zero; ++c) zero = data.Float(i, c) == 0.0f;
    if (!zero) elements.push_back(static_cast<uint32_t>(i));
  }
  return elements;
}

void ShrinkView(uint64_t index, GltfDocument* document) {
  Json& view = document->json["bufferViews"][static_cast<size_t>(index)];
  const std::optional<uint64_t> length = AsIndex(Find(view, "byteLength"));
  if (length.has_value() && *length > kAlignment) view["byteLength"] = kAlignment;
  view.erase("byteStride");
  view.erase("target");
}

}  // namespace

uint64_t AddBuffer(Bytes bytes, GltfDocument* document) {
  Json& buffers = document->json["buffers"];
  if (!buffers.is_array()) buffers = Json::array();
  buffers.push_back({{"byteLength", bytes.size()}});
  document->buffers.push_back(std::move(bytes));
  return buffers.size() - 1;
}

void PlaceAt(uint64_t offset, Json* part) {
  if (offset != 0) {
    (*part)["byteOffset"] = offset;
  } else {
    part->erase("byteOffset");
  }
}

uint64_t AddBufferView(uint64_t buffer, uint64_t offset, uint64_t length, GltfDocument* document) {
  Json& views = document->json["bufferViews"];
  if (!views.is_array()) views = Json::array();
  Json view = {{"buffer", buffer}};
  PlaceAt(offset, &view);
  view["byteLength"] = length;
  views.push_back(std::move(view));
  return views.size() - 1;
}

Json DescribeAccessor(const AccessorData& data, bool bounds) {
  Json accessor = {
      {"componentType", static_cast<uint32_t>(data.type)}, {"count", data.count}, {"type", TypeName(data.components)}};
  if (data.normalized) accessor["normalized"] = true;
  if (bounds) AddBounds(data, &accessor);
  return accessor;
}

Json MakeAccessor(const AccessorData& data, AccessorUse use, bool bounds, GltfDocument* document) {
  constexpr uint32_t kArrayBuffer = 34962;
  constexpr uint32_t kElementArrayBuffer = 34963;
  const size_t size = data.components * ComponentSize(data.type);
  const size_t stride = use == AccessorUse::kAttribute ? Aligned(size) : size;
  Bytes bytes;
  if (stride == size) {
    bytes = data.bytes;
  } else {
    bytes.resize(stride * static_cast<size_t>(data.count));
    for (size_t i = 0; i < data.count; ++i) {
      std::copy_n(data.bytes.begin() + static_cast<std::ptrdiff_t>(i * size), size,
                  bytes.begin() + static_cast<std::ptrdiff_t>(i * stride));
    }
  }
  const uint64_t length = bytes.size();
  const uint64_t view = AddBufferView(AddBuffer(std::move(bytes), document), 0, length, document);
  Json& view_json = document->json["bufferViews"][static_cast<size_t>(view)];
  if (stride != size) view_json["byteStride"] = stride;
  view_json["target"] = use == AccessorUse::kAttribute ? kArrayBuffer : kElementArrayBuffer;
  Json accessor = {{"bufferView", view}};
  accessor.update(DescribeAccessor(data, bounds));
  return accessor;
}

namespace {

bool HasNarrowIndices(const AccessorData& data) {
  return data.count <= uint64_t{std::numeric_limits<uint16_t>::max()} + 1;
}

uint64_t DenseSize(const AccessorData& data) { return data.count * Aligned(data.components * ComponentSize(data.type)); }

uint64_t SparseSize(const AccessorData& data) {
  constexpr uint64_t kJson = 140;  // of a sparse part
  const uint64_t index = HasNarrowIndices(data) ? sizeof(uint16_t) : sizeof(uint32_t);
  return NonZeroElements(data).size() * (data.components * ComponentSize(data.type) + index) + kJson;
}

}  // namespace

bool SparseIsSmaller(const AccessorData& data) { return SparseSize(data) < DenseSize(data); }

uint64_t StoredSize(const AccessorData& data) { return std::min(SparseSize(data), DenseSize(data)); }

std::vector<Json> MakeSparseAccessors(const std::vector<SparseSource>& sources, GltfDocument* document) {
  Bytes indices, values;
  const uint64_t index_view = ArraySize(document->json, "bufferViews"), value_view = index_view + 1;
  std::vector<Json> accessors;
  for (const auto& [data, bounds] : sources) {
    std::vector<uint32_t> elements = NonZeroElements(*data);
    if (elements.empty() && data->count > 0) elements.push_back(0);  // not every reader knows accessors without any data
    const ComponentType type = HasNarrowIndices(*data) ? ComponentType::kUint16 : ComponentType::kUint32;
    const size_t size = data->components * ComponentSize(data->type);
    indices.resize(Aligned(indices.size(), ComponentSize(type)));
    values.resize(Aligned(values.size(), ComponentSize(data->type)));
    Json index_part = {{"bufferView", index_view}, {"componentType", static_cast<uint32_t>(type)}}, value_part = {{"bufferView", value_view}};
    PlaceAt(indices.size(), &index_part);
    PlaceAt(values.size(), &value_part);
    for (const uint32_t element : elements) {
      for (size_t byte = 0; byte < ComponentSize(type); ++byte) indices.push_back(static_cast<uint8_t>(element >> (8 * byte)));
      const auto begin = data->bytes.begin() + static_cast<std::ptrdiff_t>(element * size);
      values.insert(values.end(), begin, begin + static_cast<std::ptrdiff_t>(size));
    }
    Json accessor = DescribeAccessor(*data, bounds);
    accessor["sparse"] = {{"count", elements.size()}, {"indices", std::move(index_part)}, {"values", std::move(value_part)}};
    accessors.push_back(std::move(accessor));
  }
  if (accessors.empty()) return accessors;
  for (Bytes* bytes : {&indices, &values}) {
    const uint64_t length = bytes->size();
    AddBufferView(AddBuffer(std::move(*bytes), document), 0, length, document);
  }
  return accessors;
}

uint64_t AddAccessor(Json accessor, GltfDocument* document) {
  Json& accessors = document->json["accessors"];
  if (!accessors.is_array()) accessors = Json::array();
  accessors.push_back(std::move(accessor));
  return accessors.size() - 1;
}

void DropUnusedViews(const std::set<uint64_t>& candidates, GltfDocument* document) {
  std::set<uint64_t> unused = candidates;
  unused.erase(unused.lower_bound(ArraySize(document->json, "bufferViews")), unused.end());  // may dangle
  VisitViewReferences(document->json, [&](Json& reference) {
    if (const std::optional<uint64_t> view = AsIndex(&reference); view.has_value()) unused.erase(*view);
  });
  if (unused.empty()) return;
  if (!AreViewReferencesKnown(*document)) {
    for (const uint64_t index : unused) ShrinkView(index, document);
    return;
  }
  const Json& old_views = document->json["bufferViews"];
  std::vector<uint64_t> new_index(old_views.size());
  Json views = Json::array();
  for (size_t i = 0; i < old_views.size(); ++i) {
    new_index[i] = views.size();
    if (unused.count(i) == 0) views.push_back(old_views[i]);
  }
  VisitViewReferences(document->json, [&](Json& reference) {
    const std::optional<uint64_t> view = AsIndex(&reference);
    if (view.has_value() && *view < new_index.size()) reference = new_index[static_cast<size_t>(*view)];
  });
  if (views.empty()) {
    document->json.erase("bufferViews");
  } else {
    document->json["bufferViews"] = std::move(views);
  }
}

}  // namespace lacerta
