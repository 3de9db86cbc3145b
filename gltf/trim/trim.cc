#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "document/merge_buffers.h"
#include "document/embed_images.h"
#include "document/gltf_document.h"
#include "extension/progressive.h"
#include "lacerta/gltf.h"

namespace lacerta {
namespace {

// Which of its stream's segments each one is: 0 is the base.
std::vector<uint64_t> LevelsOf(const std::vector<Segment>& segments, size_t num_streams) {
  std::vector<uint64_t> next(num_streams, 0);
  std::vector<uint64_t> levels;
  levels.reserve(segments.size());
  for (const Segment& segment : segments) levels.push_back(next[static_cast<size_t>(segment.stream)]++);
  return levels;
}

// The segments up to a level, before those beyond it; both in their old order, which keeps every stream's.
std::vector<size_t> OrderByLevel(const std::vector<uint64_t>& levels, uint64_t level, size_t* num_kept) {
  std::vector<size_t> order;
  for (const bool kept : {true, false}) {
    for (size_t i = 0; i < levels.size(); ++i) {
      if ((levels[i] <= level) == kept) order.push_back(i);
    }
    if (kept) *num_kept = order.size();
  }
  return order;
}

struct Source {
  GltfDocument document;
  Progressive progressive;
  std::vector<uint64_t> offsets;  // of the segments in the data
  Bytes data;                     // as much as there is
};

StatusOr<Source> ReadSource(GltfDocument document, Progressive progressive) {
  Source source{std::move(document), std::move(progressive), {}, {}};
  LACERTA_ASSIGN_OR_RETURN(source.data, TransmittedBytes(source.document, source.progressive));
  uint64_t offset = 0;
  for (const Segment& segment : source.progressive.segments) {
    source.offsets.push_back(offset);
    offset += segment.length;
  }
  return source;
}

// The asset with the first `count` segments of `order`, as far as their bytes are there.
StatusOr<Bytes> Write(const Source& source, const std::vector<size_t>& order, size_t count) {
  GltfDocument document = source.document;
  Progressive progressive = source.progressive;
  Bytes data;
  for (size_t i = 0; i < order.size(); ++i) {
    progressive.segments[i] = source.progressive.segments[order[i]];
    const uint64_t begin = std::min<uint64_t>(source.offsets[order[i]], source.data.size());
    const uint64_t end = std::min<uint64_t>(begin + progressive.segments[i].length, source.data.size());
    if (i < count) {
      data.insert(data.end(), source.data.begin() + static_cast<std::ptrdiff_t>(begin),
                  source.data.begin() + static_cast<std::ptrdiff_t>(end));
    }
    if (end - begin < progressive.segments[i].length) count = std::min(count, i + 1);  // what follows would shift
  }
  LACERTA_RETURN_IF_ERROR(ReplaceTransmittedBytes(std::move(data), &progressive, &document));
  LACERTA_RETURN_IF_ERROR(MergeBuffers(&document));
  return FormatGlb(document);
}

// An asset without levels, as it is: it is all base, and so are those of a library whose meshes are all stored without.
StatusOr<Bytes> Whole(Span<const uint8_t> asset, bool has_new_buffers, GltfDocument* document) {
  if (!IsGlb(asset)) return Unsupported("no mesh of it has levels: there is nothing to trim");
  if (!has_new_buffers) return Bytes(asset.begin(), asset.end());
  LACERTA_RETURN_IF_ERROR(MergeBuffers(document));
  return FormatGlb(*document);
}

}  // namespace

StatusOr<TrimResult> TrimGltf(Span<const uint8_t> asset, const TrimOptions& options) {
  if (options.level.has_value() == options.bytes.has_value()) {
    return InvalidArgument("either a level or a number of bytes has to be given");
  }
  TrimResult result;
  LACERTA_ASSIGN_OR_RETURN(GltfDocument document, ParseGltf(asset, options.folder));
  const size_t num_buffers = document.buffers.size();
  if (options.embed_images) EmbedImages(ImageFiles::kEmbed, &document, &result.notes);
  StatusOr<Progressive> progressive = ParseProgressive(document);
  if (progressive.status().code() == StatusCode::kNotFound) {
    result.has_levels = false;
    LACERTA_ASSIGN_OR_RETURN(result.glb, Whole(asset, document.buffers.size() > num_buffers, &document));
    result.meets_bytes = !options.bytes.has_value() || result.glb.size() <= *options.bytes;
    return result;
  }
  LACERTA_RETURN_IF_ERROR(progressive.status());
  LACERTA_ASSIGN_OR_RETURN(const Source source, ReadSource(std::move(document), std::move(progressive).value()));
  const std::vector<uint64_t> levels = LevelsOf(source.progressive.segments, source.progressive.streams.size());
  size_t count = levels.size();
  const uint64_t level = options.level.has_value() ? static_cast<uint64_t>(std::max(*options.level, 0)) : ~uint64_t{0};
  const std::vector<size_t> order = OrderByLevel(levels, level, &count);
  LACERTA_ASSIGN_OR_RETURN(result.glb, Write(source, order, count));
  if (!options.bytes.has_value() || result.glb.size() <= *options.bytes) return result;
  // The bases open the order and always stay; between them and all of it the size grows with the count.
  size_t low = source.progressive.streams.size();
  size_t high = count;
  LACERTA_ASSIGN_OR_RETURN(result.glb, Write(source, order, low));
  result.meets_bytes = result.glb.size() <= *options.bytes;
  while (result.meets_bytes && high - low > 1) {
    const size_t middle = low + (high - low) / 2;
    LACERTA_ASSIGN_OR_RETURN(Bytes glb, Write(source, order, middle));
    if (glb.size() <= *options.bytes) {
      low = middle;
      result.glb = std::move(glb);
    } else {
      high = middle;
    }
  }
  return result;
}

}  // namespace lacerta
