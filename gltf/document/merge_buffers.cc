#include "document/merge_buffers.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "document/alignment.h"
#include "document/buffer_edit.h"
#include "document/meshopt.h"
#include "document/view_references.h"

namespace lacerta {
namespace {

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
  set(FindExtension(json, "LACERTA_mesh_progressive"), "data", Turn::kStreams);
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

// A part of a view, from its beginning.
struct Range {
  uint64_t begin = 0;
  uint64_t end = 0;
  bool is_interleaved = false;
};

// What a part of an accessor refers to, from a multiple of four on, so that all of a view stay aligned to each other; whole strides,
// as readers take them, where it is interleaved. Nothing where that is not inside of the view.
std::optional<Range> RangeOf(const Json& part, uint64_t size, uint64_t count, const Json& view) {
  const uint64_t length = AsIndex(Find(view, "byteLength")).value_or(0);
  const uint64_t offset = AsIndex(Find(part, "byteOffset")).value_or(0);
  const uint64_t stride = AsIndex(Find(view, "byteStride")).value_or(size);
  if (size == 0 || count == 0 || stride < size || offset > length || size > length - offset) return std::nullopt;
  if (count - 1 > (length - offset - size) / stride) return std::nullopt;
  if (stride == size) return Range{offset - offset % kAlignment, offset + count * size};
  const uint64_t begin = offset - offset % stride;
  return Range{begin, std::max(std::min(length, begin + count * stride), offset + (count - 1) * stride + size), true};
}

// What is interleaved stays so: all of it is one range.
void JoinInterleaved(std::vector<Range>* ranges) {
  if (std::none_of(ranges->begin(), ranges->end(), [](const Range& range) { return range.is_interleaved; })) return;
  Range all = ranges->front();
  for (const Range& range : *ranges) all = {std::min(all.begin, range.begin), std::max(all.end, range.end), true};
  *ranges = {all};
}

// Of each view what accessors refer to, if nothing else does; empty of those that are needed as a whole.
std::vector<std::vector<Range>> AccessorRanges(GltfDocument* document) {
  const uint64_t num_views = ArraySize(document->json, "bufferViews");
  std::vector<std::vector<Range>> ranges(static_cast<size_t>(num_views));
  if (!AreViewReferencesKnown(*document)) return ranges;
  std::vector<uint64_t> num_references(ranges.size(), 0);
  VisitViewReferences(document->json, [&](const Json& reference) {
    const std::optional<uint64_t> view = AsIndex(&reference);
    if (view.has_value() && *view < num_views) ++num_references[static_cast<size_t>(*view)];
  });
  VisitAccessorParts(document->json, [&](const Json& part, uint64_t size, uint64_t count) {
    const std::optional<uint64_t> view = AsIndex(Find(part, "bufferView"));
    if (!view.has_value() || *view >= num_views) return;
    const std::optional<Range> range = RangeOf(part, size, count, *FindElement(document->json, "bufferViews", *view));
    if (range.has_value()) ranges[static_cast<size_t>(*view)].push_back(*range);
  });
  for (size_t i = 0; i < ranges.size(); ++i) {
    if (ranges[i].size() != num_references[i]) ranges[i].clear();
    JoinInterleaved(&ranges[i]);
  }
  return ranges;
}

// Where a byte of a buffer is after the move; 0 where no interval holds it.
uint64_t MovedTo(const std::vector<Interval>& moved, uint64_t buffer, uint64_t offset) {
  const auto after = std::upper_bound(moved.begin(), moved.end(), std::make_pair(buffer, offset), [](const auto& wanted, const Interval& interval) {
    return wanted < std::make_pair(interval.buffer, interval.begin);
  });
  if (after == moved.begin()) return 0;
  const Interval& interval = *std::prev(after);
  return buffer == interval.buffer && offset < interval.end ? interval.moved_to + (offset - interval.begin) : 0;
}

// The intervals one after the other, by turns, as far off multiples of `alignment` as they were; says where they went.
Bytes Move(const std::vector<Bytes>& buffers, uint64_t alignment, std::vector<Interval>* intervals) {
  Bytes merged;
  for (const Turn turn : {Turn::kNeeded, Turn::kStreams, Turn::kImage}) {
    for (Interval& interval : *intervals) {
      if (interval.turn != turn) continue;
      const Bytes& source = buffers[static_cast<size_t>(interval.buffer)];
      while (merged.size() % alignment != interval.begin % alignment) merged.push_back(0);
      interval.moved_to = merged.size();
      merged.insert(merged.end(), source.begin() + static_cast<std::ptrdiff_t>(interval.begin),
                    source.begin() + static_cast<std::ptrdiff_t>(interval.end));
    }
  }
  return merged;
}

uint64_t CoveredBytes(std::vector<Range> ranges) {
  std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) { return a.begin < b.begin; });
  uint64_t sum = 0, end = 0;
  for (const Range& range : ranges) {
    if (range.end > end) sum += range.end - std::max(range.begin, end);
    end = std::max(end, range.end);
  }
  return sum;
}

// Of each view that came compressed where its compressed bytes are, if they are fewer than those that are needed of what
// they decode to; these are whole then. The others are compressed no more.
std::vector<std::optional<CompressedBytes>> ChooseCompressed(std::vector<std::vector<Range>>* ranges, GltfDocument* document) {
  std::vector<std::optional<CompressedBytes>> chosen(ranges->size());
  for (size_t i = 0; i < chosen.size(); ++i) {
    std::vector<Range>& parts = (*ranges)[i];
    Json& view = document->json["bufferViews"][i];
    chosen[i] = FindCompressedBytes(*document, i);
    const uint64_t needed = parts.empty() ? AsIndex(Find(view, "byteLength")).value_or(0) : CoveredBytes(parts);
    if (chosen[i].has_value() && chosen[i]->length < needed) {
      parts.clear();
    } else {
      chosen[i].reset();
      DropMeshopt(&view);
    }
  }
  return chosen;
}

// What views that stay compressed refer to beside: a buffer without bytes in the file, as their extension asks for.
class FallbackBuffer {
 public:
  // Returns where they would be.
  uint64_t Add(Span<const uint8_t> decoded, const char* extension) {
    bytes_.resize(Aligned(bytes_.size()));
    const uint64_t offset = bytes_.size();
    bytes_.insert(bytes_.end(), decoded.begin(), decoded.end());
    extensions_[extension] = {{"fallback", true}};
    return offset;
  }
  void AddTo(GltfDocument* document) && {
    if (bytes_.empty()) return;
    const uint64_t index = AddBuffer(std::move(bytes_), document);
    document->json["buffers"][static_cast<size_t>(index)]["extensions"] = std::move(extensions_);
  }

 private:
  Bytes bytes_;
  Json extensions_ = Json::object();
};

struct View {
  Interval place;                             // all of it, decoded
  std::vector<Range> ranges;                  // what is needed of it; empty: all
  std::optional<CompressedBytes> compressed;  // it stays so
};

// Where compressed bytes are not worth keeping, views lose the extension that names them.
StatusOr<std::vector<View>> FindViews(GltfDocument* document) {
  const std::vector<Turn> turns = TurnsOfViews(document->json);
  std::vector<std::vector<Range>> ranges = AccessorRanges(document);
  std::vector<std::optional<CompressedBytes>> compressed = ChooseCompressed(&ranges, document);
  std::vector<View> views;
  for (size_t i = 0; i < ranges.size(); ++i) {
    LACERTA_ASSIGN_OR_RETURN(const Span<const uint8_t> bytes, BufferViewBytes(*document, i));
    const Json& json = document->json["bufferViews"][i];
    const uint64_t begin = AsIndex(Find(json, "byteOffset")).value_or(0);
    views.push_back({{*AsIndex(Find(json, "buffer")), begin, begin + bytes.size(), turns[i]}, std::move(ranges[i]), compressed[i]});
  }
  return views;
}

// Disjoint.
std::vector<Interval> UsedParts(const std::vector<View>& views) {
  std::vector<Interval> used;
  for (const auto& [place, ranges, compressed] : views) {
    if (compressed.has_value()) {
      used.push_back({compressed->buffer, compressed->offset, compressed->offset + compressed->length, place.turn});
    } else if (ranges.empty() && place.begin < place.end) {
      used.push_back(place);
    }
    for (const Range& range : ranges) used.push_back({place.buffer, place.begin + range.begin, place.begin + range.end, place.turn});
  }
  return Union(std::move(used));
}

// Where what is needed of a view is after the move.
Range RangeAfter(const std::vector<Interval>& used, const View& view) {
  const Interval& place = view.place;
  if (view.ranges.empty()) {
    const uint64_t begin = MovedTo(used, place.buffer, place.begin);
    return {begin, begin + (place.end - place.begin)};
  }
  Range all{std::numeric_limits<uint64_t>::max(), 0};
  for (const Range& range : view.ranges) {
    const uint64_t begin = MovedTo(used, place.buffer, place.begin + range.begin);
    all = {std::min(all.begin, begin), std::max(all.end, begin + (range.end - range.begin))};
  }
  return all;
}

void MoveViews(const std::vector<Interval>& used, FallbackBuffer* fallback, std::vector<View>* views, GltfDocument* document) {
  for (size_t i = 0; i < views->size(); ++i) {
    View& view = (*views)[i];
    Json& json = document->json["bufferViews"][i];
    if (view.compressed.has_value()) {
      const CompressedBytes& bytes = *view.compressed;
      view.place.moved_to = fallback->Add(BufferViewBytes(*document, i).value(), bytes.extension);
      PlaceCompressedBytes({bytes.extension, 0, MovedTo(used, bytes.buffer, bytes.offset), bytes.length}, &json);
    } else {
      const Range after = RangeAfter(used, view);
      json["byteLength"] = after.end - after.begin;
      view.place.moved_to = after.begin;
    }
    json["buffer"] = view.compressed.has_value() ? 1 : 0;
    PlaceAt(view.place.moved_to, &json);
  }
}

// After MoveViews.
void MoveAccessors(const std::vector<Interval>& used, const std::vector<View>& views, GltfDocument* document) {
  VisitAccessorParts(document->json, [&](Json& part, uint64_t, uint64_t) {
    const std::optional<uint64_t> view = AsIndex(Find(part, "bufferView"));
    if (!view.has_value() || *view >= views.size() || views[static_cast<size_t>(*view)].ranges.empty()) return;
    const Interval& place = views[static_cast<size_t>(*view)].place;
    const uint64_t offset = place.begin + AsIndex(Find(part, "byteOffset")).value_or(0);
    PlaceAt(MovedTo(used, place.buffer, offset) - place.moved_to, &part);
  });
}

}  // namespace

Status MergeBuffers(GltfDocument* document) {
  LACERTA_ASSIGN_OR_RETURN(std::vector<View> views, FindViews(document));
  std::vector<Interval> used = UsedParts(views);
  Bytes merged = Move(document->buffers, AlignmentOf(document->json), &used);
  constexpr uint64_t kRoomForJson = uint64_t{1} << 30;
  if (merged.size() > std::numeric_limits<uint32_t>::max() - kRoomForJson) {
    return Unsupported("the result would not fit into a GLB (4 GB); split the asset");
  }
  FallbackBuffer fallback;
  MoveViews(used, &fallback, &views, document);
  MoveAccessors(used, views, document);
  document->buffers.clear();
  document->json.erase("buffers");
  if (!views.empty()) AddBuffer(std::move(merged), document);  // of no bytes, if that is what they refer to
  std::move(fallback).AddTo(document);
  DeclareMeshopt(document);
  return Status();
}

}  // namespace lacerta
