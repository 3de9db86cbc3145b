#include "pack/plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "document/normals.h"
#include "lacerta/surface_distance.h"
#include "pack/family.h"
#include "pack/precision.h"
#include "pack/texel_scale.h"
#include "pack/vertex_match.h"

namespace lacerta {
namespace {

// Where a target in bytes says nothing about the precision of Draco primitives.
constexpr double kDefaultPsnr = 70.0;
// JSON that KHR_draco_mesh_compression costs for one primitive, and LACERTA_mesh_progressive beyond that.
constexpr uint64_t kDracoJsonBytes = 150;
constexpr uint64_t kProgressiveJsonBytes = 350;

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

bool IsRate(const EncodeTarget& target) {
  return target.kind == EncodeTarget::Kind::kBytes || target.kind == EncodeTarget::Kind::kBitsPerVertex;
}

// Everything that the decisions on single primitives refer to.
struct Context {
  const GltfDocument* document = nullptr;
  const PackOptions* options = nullptr;
  std::vector<Source> sources;
  std::vector<size_t> family_of;  // parallel to `sources`; kNone where there is no primitive
  Families families;
  std::vector<std::optional<SharedLattice>> lattices;  // parallel to families
  uint64_t texel_side = 1024;
};
constexpr size_t kNone = ~size_t{0};

StatusOr<Context> MakeContext(const GltfDocument& document, const PackOptions& options) {
  Context context;
  context.document = &document;
  context.options = &options;
  context.texel_side = TexelSide(document);
  LACERTA_ASSIGN_OR_RETURN(context.sources, ReadSources(document));
  std::vector<PlacedSurface> surfaces;
  std::vector<size_t> source_of;
  for (size_t i = 0; i < context.sources.size(); ++i) {
    if (!context.sources[i].primitive.has_value()) continue;
    surfaces.push_back({&context.sources[i].places, Surface(*context.sources[i].primitive)});
    source_of.push_back(i);
  }
  LACERTA_ASSIGN_OR_RETURN(context.families, FindFamilies(document, surfaces));
  context.family_of.assign(context.sources.size(), kNone);
  for (size_t s = 0; s < surfaces.size(); ++s) context.family_of[source_of[s]] = context.families.of_surface[s];
  for (Family& family : context.families.families) {
    for (size_t& member : family.members) member = source_of[member];
  }
  context.lattices.resize(context.families.families.size());
  return context;
}

double ErrorOf(const Context& context, size_t family) {
  return FamilyError(context.families, family, TargetPsnr(context.options->encode.target));
}

const SharedLattice& LatticeOf(size_t family, Context* context) {
  std::optional<SharedLattice>& lattice = context->lattices[family];
  if (!lattice.has_value()) {
    TriangleMesh all;
    for (const size_t member : context->families.families[family].members) {
      const TriangleMesh part = Surface(*context->sources[member].primitive);
      const auto offset = static_cast<uint32_t>(all.positions.size());
      all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
      for (const Triangle& t : part.triangles) all.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    }
    lattice = FindPositionLattice(all, ErrorOf(*context, family));
  }
  return *lattice;
}

// Why it cannot be progressive in this version; empty when it can. Sets *smooth where normals go with the surface.
std::string ReasonAgainstProgressive(const Context& context, size_t index, bool* smooth) {
  const Source& source = context.sources[index];
  for (const Place& place : source.places) {
    const uint64_t count = ArraySize(*FindElement(context.document->json, "meshes", place.mesh), "primitives");
    if (count > 1) return "its mesh has " + std::to_string(count) + " primitives, which would not stay joined";
  }
  if (context.families.families[context.family_of[index]].members.size() > 1) {
    return "it touches another mesh, from which it would come apart";
  }
  if (!source.targets.empty()) return "has morph targets";
  for (const Attribute& attribute : source.primitive->attributes) {
    if (attribute.name != "POSITION" && attribute.name != "NORMAL") return "has the attribute " + attribute.name;
  }
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

void AddReason(const std::string& reason, PrimitiveReport* report) {
  report->reason += (report->reason.empty() ? "" : "; ") + reason;
}

// Morph targets in the order that the vertices have after coding; false where that order does not tell.
bool ReorderTargets(const Source& source, const DracoPrecision& precision, const Primitive& decoded,
                    std::vector<MorphTarget>* targets) {
  std::vector<AccessorData> tied;
  for (const MorphTarget& target : source.targets) {
    for (const Attribute& attribute : target) tied.push_back(attribute.data);
  }
  const auto order = MatchVertices(RoundAttributes(*source.primitive, precision), decoded, precision, tied);
  if (!order.has_value()) return false;
  *targets = source.targets;
  for (MorphTarget& target : *targets) {
    for (Attribute& attribute : target) attribute.data = Reorder(attribute.data, *order);
  }
  return true;
}

// Draco with all vertices, where that is smaller than what there is: the primitive as it came, or a stream.
void PlanDraco(size_t index, Context* context, PrimitivePlan* plan) {
  const Source& source = context->sources[index];
  PrimitiveReport& report = plan->report;
  const size_t family = context->family_of[index];
  const SharedLattice& lattice = LatticeOf(family, context);
  AttributePrecision attributes =
      FindAttributeBits(*source.primitive, context->options->attributes, [&](uint64_t set) {
        return TexelsPerUnit(*context->document, source.places, set, context->texel_side);
      });
  const DracoPrecision precision = {lattice.lattice, std::move(attributes.bits)};
  StatusOr<DracoEncoded> encoded = EncodeDracoPrimitive(*source.primitive, precision);
  const bool is_progressive = plan->progressive.has_value();
  if (!encoded.ok()) return is_progressive ? void() : AddReason(encoded.status().message(), &report);
  const uint64_t bytes = encoded.value().bytes.size();
  if (bytes + kDracoJsonBytes >= report.bytes_before) {
    return is_progressive ? void()
                          : AddReason("compressed it would be larger (" + std::to_string(bytes) +
                                          " bytes and their description)",
                                      &report);
  }
  if (is_progressive) {
    const uint64_t progressive = plan->progressive->stream.size();
    if (bytes >= progressive + kProgressiveJsonBytes) return;
    report.reason.clear();
    AddReason("all its vertices in Draco are smaller than a stream (" + std::to_string(progressive) + " bytes)",
              &report);
    plan->progressive.reset();
    plan->smooth_normals = false;
    report.encode = {};
  }
  if (!source.targets.empty() && !ReorderTargets(source, precision, encoded.value().decoded, &plan->targets)) {
    return AddReason("has morph targets that tell apart what its other attributes do not", &report);
  }
  report.storage = PrimitiveStorage::kDraco;
  report.bytes_after = bytes;
  report.error = lattice.error;
  report.target_error = ErrorOf(*context, family);
  report.position_bits = lattice.lattice.bits;
  report.attributes = std::move(attributes.reports);
  plan->draco = std::move(encoded).value();
}

// A byte budget for the asset is shared by the number of vertices; an error is the scene's.
EncodeOptions OptionsOf(const Context& context, size_t index, uint64_t all_vertices) {
  EncodeOptions options = context.options->encode;
  const size_t family = context.family_of[index];
  const double diagonal = context.families.families[family].diagonal;
  if (options.target.kind == EncodeTarget::Kind::kBytes && all_vertices > 0) {
    const uint64_t vertices = context.sources[index].primitive->num_vertices;
    options.target.value *= static_cast<double>(vertices) / static_cast<double>(all_vertices);
  } else if (options.target.kind == EncodeTarget::Kind::kPsnr) {
    options.target.value = Psnr(ErrorOf(context, family), diagonal);
  } else if (options.target.kind == EncodeTarget::Kind::kError && diagonal > 0.0) {
    options.target.value = ErrorOf(context, family) / diagonal;
  }
  return options;
}

Status PlanProgressive(const Source& source, const EncodeOptions& options, PrimitivePlan* plan) {
  PrimitiveReport& report = plan->report;
  StatusOr<EncodedMesh> encoded = EncodeMesh(Surface(*source.primitive), options);
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
  report.target_error = options.target.kind == EncodeTarget::Kind::kPsnr
                            ? DistanceOfPsnr(options.target.value, mesh.report.diagonal)
                        : options.target.kind == EncodeTarget::Kind::kError ? options.target.value * mesh.report.diagonal
                                                                            : 0.0;
  plan->progressive = std::move(encoded).value();
  return Status();
}

PrimitivePlan StartPlan(const GltfDocument& document, const Source& source) {
  PrimitivePlan plan;
  plan.places = source.places;
  plan.geometries = source.geometries;
  plan.report.mesh = source.places[0].mesh;
  plan.report.primitive = source.places[0].primitive;
  plan.report.name = AsString(Find(*FindElement(document.json, "meshes", source.places[0].mesh), "name"));
  plan.report.reason = source.reason;
  plan.report.bytes_before = source.stored_bytes;
  return plan;
}

}  // namespace

StatusOr<std::vector<PrimitivePlan>> PlanPrimitives(const GltfDocument& document, const PackOptions& options) {
  LACERTA_ASSIGN_OR_RETURN(Context context, MakeContext(document, options));
  std::vector<PrimitivePlan> plans;
  std::vector<bool> progressive;
  uint64_t all_vertices = 0;
  for (size_t i = 0; i < context.sources.size(); ++i) {
    const Source& source = context.sources[i];
    PrimitivePlan plan = StartPlan(document, source);
    if (source.primitive.has_value()) {
      plan.report.reason = ReasonAgainstProgressive(context, i, &plan.smooth_normals);
    }
    progressive.push_back(source.primitive.has_value() && plan.report.reason.empty());
    if (progressive.back()) all_vertices += source.primitive->num_vertices;
    plans.push_back(std::move(plan));
  }
  const bool refine_always = options.encode.levels == LevelChoice::kAlways;
  for (size_t i = 0; i < plans.size(); ++i) {
    PrimitivePlan& plan = plans[i];
    const Source& source = context.sources[i];
    if (progressive[i]) {
      const Status status = PlanProgressive(source, OptionsOf(context, i, all_vertices), &plan);
      if (!status.ok()) return status.WithContext(PlaceName(document, plan.places[0]));
    }
    const bool settled =
        plan.progressive.has_value() &&
        (refine_always || IsRate(options.encode.target) || options.fallback == Fallback::kPlain);
    if (source.primitive.has_value() && !settled) {
      if (options.fallback == Fallback::kPlain) {
        AddReason("left as it is so that every reader opens the asset", &plan.report);
      } else {
        PlanDraco(i, &context, &plan);
      }
    }
    if (plan.report.storage == PrimitiveStorage::kUntouched) plan.report.bytes_after = plan.report.bytes_before;
  }
  return plans;
}

}  // namespace lacerta
