#include "document/buffer_edit.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <tuple>
#include <utility>

namespace lacerta {
namespace {

constexpr uint64_t kAlignment = 4;

// Calls visit(value) on every reference to a bufferView: by the key "bufferView" wherever it is, and "data" of our
// extension.
void VisitViewReferences(Json& json, const std::function<void(Json&)>& visit) {
  if (json.is_array()) {
    for (Json& element : json) VisitViewReferences(element, visit);
  } else if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      if (key == "extras") continue;
      if (key == "bufferView") {
        visit(value);
      } else if (key == "LACERTA_mesh_progressive") {
        for (const char* member : {"data", "refinements"}) {
          if (Json* view = Find(value, member); view != nullptr) visit(*view);
        }
      } else {
        VisitViewReferences(value, visit);
      }
    }
  }
}

// Extensions known to refer to bufferViews by the key "bufferView" or not at all.
bool MayRenumberViews(const GltfDocument& document) {
  const Json* used = Find(document.json, "extensionsUsed");
  if (used == nullptr || !used->is_array()) return true;
  return std::all_of(used->begin(), used->end(), [](const Json& entry) {
    const std::string name = AsString(&entry);
    for (const char* prefix : {"KHR_", "LACERTA_", "EXT_texture_", "EXT_mesh_gpu_instancing", "EXT_lights_", "MSFT_"}) {
      if (name.rfind(prefix, 0) == 0) return true;
    }
    return false;
  });
}

const char* TypeName(uint32_t components) {
  constexpr const char* kNames[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  return kNames[components - 1];  // NOLINT(clang-analyzer-core.uninitialized.UndefReturn): attributes have one to four
}

void AddBounds(const AccessorData& data, Json* accessor) {
  Json min = Json::array();
  Json max = Json::array();
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

// What is needed to show anything, the progressive streams, and images, which a surface can be shown without: the order in
// which a client that reads a file as it arrives wants them.
enum class Turn { kNeeded, kStreams, kImage };

std::vector<Turn> TurnsOfViews(const Json& json) {
  std::vector<Turn> turns(ArraySize(json, "bufferViews"), Turn::kNeeded);
  const auto set = [&](const Json* object, const char* member, Turn turn) {
    const std::optional<uint64_t> view = object == nullptr ? std::nullopt : AsIndex(Find(*object, member));
    if (view.has_value() && *view < turns.size()) turns[static_cast<size_t>(*view)] = turn;
  };
  for (uint64_t i = 0; i < ArraySize(json, "images"); ++i) set(FindElement(json, "images", i), "bufferView", Turn::kImage);
  const Json* extensions = Find(json, "extensions");
  set(extensions == nullptr ? nullptr : Find(*extensions, "LACERTA_mesh_progressive"), "data", Turn::kStreams);
  return turns;
}

struct Interval {
  uint64_t buffer = 0;
  uint64_t begin = 0;
  uint64_t end = 0;
  Turn turn = Turn::kNeeded;
  uint64_t moved_to = 0;
};

// Of two views of the same bytes; bases are seen through views of their own, too.
Turn TurnOfBoth(Turn a, Turn b) {
  return a == Turn::kStreams || b == Turn::kStreams ? Turn::kStreams : std::min(a, b);
}

// Disjoint parts of the buffers that cover all their views, by buffers and then ascending.
std::vector<Interval> Union(std::vector<Interval> intervals) {
  std::sort(intervals.begin(), intervals.end(), [](const Interval& a, const Interval& b) {
    return std::tie(a.buffer, a.begin) < std::tie(b.buffer, b.begin);
  });
  std::vector<Interval> merged;
  for (const Interval& interval : intervals) {
    if (!merged.empty() && interval.buffer == merged.back().buffer && interval.begin < merged.back().end) {
      merged.back().end = std::max(merged.back().end, interval.end);
      merged.back().turn = TurnOfBoth(merged.back().turn, interval.turn);
    } else {
      merged.push_back(interval);
    }
  }
  return merged;
}

}  // namespace

uint64_t AddBuffer(Bytes bytes, GltfDocument* document) {
  Json& buffers = document->json["buffers"];
  if (!buffers.is_array()) buffers = Json::array();
  buffers.push_back({{"byteLength", bytes.size()}});
  document->buffers.push_back(std::move(bytes));
  return buffers.size() - 1;
}

void PlaceView(uint64_t offset, Json* view) {
  if (offset != 0) {
    (*view)["byteOffset"] = offset;
  } else {
    view->erase("byteOffset");
  }
}

uint64_t AddBufferView(uint64_t buffer, uint64_t offset, uint64_t length, GltfDocument* document) {
  Json& views = document->json["bufferViews"];
  if (!views.is_array()) views = Json::array();
  Json view = {{"buffer", buffer}};
  PlaceView(offset, &view);
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
  const size_t stride = use == AccessorUse::kAttribute ? (size + kAlignment - 1) / kAlignment * kAlignment : size;
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

uint64_t DenseSize(const AccessorData& data) { return data.count * data.components * ComponentSize(data.type); }

uint64_t SparseSize(const AccessorData& data) {
  constexpr uint64_t kJson = 200;  // of a sparse part and its two views
  const uint64_t index = HasNarrowIndices(data) ? sizeof(uint16_t) : sizeof(uint32_t);
  return NonZeroElements(data).size() * (data.components * ComponentSize(data.type) + index) + kJson;
}

}  // namespace

bool SparseIsSmaller(const AccessorData& data) { return SparseSize(data) < DenseSize(data); }

uint64_t StoredSize(const AccessorData& data) { return std::min(SparseSize(data), DenseSize(data)); }

Json MakeSparseAccessor(const AccessorData& data, bool bounds, GltfDocument* document) {
  std::vector<uint32_t> elements = NonZeroElements(data);
  if (elements.empty() && data.count > 0) elements.push_back(0);  // not every reader knows accessors without any data
  Json accessor = DescribeAccessor(data, bounds);
  const bool narrow = HasNarrowIndices(data);
  const size_t size = data.components * ComponentSize(data.type);
  Bytes indices;
  Bytes values;
  for (const uint32_t element : elements) {
    for (size_t byte = 0; byte < (narrow ? 2u : 4u); ++byte) indices.push_back(static_cast<uint8_t>(element >> (8 * byte)));
    const auto begin = data.bytes.begin() + static_cast<std::ptrdiff_t>(element * size);
    values.insert(values.end(), begin, begin + static_cast<std::ptrdiff_t>(size));
  }
  const auto add_view = [&](Bytes bytes) {
    const uint64_t length = bytes.size();
    return AddBufferView(AddBuffer(std::move(bytes), document), 0, length, document);
  };
  const uint64_t index_view = add_view(std::move(indices));
  const uint64_t value_view = add_view(std::move(values));
  const ComponentType type = narrow ? ComponentType::kUint16 : ComponentType::kUint32;
  accessor["sparse"] = {{"count", elements.size()},
                        {"indices", {{"bufferView", index_view}, {"componentType", static_cast<uint32_t>(type)}}},
                        {"values", {{"bufferView", value_view}}}};
  return accessor;
}

uint64_t AddAccessor(Json accessor, GltfDocument* document) {
  Json& accessors = document->json["accessors"];
  if (!accessors.is_array()) accessors = Json::array();
  accessors.push_back(std::move(accessor));
  return accessors.size() - 1;
}

std::set<uint64_t> ViewsOfAccessor(const GltfDocument& document, uint64_t index) {
  std::set<uint64_t> views;
  const Json* accessor = FindElement(document.json, "accessors", index);
  if (accessor == nullptr) return views;
  Json copy = *accessor;
  VisitViewReferences(copy, [&](Json& reference) {
    if (const std::optional<uint64_t> view = AsIndex(&reference); view.has_value()) views.insert(*view);
  });
  return views;
}

void DropUnusedViews(const std::set<uint64_t>& candidates, GltfDocument* document) {
  std::set<uint64_t> unused = candidates;
  unused.erase(unused.lower_bound(ArraySize(document->json, "bufferViews")), unused.end());  // may dangle
  VisitViewReferences(document->json, [&](Json& reference) {
    if (const std::optional<uint64_t> view = AsIndex(&reference); view.has_value()) unused.erase(*view);
  });
  if (unused.empty()) return;
  if (!MayRenumberViews(*document)) {
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

Status MergeBuffers(GltfDocument* document) {
  const uint64_t num_views = ArraySize(document->json, "bufferViews");
  const std::vector<Turn> turns = TurnsOfViews(document->json);
  std::vector<Interval> used;
  for (uint64_t i = 0; i < num_views; ++i) {
    LACERTA_ASSIGN_OR_RETURN(const Span<const uint8_t> bytes, BufferViewBytes(*document, i));
    const uint64_t buffer = *AsIndex(Find(*FindElement(document->json, "bufferViews", i), "buffer"));
    const auto begin = static_cast<uint64_t>(bytes.data() - document->buffers[static_cast<size_t>(buffer)].data());
    if (!bytes.empty()) used.push_back({buffer, begin, begin + bytes.size(), turns[static_cast<size_t>(i)]});
  }
  used = Union(std::move(used));
  Bytes merged;
  for (const Turn turn : {Turn::kNeeded, Turn::kStreams, Turn::kImage}) {
    for (Interval& interval : used) {
      if (interval.turn != turn) continue;
      const Bytes& source = document->buffers[static_cast<size_t>(interval.buffer)];
      while (merged.size() % kAlignment != interval.begin % kAlignment) merged.push_back(0);
      interval.moved_to = merged.size();
      merged.insert(merged.end(), source.begin() + static_cast<std::ptrdiff_t>(interval.begin),
                    source.begin() + static_cast<std::ptrdiff_t>(interval.end));
    }
  }
  constexpr uint64_t kRoomForJson = uint64_t{1} << 30;
  if (merged.size() > std::numeric_limits<uint32_t>::max() - kRoomForJson) {
    return Unsupported("the result would not fit into a GLB (4 GB); split the asset");
  }
  for (uint64_t i = 0; i < num_views; ++i) {
    Json& view = document->json["bufferViews"][static_cast<size_t>(i)];
    const std::pair<uint64_t, uint64_t> place = {*AsIndex(Find(view, "buffer")),
                                                 AsIndex(Find(view, "byteOffset")).value_or(0)};
    const auto after = std::upper_bound(used.begin(), used.end(), place, [](const auto& wanted, const Interval& interval) {
      return wanted < std::make_pair(interval.buffer, interval.begin);
    });
    uint64_t moved = 0;  // of views without bytes
    if (after != used.begin()) {
      const Interval& interval = *std::prev(after);
      if (place.first == interval.buffer && place.second < interval.end) moved = interval.moved_to + (place.second - interval.begin);
    }
    view["buffer"] = 0;
    PlaceView(moved, &view);
  }
  document->buffers.clear();
  document->json.erase("buffers");
  if (!merged.empty()) AddBuffer(std::move(merged), document);
  return Status();
}

}  // namespace lacerta
