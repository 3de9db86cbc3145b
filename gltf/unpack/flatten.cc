#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "document/gltf_document.h"
#include "document/place.h"
#include "document/primitive.h"
#include "document/scene.h"
#include "extension/progressive.h"
#include "lacerta/gltf.h"
#include "unpack/surface_reader.h"

namespace lacerta {
namespace {

// The surfaces of the primitives of one mesh, one after the other.
StatusOr<TriangleMesh> ReadMesh(const GltfDocument& document, const StatusOr<Progressive>& progressive, uint64_t mesh,
                                const UnpackOptions& options, std::vector<std::string>* notes, AttributedCache* cache) {
  TriangleMesh all;
  for (uint64_t p = 0; p < ArraySize(*FindElement(document.json, "meshes", mesh), "primitives"); ++p) {
    const Place place = {mesh, p};
    const Json& primitive = PrimitiveAt(document, place);
    TriangleMesh part;
    if (FindExtension(primitive, kProgressiveName) != nullptr) {
      StatusOr<ProgressiveSurface> surface = ReadSurface(document, progressive, place, options, cache);
      if (!surface.ok()) return surface.status().WithContext(PlaceName(document, place));
      if (!surface.value().note.empty()) notes->push_back(PlaceName(document, place) + ": " + surface.value().note);
      part = std::move(surface.value().surface);
    } else {
      const StatusOr<Primitive> read = ReadPrimitive(document, primitive, options.limits);
      if (read.status().code() == StatusCode::kUnsupported) {
        notes->push_back(PlaceName(document, place) + ": left out, it " + read.status().message());
        continue;
      }
      if (!read.ok()) return read.status().WithContext(PlaceName(document, place));
      part = Surface(read.value());
    }
    const auto offset = static_cast<uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
    for (const Triangle& t : part.triangles) all.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return all;
}

Status AppendInstance(const TriangleMesh& mesh, const Transform& transform, const Vec3d& origin, TriangleMesh* world) {
  const auto offset = static_cast<uint32_t>(world->positions.size());
  for (const Vec3f& position : mesh.positions) {
    const Vec3f moved = Vec3Cast<float>(Apply(transform, Vec3Cast<double>(position)) - origin);
    if (!std::isfinite(moved.x) || !std::isfinite(moved.y) || !std::isfinite(moved.z)) {
      return InvalidData("the transform of a node leads to positions that are not finite");
    }
    world->positions.push_back(moved);
  }
  const bool mirrored = Determinant(transform) < 0.0;
  for (const Triangle& t : mesh.triangles) {
    world->triangles.push_back({t[0] + offset, t[mirrored ? 2 : 1] + offset, t[mirrored ? 1 : 2] + offset});
  }
  return Status();
}

}  // namespace

StatusOr<FlattenResult> FlattenGltf(Span<const uint8_t> asset, const UnpackOptions& options) {
  LACERTA_ASSIGN_OR_RETURN(const GltfDocument document, ParseGltf(asset, options.folder));
  const StatusOr<Progressive> progressive = ParseProgressive(document);
  LACERTA_ASSIGN_OR_RETURN(const std::vector<Instance> instances, CollectInstances(document));
  FlattenResult result;
  std::map<uint64_t, TriangleMesh> meshes;
  AttributedCache cache;
  for (const Instance& instance : instances) {
    auto known = meshes.find(instance.mesh);
    if (known == meshes.end()) {
      LACERTA_ASSIGN_OR_RETURN(TriangleMesh mesh,
                               ReadMesh(document, progressive, instance.mesh, options, &result.notes, &cache));
      known = meshes.emplace(instance.mesh, std::move(mesh)).first;
    }
    if (result.mesh.positions.size() + known->second.positions.size() > options.limits.max_vertices ||
        result.mesh.triangles.size() + known->second.triangles.size() > options.limits.max_triangles) {
      return LimitExceeded("the instances of the scene have more vertices or triangles than the limit allows");
    }
    LACERTA_RETURN_IF_ERROR(AppendInstance(known->second, instance.transform, options.origin, &result.mesh));
  }
  if (result.mesh.triangles.empty()) return InvalidData("the scene shows no triangles");
  return result;
}

}  // namespace lacerta
