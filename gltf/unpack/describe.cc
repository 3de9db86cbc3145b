#include <algorithm>
#include <set>

#include "document/accessor.h"
#include "document/view_references.h"
#include "document/gltf_document.h"
#include "document/place.h"
#include "extension/progressive.h"
#include "lacerta/gltf.h"

namespace lacerta {
namespace {

Fallback FallbackOf(const GltfDocument& document, const Json& primitive) {
  if (FindExtension(primitive, kDracoName) != nullptr) return Fallback::kDraco;
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

// Bytes of an accessor's own data, by its description.
uint64_t AccessorBytes(const GltfDocument& document, const Json* index) {
  const Json* accessor =
      index == nullptr ? nullptr : FindElement(document.json, "accessors", AsIndex(index).value_or(~uint64_t{0}));
  if (accessor == nullptr || Find(*accessor, "bufferView") == nullptr) return 0;
  const StatusOr<AccessorData> data = ReadAccessor(document, *AsIndex(index));
  return data.ok() ? data.value().bytes.size() : 0;
}

PrimitiveInfo DescribePrimitive(const GltfDocument& document, const Place& place) {
  const Json& primitive = PrimitiveAt(document, place);
  PrimitiveInfo info;
  info.mesh = place.mesh;
  info.primitive = place.primitive;
  info.name = AsString(Find(*FindElement(document.json, "meshes", place.mesh), "name"));
  const auto count_of = [&](const Json* index) {
    const Json* accessor =
        index == nullptr ? nullptr : FindElement(document.json, "accessors", AsIndex(index).value_or(~uint64_t{0}));
    return accessor == nullptr ? 0 : AsIndex(Find(*accessor, "count")).value_or(0);
  };
  const Json* attributes = Find(primitive, "attributes");
  if (attributes != nullptr) info.vertices = count_of(Find(*attributes, "POSITION"));
  const uint64_t mode = AsIndex(Find(primitive, "mode")).value_or(4);
  const Json* indices = Find(primitive, "indices");
  const uint64_t corners = indices != nullptr ? count_of(indices) : info.vertices;
  if (mode == 4) info.triangles = corners / 3;
  if (mode > 4 && corners > 2) info.triangles = corners - 2;
  const Json* draco = FindExtension(primitive, kDracoName);
  if (FindExtension(primitive, kProgressiveName) != nullptr) {
    info.storage = PrimitiveStorage::kProgressive;
  } else if (draco != nullptr) {
    info.storage = PrimitiveStorage::kDraco;
    const StatusOr<Span<const uint8_t>> bytes =
        AvailableViewBytes(document, AsIndex(Find(*draco, "bufferView")).value_or(~uint64_t{0}));
    info.bytes = bytes.ok() ? bytes.value().size() : 0;
  } else {
    info.bytes = AccessorBytes(document, indices);
    if (attributes != nullptr && attributes->is_object()) {
      for (const Json& index : *attributes) info.bytes += AccessorBytes(document, &index);
    }
  }
  return info;
}

}  // namespace

StatusOr<AssetInfo> DescribeGltf(Span<const uint8_t> asset, const std::string& folder) {
  LACERTA_ASSIGN_OR_RETURN(const GltfDocument document, ParseGltf(asset, folder));
  const StatusOr<Progressive> progressive = ParseProgressive(document);
  if (!progressive.ok() && progressive.status().code() != StatusCode::kNotFound) return progressive.status();
  AssetInfo info;
  uint64_t data_size = 0;
  if (progressive.ok()) {
    const StatusOr<Bytes> data = TransmittedBytes(document, progressive.value());
    if (data.ok()) data_size = data.value().size();
  }
  std::set<uint64_t> described;
  for (const Place& place : AllPlaces(document)) {
    const Json& primitive = PrimitiveAt(document, place);
    ++info.num_primitives;
    info.primitives.push_back(DescribePrimitive(document, place));
    const Json* extension = FindExtension(primitive, kProgressiveName);
    if (extension == nullptr) {
      if (FindExtension(primitive, kDracoName) != nullptr) ++info.num_draco_primitives;
      continue;
    }
    if (!progressive.ok()) return progressive.status();
    LACERTA_ASSIGN_OR_RETURN(const uint64_t index, GetIndex(*extension, "stream"));
    if (index >= progressive.value().streams.size()) {
      return InvalidData(PlaceName(document, place) + ": stream " + std::to_string(index) + " does not exist");
    }
    if (!described.insert(index).second) continue;
    if (info.streams.empty()) info.fallback = FallbackOf(document, primitive);
    StreamInfo stream = StreamOfAsset(progressive.value(), index, data_size);
    stream.mesh = place.mesh;
    stream.primitive = place.primitive;
    stream.name = AsString(Find(*FindElement(document.json, "meshes", place.mesh), "name"));
    info.streams.push_back(std::move(stream));
  }
  return info;
}

}  // namespace lacerta
