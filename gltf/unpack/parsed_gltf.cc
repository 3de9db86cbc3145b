#include "lacerta/parsed_gltf.h"

#include <algorithm>
#include <utility>

#include "decoder/smooth_normals.h"
#include "document/accessor.h"
#include "document/gltf_document.h"
#include "document/place.h"
#include "extension/progressive.h"
#include "unpack/surface_reader.h"

namespace lacerta {
namespace {

RefinedGeometry ToArrays(ProgressiveSurface surface) {
  RefinedGeometry geometry;
  geometry.from_fallback = surface.from_fallback;
  geometry.note = std::move(surface.note);
  if (surface.from_fallback) return geometry;
  const TriangleMesh& mesh = surface.surface;
  geometry.level = surface.level;
  geometry.num_levels = surface.num_levels;
  geometry.num_vertices = mesh.positions.size();
  const Bounds bounds = BoundsOf(mesh.positions);
  geometry.min = bounds.min;
  geometry.max = bounds.max;
  geometry.positions = MakeFloatAccessor(mesh.positions).bytes;
  if (surface.smooth_normals) geometry.normals = MakeFloatAccessor(SmoothNormals(mesh.positions, mesh.triangles)).bytes;
  for (VertexSoup::Attribute& attribute : surface.attributes) {
    AccessorData values = ToAccessor(attribute);
    if (attribute.name == "NORMAL" && attribute.components == 3) {
      geometry.normals = std::move(values.bytes);
    } else {
      geometry.attributes.push_back({std::move(attribute.name), attribute.components, std::move(values.bytes),
                                     static_cast<uint32_t>(values.type)});
    }
  }
  for (const std::vector<VertexSoup::Attribute>& target : surface.targets) {
    geometry.targets.emplace_back();
    for (const VertexSoup::Attribute& offsets : target)
      geometry.targets.back().push_back({offsets.name, offsets.components, ToAccessor(offsets).bytes});
  }
  AccessorData indices = MakeIndexAccessor(mesh.triangles, mesh.positions.size());
  geometry.num_indices = indices.count;
  geometry.index_type = static_cast<uint32_t>(indices.type);
  geometry.indices = std::move(indices.bytes);
  return geometry;
}

}  // namespace

StatusOr<std::vector<RefinedGeometry>> RefineParsedGltf(const std::string& json,
                                                        const std::vector<Span<const uint8_t>>& buffers,
                                                        const UnpackOptions& options) {
  if (options.level.value_or(0) < 0) {
    return InvalidArgument("level " + std::to_string(*options.level) + " does not exist; 0 is the base mesh");
  }
  GltfDocument document;
  LACERTA_ASSIGN_OR_RETURN(document.json, ParseGltfJson(json));
  document.borrowed_buffers = buffers;
  const StatusOr<Progressive> progressive = ParseProgressive(document);
  std::vector<RefinedGeometry> geometries;
  AttributedCache cache;
  for (const std::vector<Place>& places : GroupByGeometry(document)) {
    if (FindExtension(PrimitiveAt(document, places[0]), kProgressiveName) == nullptr) continue;
    StatusOr<ProgressiveSurface> surface = ReadRefinedSurface(document, progressive, places[0], options, &cache);
    if (!surface.ok()) return surface.status().WithContext(PlaceName(document, places[0]));
    geometries.push_back(ToArrays(std::move(surface).value()));
    for (const Place& place : places) geometries.back().primitives.push_back({place.mesh, place.primitive});
  }
  return geometries;
}

}  // namespace lacerta
