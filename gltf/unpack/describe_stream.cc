#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "decoder/stream_reader.h"
#include "draco/base_mesh_codec.h"
#include "draco/custom_form.h"
#include "lacerta/gltf.h"
#include "lacerta/surface_distance.h"

namespace lacerta {
namespace {

uint64_t CountEdges(const std::vector<Triangle>& triangles) {
  std::set<std::pair<uint32_t, uint32_t>> edges;
  for (const Triangle& t : triangles) {
    for (size_t i = 0; i < 3; ++i) edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
  }
  return edges.size();
}

// Adds what can be shown of a stream with quality layers, one entry per segment that does not wait for the next one. Vertices are those of
// the finest level that has begun: decoders may show smoother ones.
void AddLayers(Span<const uint8_t> refinement, size_t offset, uint64_t num_edges, StreamInfo* info) {
  StreamInfo::Level level = info->levels[0];
  const uint64_t base_bytes = level.bytes;
  int finest = 0;
  for (;;) {
    const StatusOr<std::optional<ReadLayer>> read = ReadLayerSegment(refinement.Subspan(offset));
    if (!read.ok() || !read.value().has_value()) return;
    offset += read.value()->size;
    for (; finest < read.value()->segment.level; ++finest) {
      level.vertices += num_edges;
      num_edges = 2 * num_edges + 3 * level.triangles;
      level.triangles *= 4;
    }
    if (read.value()->segment.waits) continue;
    level.bytes = base_bytes + offset;
    info->levels.push_back(level);
  }
}

// Adds the levels that are complete: silent ones have no segment.
Status AddLevels(Span<const uint8_t> refinement, uint64_t num_edges, StreamInfo* info) {
  LACERTA_ASSIGN_OR_RETURN(const std::optional<ReadHeader> read, ReadRefinementHeader(refinement));
  if (!read.has_value()) return Status();
  if (read->header.has_layers) {
    AddLayers(refinement, read->size, num_edges, info);
    return Status();
  }
  StreamInfo::Level level = info->levels[0];
  size_t offset = read->size;
  level.bytes += read->size;
  for (size_t i = 1; i <= read->header.steps.size(); ++i) {
    if (!read->header.steps[i - 1].is_silent()) {
      const StatusOr<std::optional<ReadSegment>> segment =
          ReadRefinementSegment(refinement.Subspan(offset), static_cast<int>(i));
      if (!segment.ok() || !segment.value().has_value()) return Status();
      offset += segment.value()->size;
      level.bytes += segment.value()->size;
    }
    level.vertices += num_edges;
    num_edges = 2 * num_edges + 3 * level.triangles;
    level.triangles *= 4;
    info->levels.push_back(level);
  }
  return Status();
}

}  // namespace

StatusOr<StreamInfo> DescribeStream(Span<const uint8_t> stream, const DecodeLimits& limits) {
  StreamParts parts;
  if (IsCustomForm(stream)) {
    LACERTA_ASSIGN_OR_RETURN(parts, SplitCustomForm(stream));
  }
  LACERTA_ASSIGN_OR_RETURN(const DecodedBase base,
                           IsCustomForm(stream) ? DecodeBaseOf(parts, limits) : DecodeBaseMesh(stream, limits));
  if (!IsCustomForm(stream)) parts.refinement = stream.Subspan(base.bytes_used);
  StreamInfo info;
  info.diagonal = BoundingBoxDiagonal(base.mesh);
  const uint64_t base_bytes = stream.size() - parts.refinement.size();
  info.levels.push_back({base.mesh.positions.size(), base.mesh.triangles.size(), base_bytes, std::nullopt, true});
  if (!parts.refinement.empty()) {
    LACERTA_RETURN_IF_ERROR(AddLevels(parts.refinement, CountEdges(base.mesh.triangles), &info));
  }
  return info;
}

}  // namespace lacerta
