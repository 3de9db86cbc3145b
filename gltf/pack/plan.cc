#include "pack/plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "document/buffer_edit.h"
#include "document/normals.h"
#include "extension/progressive.h"

namespace lacerta {
namespace {

// Where a target in bytes says nothing about the precision of Draco primitives.
constexpr double kDefaultPsnr = 70.0;
// JSON that KHR_draco_mesh_compression costs for one primitive.
constexpr uint64_t kDracoJsonBytes = 150;

struct Source {
  PrimitivePlan plan;
  std::optional<Primitive> primitive;  // empty: cannot be compressed, plan.report.reason says why
};

// Why a primitive has to stay as it is whatever it holds; empty when it need not.
std::string ReasonToKeep(const GltfDocument& document, const Json& primitive) {
  if (AsIndex(Find(primitive, "mode")).value_or(4) < 4) return "holds points or lines";
  if (ArraySize(primitive, "targets") > 0) return "has morph targets, which refer to its vertices by their order";
  if (const Json* extensions = Find(primitive, "extensions"); extensions != nullptr && extensions->is_object()) {
    for (const auto& [name, value] : extensions->items()) {
      if (name != kDracoName && name != "KHR_materials_variants")
        return "has the extension " + name + ", which may refer to its vertices";
    }
  }
  if (const Json* attributes = Find(primitive, "attributes"); attributes != nullptr && attributes->is_object()) {
    for (const auto& [name, index] : attributes->items()) {
      const Json* accessor = FindElement(document.json, "accessors", AsIndex(&index).value_or(~uint64_t{0}));
      if (accessor != nullptr && Find(*accessor, "sparse") != nullptr) return name + " is a sparse accessor";
    }
  }
  return "";
}

uint64_t StoredBytes(const GltfDocument& document, const Json& json, const Primitive& primitive) {
  const Json* extensions = Find(json, "extensions");
  const Json* draco = extensions == nullptr ? nullptr : Find(*extensions, kDracoName);
  if (draco != nullptr) {
    const StatusOr<Span<const uint8_t>> bytes =
        BufferViewBytes(document, AsIndex(Find(*draco, "bufferView")).value_or(0));
    return bytes.ok() ? bytes.value().size() : 0;
  }
  uint64_t sum = 0;
  for (const Attribute& attribute : primitive.attributes) sum += attribute.data.bytes.size();
  if (const std::optional<uint64_t> index = AsIndex(Find(json, "indices")); index.has_value()) {
    const StatusOr<AccessorData> indices = ReadAccessor(document, *index);
    if (indices.ok()) sum += indices.value().bytes.size();
  }
  return sum;
}

// Fails only on damaged data; what is legal but not for us ends as a reason.
Status ReadSource(const GltfDocument& document, const Json& json, Source* source) {
  source->plan.report.reason = ReasonToKeep(document, json);
  if (!source->plan.report.reason.empty()) return Status();
  StatusOr<Primitive> primitive = ReadPrimitive(document, json, DecodeLimits{});
  if (primitive.status().code() == StatusCode::kUnsupported) {
    source->plan.report.reason = primitive.status().message();
    return Status();
  }
  if (!primitive.ok()) return primitive.status();
  source->plan.report.bytes_before = StoredBytes(document, json, primitive.value());
  source->primitive = std::move(primitive).value();
  return Status();
}

StatusOr<std::vector<Source>> ReadSources(const GltfDocument& document) {
  std::vector<Source> sources;
  for (const std::vector<Place>& places : GroupByGeometry(document)) {
    const Place place = places[0];
    Source source;
    source.plan.places = places;
    source.plan.report.mesh = place.mesh;
    source.plan.report.primitive = place.primitive;
    source.plan.report.name = AsString(Find(*FindElement(document.json, "meshes", place.mesh), "name"));
    const Status status = ReadSource(document, PrimitiveAt(document, place), &source);
    if (!status.ok()) return status.WithContext(PlaceName(document, place));
    sources.push_back(std::move(source));
  }
  return sources;
}

// Why it cannot be progressive in this version; empty when it can. Sets *smooth where normals go with the surface.
std::string ReasonAgainstProgressive(const GltfDocument& document, const Source& source, bool* smooth) {
  for (const Place& place : source.plan.places) {
    const uint64_t count = ArraySize(*FindElement(document.json, "meshes", place.mesh), "primitives");
    if (count > 1) return "its mesh has " + std::to_string(count) + " primitives, which would not stay joined";
  }
  for (const Attribute& attribute : source.primitive->attributes) {
    if (attribute.name != "POSITION" && attribute.name != "NORMAL") return "has the attribute " + attribute.name;
  }
  if (source.primitive->Find("POSITION")->data.type != ComponentType::kFloat) return "its positions are integers";
  const Attribute* normal = source.primitive->Find("NORMAL");
  if (normal == nullptr) return "";
  if (normal->data.components != 3) return "its normals are not of type VEC3";
  std::vector<Vec3f> normals;
  for (uint64_t v = 0; v < source.primitive->num_vertices; ++v) {
    normals.push_back({normal->data.Float(v, 0), normal->data.Float(v, 1), normal->data.Float(v, 2)});
  }
  *smooth = NormalsAreDerivable(Surface(*source.primitive), normals);
  return *smooth ? "" : "its normals hold creases that the surface alone does not tell";
}

double TargetPsnr(const EncodeTarget& target) {
  switch (target.kind) {
    case EncodeTarget::Kind::kPsnr:
      return target.value;
    case EncodeTarget::Kind::kError:
      return -20.0 * std::log10(target.value);
    case EncodeTarget::Kind::kBytes:
    case EncodeTarget::Kind::kBitsPerVertex:
      break;
  }
  return kDefaultPsnr;
}

// One grid for all primitives of the mesh that the source is in.
PositionGrid MeshGrid(const std::vector<Source>& sources, uint64_t mesh, double psnr) {
  Vec3f min, max;
  bool first = true;
  for (const Source& source : sources) {
    const bool inside = std::any_of(source.plan.places.begin(), source.plan.places.end(),
                                    [&](const Place& place) { return place.mesh == mesh; });
    if (!inside || !source.primitive.has_value()) continue;
    for (const Vec3f& position : Surface(*source.primitive).positions) {
      for (int axis = 0; axis < 3; ++axis) {
        min[axis] = first ? position[axis] : std::min(min[axis], position[axis]);
        max[axis] = first ? position[axis] : std::max(max[axis], position[axis]);
      }
      first = false;
    }
  }
  return MakePositionGrid(min, max, psnr);
}

void PlanDraco(const PositionGrid& grid, Source* source) {
  PrimitiveReport& report = source->plan.report;
  StatusOr<DracoEncoded> encoded = EncodeDracoPrimitive(*source->primitive, grid);
  if (!encoded.ok()) {
    report.reason += (report.reason.empty() ? "" : "; ") + encoded.status().message();
    return;
  }
  const uint64_t bytes = encoded.value().bytes.size();
  if (bytes + kDracoJsonBytes >= report.bytes_before) {
    report.reason += (report.reason.empty() ? "" : "; ") + std::string("compressed it would be larger (") +
                     std::to_string(bytes) + " bytes and their description)";
    return;
  }
  report.storage = PrimitiveStorage::kDraco;
  report.bytes_after = bytes;
  source->plan.draco = std::move(encoded).value();
}

Status PlanProgressive(const EncodeOptions& options, Source* source) {
  PrimitiveReport& report = source->plan.report;
  StatusOr<EncodedMesh> encoded = EncodeMesh(Surface(*source->primitive), options);
  if (encoded.status().code() == StatusCode::kInvalidArgument) return encoded.status();
  if (!encoded.ok()) {
    report.reason = encoded.status().message();
    return Status();
  }
  const EncodedMesh& mesh = encoded.value();
  if (mesh.part_sizes.empty() || mesh.part_sizes.size() != mesh.report.levels.size()) {
    return InternalError("the encoder reported another number of levels than it wrote");
  }
  report.storage = PrimitiveStorage::kProgressive;
  report.reason = mesh.report.reason;
  report.bytes_after = mesh.stream.size();
  report.encode = mesh.report;
  source->plan.progressive = std::move(encoded).value();
  return Status();
}

// A byte budget for the asset is shared by the number of vertices.
EncodeOptions ShareTarget(const EncodeOptions& options, uint64_t vertices, uint64_t all_vertices) {
  EncodeOptions shared = options;
  if (options.target.kind == EncodeTarget::Kind::kBytes && all_vertices > 0) {
    shared.target.value = options.target.value * static_cast<double>(vertices) / static_cast<double>(all_vertices);
  }
  return shared;
}

}  // namespace

StatusOr<std::vector<PrimitivePlan>> PlanPrimitives(const GltfDocument& document, const PackOptions& options) {
  LACERTA_ASSIGN_OR_RETURN(std::vector<Source> sources, ReadSources(document));
  std::vector<bool> progressive(sources.size(), false);
  uint64_t all_vertices = 0;
  for (size_t i = 0; i < sources.size(); ++i) {
    Source& source = sources[i];
    if (!source.primitive.has_value()) continue;
    source.plan.report.reason = ReasonAgainstProgressive(document, source, &source.plan.smooth_normals);
    progressive[i] = source.plan.report.reason.empty();
    if (progressive[i]) all_vertices += source.primitive->num_vertices;
  }
  std::vector<PrimitivePlan> plans;
  for (size_t i = 0; i < sources.size(); ++i) {
    Source& source = sources[i];
    PrimitivePlan& plan = source.plan;
    if (progressive[i]) {
      const EncodeOptions encode = ShareTarget(options.encode, source.primitive->num_vertices, all_vertices);
      const Status status = PlanProgressive(encode, &source);
      if (!status.ok()) return status.WithContext(PlaceName(document, plan.places[0]));
    }
    if (!plan.progressive.has_value() && source.primitive.has_value()) {
      if (options.fallback == Fallback::kPlain) {
        plan.report.reason += "; left as it is so that every reader opens the asset";
      } else {
        PlanDraco(MeshGrid(sources, plan.places[0].mesh, TargetPsnr(options.encode.target)), &source);
      }
    }
    if (plan.report.storage == PrimitiveStorage::kUntouched) plan.report.bytes_after = plan.report.bytes_before;
  }
  for (Source& source : sources) plans.push_back(std::move(source.plan));
  return plans;
}

}  // namespace lacerta
