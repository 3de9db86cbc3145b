#include <algorithm>
#include <set>

#include "document/buffer_edit.h"
#include "document/gltf_document.h"
#include "document/place.h"
#include "extension/progressive.h"
#include "lacerta/gltf.h"

namespace lacerta {
namespace {

Fallback FallbackOf(const GltfDocument& document, const Json& primitive) {
  if (PrimitiveExtension(primitive, kDracoName) != nullptr) return Fallback::kDraco;
  const Json* attributes = Find(primitive, "attributes");
  const std::optional<uint64_t> position =
      attributes == nullptr ? std::nullopt : AsIndex(Find(*attributes, "POSITION"));
  return position.has_value() && !ViewsOfAccessor(document, *position).empty() ? Fallback::kPlain : Fallback::kNone;
}

StreamInfo StreamOfAsset(const Progressive& progressive, uint64_t index, uint64_t data_size) {
  const ProgressiveStream& stream = progressive.streams[static_cast<size_t>(index)];
  StreamInfo info;
  info.diagonal = Norm(Vec3Cast<double>(stream.max) - Vec3Cast<double>(stream.min));
  uint64_t offset = 0;
  uint64_t bytes = 0;
  for (const Segment& segment : progressive.segments) {
    offset += segment.length;
    if (segment.stream != index) continue;
    bytes += segment.length;
    const size_t level = info.levels.size();
    info.levels.push_back(
        {stream.vertex_counts[level], stream.triangle_counts[level], bytes, stream.errors[level], offset <= data_size});
  }
  return info;
}

}  // namespace

StatusOr<AssetInfo> DescribeGltf(Span<const uint8_t> asset, const std::string& folder) {
  LACERTA_ASSIGN_OR_RETURN(const GltfDocument document, ParseGltf(asset, folder));
  const StatusOr<Progressive> progressive = ParseProgressive(document);
  if (!progressive.ok() && progressive.status().code() != StatusCode::kNotFound) return progressive.status();
  AssetInfo info;
  std::set<uint64_t> described;
  for (const Place& place : AllPlaces(document)) {
    const Json& primitive = PrimitiveAt(document, place);
    ++info.num_primitives;
    const Json* extension = PrimitiveExtension(primitive, kProgressiveName);
    if (extension == nullptr) {
      if (PrimitiveExtension(primitive, kDracoName) != nullptr) ++info.num_draco_primitives;
      continue;
    }
    if (!progressive.ok()) return progressive.status();
    LACERTA_ASSIGN_OR_RETURN(const uint64_t index, GetIndex(*extension, "stream"));
    if (index >= progressive.value().streams.size()) {
      return InvalidData(PlaceName(document, place) + ": stream " + std::to_string(index) + " does not exist");
    }
    if (!described.insert(index).second) continue;
    if (info.streams.empty()) info.fallback = FallbackOf(document, primitive);
    const StatusOr<Span<const uint8_t>> data = AvailableViewBytes(document, progressive.value().data);
    StreamInfo stream = StreamOfAsset(progressive.value(), index, data.ok() ? data.value().size() : 0);
    stream.mesh = place.mesh;
    stream.primitive = place.primitive;
    stream.name = AsString(Find(*FindElement(document.json, "meshes", place.mesh), "name"));
    info.streams.push_back(std::move(stream));
  }
  return info;
}

}  // namespace lacerta
