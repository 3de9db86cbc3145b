#include <algorithm>
#include <utility>

#include "document/buffer_edit.h"
#include "document/draco_encode.h"
#include "document/gltf_document.h"
#include "extension/progressive.h"
#include "lacerta/gltf.h"
#include "pack/accessor_pool.h"
#include "pack/plan.h"
#include "pack/replace_geometry.h"
#include "pack/single_mesh.h"

namespace lacerta {
namespace {

void StoreDraco(const PrimitivePlan& plan, AccessorPool* pool, GltfDocument* document) {
  const DracoEncoded& encoded = *plan.draco;
  NewGeometry geometry = DescribedGeometry(encoded.decoded);
  geometry.targets = TargetAccessors(plan.targets, plan.places[0], document);
  Json ids = Json::object();
  for (const DracoAttributeId& id : encoded.ids) ids[id.name] = id.id;
  const uint64_t view = AddBufferView(AddBuffer(encoded.bytes, document), 0, encoded.bytes.size(), document);
  geometry.extensions[kDracoName] = {{"bufferView", view}, {"attributes", std::move(ids)}};
  ReplaceGeometry(plan.geometries, plan.places, std::move(geometry), pool, document);
}

// All progressive streams of an asset in transmission order.
struct Transmission {
  Progressive progressive;
  Bytes data;
  std::vector<uint64_t> base_offsets;  // per stream, in `data`
  uint64_t bases_end = 0;              // in `data`: bases come first
};

StatusOr<Transmission> Transmit(const std::vector<const PrimitivePlan*>& plans) {
  Transmission result;
  std::vector<std::vector<uint64_t>> lengths;
  std::vector<std::vector<double>> errors;
  for (const PrimitivePlan* plan : plans) {
    const EncodedMesh& encoded = *plan->progressive;
    lengths.emplace_back(encoded.part_sizes.begin(), encoded.part_sizes.end());
    ProgressiveStream stream;
    for (const LevelReport& level : encoded.report.levels) {
      stream.vertex_counts.push_back(level.vertices);
      stream.triangle_counts.push_back(level.triangles);
      stream.errors.push_back(level.error);
    }
    errors.push_back(stream.errors);
    stream.smooth_normals = plan->smooth_normals;
    LACERTA_ASSIGN_OR_RETURN(const DecodedMesh finest, DecodeMesh(encoded.stream, {}));
    LACERTA_RETURN_IF_ERROR(finest.refinement);
    stream.min = stream.max = finest.mesh.positions.empty() ? Vec3f{} : finest.mesh.positions[0];
    for (const Vec3f& position : finest.mesh.positions) {
      for (int axis = 0; axis < 3; ++axis) {
        stream.min[axis] = std::min(stream.min[axis], position[axis]);
        stream.max[axis] = std::max(stream.max[axis], position[axis]);
      }
    }
    result.progressive.streams.push_back(std::move(stream));
  }
  result.progressive.segments = OrderSegments(lengths, errors);
  std::vector<size_t> taken(plans.size(), 0);
  result.base_offsets.resize(plans.size());
  for (const Segment& segment : result.progressive.segments) {
    const auto s = static_cast<size_t>(segment.stream);
    const bool is_base = taken[s] == 0;
    if (is_base) result.base_offsets[s] = result.data.size();
    const Bytes& stream = plans[s]->progressive->stream;
    const auto begin = stream.begin() + static_cast<std::ptrdiff_t>(taken[s]);
    result.data.insert(result.data.end(), begin, begin + static_cast<std::ptrdiff_t>(segment.length));
    taken[s] += static_cast<size_t>(segment.length);
    if (is_base) result.bases_end = result.data.size();
  }
  return result;
}

StatusOr<TriangleMesh> DecodeLevel(const Bytes& stream, std::optional<int> level) {
  DecodeOptions options;
  options.max_level = level;
  LACERTA_ASSIGN_OR_RETURN(DecodedMesh decoded, DecodeMesh(stream, options));
  return std::move(decoded.mesh);
}

// The fallback whose base Draco decodes itself: its vertices, in its order.
StatusOr<NewGeometry> DracoFallback(const EncodedMesh& encoded, uint64_t data_buffer, uint64_t offset,
                                    GltfDocument* document) {
  const uint64_t length = encoded.part_sizes[0];
  const Span<const uint8_t> base = Span<const uint8_t>(encoded.stream).First(static_cast<size_t>(length));
  LACERTA_ASSIGN_OR_RETURN(const uint32_t id, DracoPositionId(base));
  LACERTA_ASSIGN_OR_RETURN(const Primitive primitive, DecodeDracoPrimitive(base, {{"POSITION", id}}, DecodeLimits{}));
  NewGeometry geometry = DescribedGeometry(Surface(primitive));
  const uint64_t view = AddBufferView(data_buffer, offset, length, document);
  geometry.extensions[kDracoName] = {{"bufferView", view}, {"attributes", {{"POSITION", id}}}};
  return geometry;
}

// `external` takes what follows the bases, unless it is null.
Status StoreProgressive(const std::vector<const PrimitivePlan*>& plans, Fallback fallback, Bytes* external,
                        AccessorPool* pool, GltfDocument* document) {
  LACERTA_ASSIGN_OR_RETURN(Transmission transmission, Transmit(plans));
  std::vector<NewGeometry> geometries;
  if (fallback != Fallback::kDraco) {
    for (const PrimitivePlan* plan : plans) {
      const bool plain = fallback == Fallback::kPlain;
      LACERTA_ASSIGN_OR_RETURN(const TriangleMesh mesh,
                               DecodeLevel(plan->progressive->stream, plain ? std::optional<int>(0) : std::nullopt));
      geometries.push_back(plain ? PlainGeometry(mesh, plan->smooth_normals, document) : DescribedGeometry(mesh));
    }
  }
  if (external != nullptr) {
    const auto bases_end = transmission.data.begin() + static_cast<std::ptrdiff_t>(transmission.bases_end);
    external->assign(bases_end, transmission.data.end());
    transmission.data.erase(bases_end, transmission.data.end());
  }
  // The last buffer, so that a file cut short loses refinements only.
  const uint64_t length = transmission.data.size();
  const uint64_t buffer = AddBuffer(std::move(transmission.data), document);
  transmission.progressive.data = AddBufferView(buffer, 0, length, document);
  for (size_t s = 0; s < plans.size() && fallback == Fallback::kDraco; ++s) {
    LACERTA_ASSIGN_OR_RETURN(NewGeometry geometry,
                             DracoFallback(*plans[s]->progressive, buffer, transmission.base_offsets[s], document));
    geometries.push_back(std::move(geometry));
  }
  for (size_t s = 0; s < plans.size(); ++s) {
    geometries[s].extensions[kProgressiveName] = {{"stream", s}, {"group", 0}};
    ReplaceGeometry(plans[s]->geometries, plans[s]->places, std::move(geometries[s]), pool, document);
  }
  document->json["extensions"][kProgressiveName] = FormatProgressive(transmission.progressive);
  return Status();
}

// A buffer after the one of the GLB, with all bytes in a file of its own.
void ReferToExternal(const Bytes& external, const std::string& uri, GltfDocument* document) {
  const uint64_t buffer = AddBuffer(external, document);
  document->json["buffers"][static_cast<size_t>(buffer)]["uri"] = uri;
  const uint64_t view = AddBufferView(buffer, 0, external.size(), document);
  document->json["extensions"][kProgressiveName]["refinements"] = view;
}

void DeclareExtensions(Fallback fallback, bool progressive, GltfDocument* document) {
  DeclareDraco(document);
  if (!progressive) return;
  AddExtension("extensionsUsed", kProgressiveName, document);
  if (fallback == Fallback::kNone) AddExtension("extensionsRequired", kProgressiveName, document);
}

StatusOr<PackResult> PackDocument(GltfDocument document, const PackOptions& options) {
  if (options.fallback == Fallback::kDraco && options.encode.form != StreamForm::kDraco) {
    return InvalidArgument(
        "the fallback \"draco\" needs the Draco form of the stream; choose another fallback for the custom form");
  }
  if (UsesExtension(document.json, kProgressiveName)) {
    return Unsupported("the asset is packed already; unpack it first, or pack the original, which loses less");
  }
  LACERTA_ASSIGN_OR_RETURN(const std::vector<PrimitivePlan> plans, PlanPrimitives(document, options));
  std::set<uint64_t> unused_views = DracoViews(document);
  std::vector<Place> geometries;
  for (const PrimitivePlan& plan : plans) {
    geometries.insert(geometries.end(), plan.geometries.begin(), plan.geometries.end());
  }
  AccessorPool pool(document, geometries);
  std::vector<const PrimitivePlan*> progressive;
  PackResult result;
  for (const PrimitivePlan& plan : plans) {
    if (plan.draco.has_value()) StoreDraco(plan, &pool, &document);
    if (plan.progressive.has_value()) progressive.push_back(&plan);
    result.report.primitives.push_back(plan.report);
  }
  if (!progressive.empty()) LACERTA_RETURN_IF_ERROR(StoreProgressive(progressive, options.fallback,
                                                                  options.external_uri.empty() ? nullptr : &result.external, &pool,
                                                                  &document));
  DeclareExtensions(options.fallback, !progressive.empty(), &document);
  unused_views.insert(pool.released_views().begin(), pool.released_views().end());
  DropUnusedViews(unused_views, &document);
  LACERTA_RETURN_IF_ERROR(MergeBuffers(&document));
  if (!result.external.empty()) ReferToExternal(result.external, options.external_uri, &document);
  if (plans.empty()) result.report.notes.push_back("the asset holds no mesh");
  result.glb = FormatGlb(document);
  return result;
}

}  // namespace

StatusOr<PackResult> PackGltf(Span<const uint8_t> asset, const PackOptions& options) {
  LACERTA_ASSIGN_OR_RETURN(GltfDocument document, ParseGltf(asset, options.folder));
  return PackDocument(std::move(document), options);
}

StatusOr<PackResult> PackMesh(const TriangleMesh& mesh, const std::string& name, const PackOptions& options) {
  if (mesh.triangles.empty()) return InvalidData("the mesh has no triangles");
  return PackDocument(SingleMeshDocument(mesh, name), options);
}

}  // namespace lacerta
