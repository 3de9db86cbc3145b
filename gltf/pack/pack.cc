#include <algorithm>
#include <map>
#include <utility>

#include "document/accessor.h"
#include "document/buffer_edit.h"
#include "document/merge_buffers.h"
#include "document/draco_encode.h"
#include "document/embed_images.h"
#include "document/gltf_document.h"
#include "document/references.h"
#include "draco/within_memory.h"
#include "extension/progressive.h"
#include "lacerta/gltf.h"
#include "pack/accessor_pool.h"
#include "pack/large_shape.h"
#include "pack/plan.h"
#include "pack/repair.h"
#include "pack/replace_geometry.h"
#include "pack/single_mesh.h"
#include "pack/unused_attributes.h"

namespace lacerta {
namespace {

Json DracoReference(uint64_t view, const std::vector<DracoAttributeId>& attributes) {
  Json ids = Json::object();
  for (const DracoAttributeId& id : attributes) ids[id.name] = id.id;
  return {{"bufferView", view}, {"attributes", std::move(ids)}};
}

void StoreDraco(const PrimitivePlan& plan, AccessorPool* pool, GltfDocument* document) {
  const DracoEncoded& encoded = *plan.draco;
  NewGeometry geometry = DescribedGeometry(encoded.decoded);
  geometry.targets = TargetAccessors(plan.targets, document);
  const uint64_t view = AddBufferView(AddBuffer(encoded.bytes, document), 0, encoded.bytes.size(), document);
  geometry.extensions[kDracoName] = DracoReference(view, encoded.ids);
  ReplaceGeometry(plan.geometries, plan.places, std::move(geometry), pool, document);
}

// All progressive streams of an asset in transmission order.
struct Transmission {
  Progressive progressive;
  Bytes data;
  std::vector<uint64_t> base_offsets;  // per stream, in `data`
  uint64_t bases_end = 0;              // in `data`: bases come first
};

// A stream to be stored: of one primitive, or of a family with attributes.
struct StoredStream {
  std::vector<const PrimitivePlan*> plans;  // that show it, by groups
  const Bytes* bytes = nullptr;
  std::vector<uint64_t> part_sizes;
  ProgressiveStream description;
};

StatusOr<ProgressiveStream> DescribeSurface(const PrimitivePlan& plan) {
  const EncodedMesh& encoded = *plan.progressive;
  ProgressiveStream stream;
  for (const LevelReport& level : encoded.report.levels) {
    stream.vertex_counts.push_back(level.vertices);
    stream.triangle_counts.push_back(level.triangles);
    stream.errors.push_back(level.error);
  }
  stream.smooth_normals = plan.smooth_normals;
  LACERTA_ASSIGN_OR_RETURN(const DecodedMesh finest, DecodeMesh(encoded.stream, {}));
  LACERTA_RETURN_IF_ERROR(finest.refinement);
  stream.min = stream.max = finest.mesh.positions.empty() ? Vec3f{} : finest.mesh.positions[0];
  for (const Vec3f& position : finest.mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      stream.min[axis] = std::min(stream.min[axis], position[axis]);
      stream.max[axis] = std::max(stream.max[axis], position[axis]);
    }
  }
  return stream;
}

StatusOr<std::vector<StoredStream>> CollectStreams(const std::vector<PrimitivePlan>& plans) {
  std::vector<StoredStream> streams;
  std::map<const FamilyStream*, size_t> known;
  for (const PrimitivePlan& plan : plans) {
    if (plan.progressive.has_value()) {
      const EncodedMesh& encoded = *plan.progressive;
      LACERTA_ASSIGN_OR_RETURN(ProgressiveStream description, DescribeSurface(plan));
      streams.push_back({{&plan}, &encoded.stream, {encoded.part_sizes.begin(), encoded.part_sizes.end()}, std::move(description)});
    } else if (plan.family != nullptr) {
      const FamilyStream& family = *plan.family;
      const auto [found, is_new] = known.emplace(&family, streams.size());
      if (is_new) streams.push_back({{}, &family.bytes, family.part_sizes, family.description});
      streams[found->second].plans.push_back(&plan);
    }
  }
  return streams;
}

Transmission Transmit(const std::vector<StoredStream>& streams) {
  Transmission result;
  std::vector<std::vector<uint64_t>> lengths;
  std::vector<std::vector<double>> errors;
  for (const StoredStream& stream : streams) {
    lengths.push_back(stream.part_sizes);
    errors.emplace_back();
    for (const double error : stream.description.errors) errors.back().push_back(stream.plans[0]->weight * error * error);
    result.progressive.streams.push_back(stream.description);
  }
  result.progressive.segments = OrderSegments(lengths, errors);
  std::vector<size_t> taken(streams.size(), 0);
  result.base_offsets.resize(streams.size());
  for (const Segment& segment : result.progressive.segments) {
    const auto s = static_cast<size_t>(segment.stream);
    const bool is_base = taken[s] == 0;
    if (is_base) result.base_offsets[s] = result.data.size();
    const auto begin = streams[s].bytes->begin() + static_cast<std::ptrdiff_t>(taken[s]);
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
  LACERTA_ASSIGN_OR_RETURN(const DracoShape shape, DecodeDracoShape(base));
  NewGeometry geometry = DescribedGeometry(shape.primitive);
  const uint64_t view = AddBufferView(data_buffer, offset, length, document);
  geometry.extensions[kDracoName] = DracoReference(view, shape.ids);
  return geometry;
}

// The same for a group of a stream with attributes; offset: of its part of the base section.
NewGeometry GroupFallback(const FamilyStream& family, size_t group, uint64_t data_buffer, uint64_t offset,
                          GltfDocument* document) {
  NewGeometry geometry = DescribedGeometry(family.groups[group].base);
  geometry.targets = TargetAccessors(family.groups[group].targets, document);
  const uint64_t view = AddBufferView(data_buffer, offset, family.description.base_lengths[group], document);
  geometry.extensions[kDracoName] = DracoReference(view, family.groups[group].ids);
  return geometry;
}

// `external` takes what follows the bases, unless it is null.
Status StoreProgressive(const std::vector<StoredStream>& streams, Fallback fallback, Bytes* external, AccessorPool* pool,
                        GltfDocument* document) {
  Transmission transmission = Transmit(streams);
  std::vector<NewGeometry> geometries(streams.size());  // of streams without attributes
  for (size_t s = 0; s < streams.size() && fallback != Fallback::kDraco; ++s) {
    const PrimitivePlan& plan = *streams[s].plans[0];
    const bool plain = fallback == Fallback::kPlain;
    LACERTA_ASSIGN_OR_RETURN(const TriangleMesh mesh,
                             DecodeLevel(*streams[s].bytes, plain ? std::optional<int>(0) : std::nullopt));
    geometries[s] = plain ? PlainGeometry(mesh, plan.smooth_normals, document) : DescribedGeometry(mesh);
  }
  if (external != nullptr) {
    const auto bases_end = transmission.data.begin() + static_cast<std::ptrdiff_t>(transmission.bases_end);
    external->assign(bases_end, transmission.data.end());
    transmission.data.erase(bases_end, transmission.data.end());
  }
  const uint64_t length = transmission.data.size();
  const uint64_t buffer = AddBuffer(std::move(transmission.data), document);
  transmission.progressive.data = AddBufferView(buffer, 0, length, document);
  for (size_t s = 0; s < streams.size(); ++s) {
    uint64_t offset = transmission.base_offsets[s];
    for (const PrimitivePlan* plan : streams[s].plans) {
      NewGeometry geometry;
      if (plan->family != nullptr) {
        geometry = GroupFallback(*plan->family, plan->group, buffer, offset, document);
        offset += plan->family->description.base_lengths[plan->group];
      } else if (fallback == Fallback::kDraco) {
        LACERTA_ASSIGN_OR_RETURN(geometry, DracoFallback(*plan->progressive, buffer, offset, document));
      } else {
        geometry = std::move(geometries[s]);
      }
      geometry.extensions[kProgressiveName] = {{"stream", s}, {"group", plan->group}};
      ReplaceGeometry(plan->geometries, plan->places, std::move(geometry), pool, document);
    }
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
  DeclareQuantization(document);
  if (!progressive) return;
  AddExtension("extensionsUsed", kProgressiveName, document);
  if (fallback == Fallback::kNone) AddExtension("extensionsRequired", kProgressiveName, document);
}

Status CheckOptions(const PackOptions& options) {
  if (options.fallback == Fallback::kDraco && options.encode.form != StreamForm::kDraco) {
    return InvalidArgument(
        "the fallback \"draco\" needs the Draco form of the stream; choose another fallback for the custom form");
  }
  return Status();
}

// Whether all is there that a document refers to: what it lacks would come out as it came in, or be taken to be what is added.
Status CheckComplete(const GltfDocument& document) {
  LACERTA_RETURN_IF_ERROR(CheckReferences(document.json));
  for (uint64_t i = 0; i < ArraySize(document.json, "accessors"); ++i) LACERTA_RETURN_IF_ERROR(CheckAccessor(document, i));
  return Status();
}

// Which primitives have no levels, and why the first of them has none; empty where all have.
std::string DescribeMissingLevels(const std::vector<PrimitiveReport>& reports) {
  const auto has_none = [](const PrimitiveReport& report) { return report.storage != PrimitiveStorage::kProgressive; };
  const auto first = std::find_if(reports.begin(), reports.end(), has_none);
  if (first == reports.end()) return "";
  const auto count = std::count_if(first, reports.end(), has_none);
  return "no levels, though always wanted, for " + std::to_string(count) + " of " + std::to_string(reports.size()) + " primitives; mesh " +
         std::to_string(first->mesh) + ", primitive " + std::to_string(first->primitive) + ": " + first->reason;
}

// The document with the geometry that the plans have for it.
StatusOr<PackResult> StorePlans(GltfDocument document, std::vector<PrimitivePlan> plans, const PackOptions& options) {
  for (PrimitivePlan& plan : plans) LACERTA_RETURN_IF_ERROR(TakeAsDracoIfThatIsAll(options, &plan));
  std::set<uint64_t> unused_views = DracoViews(document);
  std::vector<Place> geometries;
  for (const PrimitivePlan& plan : plans) {
    geometries.insert(geometries.end(), plan.geometries.begin(), plan.geometries.end());
  }
  AccessorPool pool(document, geometries);
  PackResult result;
  for (const PrimitivePlan& plan : plans) {
    if (plan.draco.has_value()) StoreDraco(plan, &pool, &document);
    result.report.primitives.push_back(plan.report);
  }
  LACERTA_ASSIGN_OR_RETURN(const std::vector<StoredStream> streams, CollectStreams(plans));
  if (!streams.empty()) LACERTA_RETURN_IF_ERROR(StoreProgressive(streams, options.fallback,
                                                                  options.external_uri.empty() ? nullptr : &result.external, &pool,
                                                                  &document));
  DeclareExtensions(options.fallback, !streams.empty(), &document);
  unused_views.insert(pool.released_views().begin(), pool.released_views().end());
  DropUnusedViews(unused_views, &document);
  LACERTA_RETURN_IF_ERROR(MergeBuffers(&document));
  if (!result.external.empty()) ReferToExternal(result.external, options.external_uri, &document);
  if (plans.empty()) result.report.notes.push_back("the asset holds no mesh");
  const bool always_levels = options.encode.levels == LevelChoice::kAlways;
  if (const std::string missing = DescribeMissingLevels(result.report.primitives); always_levels && !missing.empty()) result.report.notes.push_back(missing);
  result.glb = FormatGlb(document);
  return result;
}

StatusOr<PackResult> WithNotes(StatusOr<PackResult> result, const std::vector<std::string>& notes) {
  if (result.ok()) result.value().report.notes.insert(result.value().report.notes.begin(), notes.begin(), notes.end());
  return result;
}

StatusOr<PackResult> PackDocument(GltfDocument document, const PackOptions& options) {
  LACERTA_RETURN_IF_ERROR(CheckOptions(options));
  if (UsesExtension(document.json, kProgressiveName)) {
    return Unsupported("the asset is packed already; unpack it first, or pack the original, which loses less");
  }
  LACERTA_ASSIGN_OR_RETURN(std::vector<PrimitivePlan> plans, PlanPrimitives(document, options));
  std::vector<std::string> notes;
  if (const std::string unused = DescribeUnused(document); !unused.empty()) notes.push_back(unused + (options.drop_unused ? "; dropped" : "; kept, --drop-unused drops it"));
  return WithNotes(StorePlans(std::move(document), std::move(plans), options), notes);
}

StatusOr<PackResult> PackLargeShape(FileMesh mesh, const std::string& name, const PackOptions& options) {
  LACERTA_RETURN_IF_ERROR(CheckOptions(options));
  LACERTA_ASSIGN_OR_RETURN(LargeShape shape, PlanLargeShape(std::move(mesh), name, options));
  return StorePlans(std::move(shape.document), std::move(shape.plans), options);
}

}  // namespace

StatusOr<PackResult> PackGltf(Span<const uint8_t> asset, const PackOptions& options) {
  return WithinMemory([&]() -> StatusOr<PackResult> {
    LACERTA_ASSIGN_OR_RETURN(GltfDocument document, ParseGltf(asset, options.folder));
    LACERTA_RETURN_IF_ERROR(CheckComplete(document));
    std::vector<std::string> notes;
    if (options.repair) {
      LACERTA_ASSIGN_OR_RETURN(notes, RepairDocument(&document));
    }
    EmbedImages(options.embed_images ? ImageFiles::kEmbed : ImageFiles::kReferTo, &document, &notes);
    return WithNotes(PackDocument(std::move(document), options), notes);
  });
}

StatusOr<PackResult> PackMesh(const TriangleMesh& mesh, const std::string& name, const PackOptions& options) {
  if (mesh.triangles.empty()) return InvalidData("the mesh has no triangles");
  return WithinMemory([&] { return PackDocument(SingleMeshDocument(mesh, name), options); });
}

StatusOr<PackResult> PackMesh(const FileMesh& mesh, const std::string& name, const PackOptions& options) {
  if (mesh.mesh.surface.triangles.empty()) return InvalidData("the mesh has no triangles");
  return WithinMemory([&]() -> StatusOr<PackResult> {
    LACERTA_ASSIGN_OR_RETURN(const bool is_large, IsLargeShape(mesh, options));
    return WithNotes(is_large ? PackLargeShape(mesh, name, options) : PackDocument(SingleMeshDocument(mesh, name), options), mesh.notes);
  });
}

StatusOr<PackResult> PackMesh(FileMesh&& mesh, const std::string& name, const PackOptions& options) {
  const FileMesh& as_it_is = mesh;
  if (mesh.mesh.surface.triangles.empty()) return InvalidData("the mesh has no triangles");
  return WithinMemory([&]() -> StatusOr<PackResult> {
    LACERTA_ASSIGN_OR_RETURN(const bool is_large, IsLargeShape(mesh, options));
    if (!is_large) return PackMesh(as_it_is, name, options);
    const std::vector<std::string> notes = mesh.notes;
    return WithNotes(PackLargeShape(std::move(mesh), name, options), notes);
  });
}

}  // namespace lacerta
