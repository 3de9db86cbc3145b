#include "pack/family_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "decoder/smooth_normals.h"
#include "document/normals.h"
#include "lacerta/surface_distance.h"
#include "pack/family_candidate.h"
#include "pack/family_stream.h"
#include "pack/morphs.h"

namespace lacerta {
namespace {

bool IsRate(const EncodeTarget& target) {
  return target.kind == EncodeTarget::Kind::kBytes || target.kind == EncodeTarget::Kind::kBitsPerVertex;
}

void AddReason(const std::string& reason, PrimitiveReport* report) {
  if (reason.empty()) return;
  report->reason += (report->reason.empty() ? "" : "; ") + reason;
}

StatusOr<FamilyStream> StreamOf(const FamilyContext& context, const FamilyMeter& meter, size_t most_bytes) {
  const Effort effort = context.options->encode.effort;
  if (!context.HasTargets()) return StreamFamily(meter, effort, most_bytes);
  LACERTA_ASSIGN_OR_RETURN(const MorphChannels morphs,
                           MorphChannels::Create(meter, context.Targets(), context.Mixes(), context.MayRoundTargets(), context.scene->texel_side));
  return StreamFamily(morphs.meter(), effort, most_bytes, &morphs);
}

// Whether a stream of the whole family with all attributes is what is stored: it is smaller than `least` bytes, or levels
// are wanted whatever they take. Makes it the plan then.
bool PlanStream(const FamilyContext& context, const FamilyMeter& meter, uint64_t least, std::vector<PrimitivePlan>* plans) {
  const PackOptions& options = *context.options;
  const LevelChoice levels = options.encode.levels;
  if (levels == LevelChoice::kNever || options.fallback != Fallback::kDraco) return false;
  if (!options.simplify && levels != LevelChoice::kAlways) return false;
  size_t most_bytes = std::numeric_limits<size_t>::max();
  if (levels != LevelChoice::kAlways) {
    const uint64_t json = context.DracoJsonBytes() + context.ProgressiveJsonBytes();
    if (least <= json) return false;
    most_bytes = least - json;
  }
  StatusOr<FamilyStream> stream = StreamOf(context, meter, most_bytes);
  if (!stream.ok()) {
    for (PrimitivePlan& plan : *plans) AddReason("no stream: " + stream.status().message(), &plan.report);
    return false;
  }
  const auto shared = std::make_shared<const FamilyStream>(std::move(stream).value());
  for (size_t m = 0; m < plans->size(); ++m) {
    PrimitivePlan& plan = (*plans)[m];
    PrimitiveReport& report = plan.report;
    plan.family = shared;
    plan.group = m;
    report.storage = PrimitiveStorage::kProgressive;
    report.reason = "with its attributes in " + std::to_string(shared->part_sizes.size() - 1) + " levels";
    report.attributes = shared->reports[m];
    report.encode = shared->encode;
    report.error = shared->description.errors.back();
    report.target_error = context.Error();
    // The refinement is that of all; the first carries it.
    report.bytes_after = shared->description.base_lengths[m] +
                         (m == 0 ? shared->bytes.size() - shared->part_sizes[0] : 0) +
                         BytesOfTargets(shared->groups[m].targets);
  }
  return true;
}

// The plan of a member (an index of sources) of which nothing is known but a reason against a stream.
PrimitivePlan Untouched(const FamilyContext& context, size_t member, const std::string& reason) {
  PrimitivePlan plan = UntouchedPlan(*context.scene, member);
  plan.weight = context.scene->families.families[context.family].weight;
  plan.report.reason = reason;
  return plan;
}

// Small surfaces, or such as many nodes show: the description would take more than is saved.
void LeaveAsItIs(const FamilyContext& context, uint64_t stream_bytes, PrimitivePlan* plan) {
  *plan = Untouched(context, context.members()[0], "compressed it would be larger (" + std::to_string(stream_bytes) + " bytes with its description)");
}

// A family in Draco form, with all vertices or simplified.
struct DracoChoice {
  StatusOr<FamilyCandidate> smallest = Unsupported("");  // not OK: nothing is smaller than what it has to be
  std::string simplified_reason;                         // why it is not simplified
};

// least: bytes that it has to be smaller than. simplifiable: not OK where it is known that no simplified surface is of use.
DracoChoice SmallestDraco(const FamilyContext& context, const FamilyMeter& meter, const Status& simplifiable, bool is_stream, uint64_t least) {
  constexpr uint64_t kAny = std::numeric_limits<uint64_t>::max();
  std::vector<double> everywhere;
  const auto all_vertices = [&](uint64_t most_bytes) -> StatusOr<FamilyCandidate> {
    LACERTA_ASSIGN_OR_RETURN(FamilyCandidate candidate, WithAllVertices(context, meter, most_bytes, &everywhere));
    if (candidate.bytes < least) return candidate;
    return Unsupported("compressed it would be larger (" + std::to_string(candidate.bytes) + " bytes with their description)");
  };
  DracoChoice choice;
  StatusOr<FamilyCandidate>& chosen = choice.smallest;
  const bool simplifies = context.options->simplify && !is_stream;  // streams have tried a simplified surface themselves
  // Beside a simplified surface all vertices mostly show at once, without a measure, that they take far more; a proxy has half the triangles or
  // fewer, and what comes of it fewer still.
  const bool all_first = !simplifies || context.options->attributes.normals_everywhere;
  if (all_first) chosen = all_vertices(is_stream ? least : kAny);
  if (chosen.ok()) least = chosen.value().bytes;
  if (simplifies) {
    StatusOr<FamilyCandidate> simplified = simplifiable.ok() ? Simplified(context, meter, everywhere) : StatusOr<FamilyCandidate>(simplifiable);
    if (simplified.ok() && simplified.value().bytes < least) {
      chosen = std::move(simplified);
      least = chosen.value().bytes;
    } else {
      choice.simplified_reason = simplified.ok() ? "simplified it would be larger" : "not simplified: " + simplified.status().message();
    }
  }
  if (all_first || (chosen.ok() && meter.has_proxy())) return choice;
  StatusOr<FamilyCandidate> all = all_vertices(chosen.ok() ? least : kAny);
  if (all.ok() && chosen.ok()) choice.simplified_reason = "simplified it would be larger";
  if (all.ok() || !chosen.ok()) chosen = std::move(all);
  return choice;
}

// An error is the scene's.
EncodeOptions OptionsOf(const FamilyContext& context) {
  EncodeOptions options = context.options->encode;
  const double diagonal = context.scene->families.families[context.family].diagonal;
  if (options.target.kind == EncodeTarget::Kind::kPsnr) {
    options.target.value = Psnr(context.Error(), diagonal);
  } else if (options.target.kind == EncodeTarget::Kind::kError && diagonal > 0.0) {
    options.target.value = context.Error() / diagonal;
  }
  return options;
}

// A stream of the shape alone, of a family of one primitive; where none comes of it, the report says why. Fails where the options are at fault.
Status PlanProgressive(const FamilyContext& context, PrimitivePlan* plan) {
  const EncodeOptions options = OptionsOf(context);
  StatusOr<EncodedMesh> encoded = EncodeMesh(Surface(*context.Primitives()[0]), options);
  if (encoded.status().code() == StatusCode::kInvalidArgument) return encoded.status().WithContext(PlaceName(*context.scene->document, plan->places[0]));
  if (!encoded.ok()) {
    plan->report.reason = encoded.status().message();
    return Status();
  }
  const EncodedMesh& mesh = encoded.value();
  if (mesh.part_sizes.empty() || mesh.part_sizes.size() != mesh.report.levels.size()) {
    return InternalError("the encoder reported another number of levels than it wrote");
  }
  TakeStream(std::move(encoded).value(), options.target, plan);
  return Status();
}

// Makes a member in Draco form its plan. simplified_reason: why it is not simplified.
void TakeDraco(const FamilyContext& context, DracoCandidate candidate, const std::string& simplified_reason, PrimitivePlan* plan) {
  PrimitiveReport& report = plan->report;
  if (plan->progressive) {
    report.reason = "all its vertices in Draco are smaller than a stream (" + std::to_string(plan->progressive->stream.size()) + " bytes)";
    report.encode = {};
    plan->progressive.reset();
    plan->smooth_normals = false;
  }
  AddReason(candidate.report.reason, &report);
  AddReason(simplified_reason, &report);
  report.storage = PrimitiveStorage::kDraco;
  report.bytes_after = candidate.encoded.bytes.size() + BytesOfTargets(candidate.targets);
  report.error = candidate.report.error;
  report.target_error = context.Error();
  report.position_bits = candidate.report.position_bits;
  report.attributes = std::move(candidate.report.attributes);
  plan->targets = std::move(candidate.targets);
  plan->draco = std::move(candidate.encoded);
}

FamilyMeter MeterOf(const FamilyContext& context, const StatusOr<std::optional<Skin>>& skin) {
  return FamilyMeter(context.Primitives(), context.Error(), context.options->attributes, context.scene->texel_side, context.Scale(),
                     skin.ok() && skin.value().has_value() ? &*skin.value() : nullptr);
}

// What a reader derives from the stream of a surface has to meet the targets of normals, as normals that are stored do, or those targets that many times.
Status CheckDerivedNormals(const FamilyMeter& meter, const EncodedMesh& encoded, double slack = 1.0) {
  const std::optional<size_t> normals = meter.status().ok() ? meter.IndexOf("NORMAL") : std::nullopt;
  if (!normals.has_value()) return Status();
  LACERTA_ASSIGN_OR_RETURN(const DecodedMesh decoded, DecodeMesh(encoded.stream, {}));
  const TriangleMesh& mesh = decoded.mesh;
  const Primitive shown{mesh.positions.size(), mesh.triangles,
                        {{"POSITION", MakeFloatAccessor(mesh.positions)}, {"NORMAL", MakeFloatAccessor(SmoothNormals(mesh.positions, mesh.triangles))}}};
  LACERTA_ASSIGN_OR_RETURN(const SurfaceErrors errors, meter.Measure({&shown}));
  const double degrees = errors.attributes[*normals].rms_99;
  if (degrees > slack * meter.targets().attributes[*normals]) {
    const long tenths = std::lround(10.0 * degrees);
    return Unsupported("normals that readers derive would be " + std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " degrees off");
  }
  if (errors.MostTurned() > slack * meter.targets().turned) return Unsupported("too much of the area would turn away from its normals");
  return Status();
}

// Not OK where a stream of the shape that was hardly searched for tells that normals derived from it are out of question.
Status CheckNormalsOfRoughStream(const FamilyContext& context, const FamilyMeter& meter) {
  constexpr double kSlack = 2;  // scans differ by a twentieth between efforts, surfaces with creases by more
  EncodeOptions options = OptionsOf(context);
  if (options.effort == Effort::kFast) return Status();
  options.effort = Effort::kFast;
  options.progress = nullptr;
  const StatusOr<EncodedMesh> rough = EncodeMesh(Surface(*context.Primitives()[0]), options);
  return rough.ok() ? CheckDerivedNormals(meter, rough.value(), kSlack) : Status();
}

// PlanProgressive, and whether normals that readers derive from the stream are near enough: *normals. Where they are not, the plan holds no stream.
Status PlanShape(const FamilyContext& context, const FamilyMeter& meter, PrimitivePlan* plan, Status* normals) {
  if (plan->smooth_normals) *normals = CheckNormalsOfRoughStream(context, meter);
  if (normals->ok()) {
    LACERTA_RETURN_IF_ERROR(PlanProgressive(context, plan));
    if (plan->smooth_normals && plan->progressive) *normals = CheckDerivedNormals(meter, *plan->progressive);
  }
  if (!normals->ok()) *plan = Untouched(context, context.members()[0], normals->message());
  return Status();
}

// The smallest of what there is, a stream of the shape, Draco with all vertices and Draco of a simplified surface, for a whole family: one that
// stayed as it is would come apart from neighbors that are rounded. may_be_shape: whether the family is of a kind that a shape alone may stand for.
Status PlanTogether(const FamilyContext& context, bool may_be_shape, std::vector<PrimitivePlan>* plans) {
  PrimitivePlan& first = plans->front();
  const bool always_stream = context.options->encode.levels == LevelChoice::kAlways;
  const StatusOr<std::optional<Skin>> skin = context.FindSkin();
  FamilyMeter meter = MeterOf(context, skin);
  Status normals;
  if (may_be_shape) LACERTA_RETURN_IF_ERROR(PlanShape(context, meter, &first, &normals));
  const bool is_stream = first.progressive.has_value();
  if (is_stream && always_stream) return Status();
  uint64_t least = context.BytesBefore();
  if (is_stream) {
    const bool is_described = !IsAllInDraco(*first.progressive, first.smooth_normals, *context.options);
    const uint64_t bytes = first.progressive->stream.size() + context.DracoJsonBytes() + (is_described ? context.ProgressiveJsonBytes() : 0);
    if (bytes >= least) {
      LeaveAsItIs(context, bytes, &first);
      return Status();
    }
    least = bytes;
  }
  const bool has_use_for_proxy = context.options->simplify && !is_stream && !context.HasTargets();
  const Status coarser = has_use_for_proxy ? meter.UseProxy() : Status();
  DracoChoice choice = SmallestDraco(context, meter, skin.ok() ? coarser : skin.status(), is_stream, least);
  StatusOr<FamilyCandidate>& chosen = choice.smallest;
  if (chosen.ok()) least = chosen.value().bytes;
  const bool may_stream = coarser.ok() || always_stream;
  if (!is_stream && may_stream && PlanStream(context, meter, least, plans)) return Status();
  if (always_stream && !normals.ok()) {  // levels without normals, rather than none
    const std::string reason = first.report.reason;
    LACERTA_RETURN_IF_ERROR(PlanProgressive(context, &first));
    first.smooth_normals = first.progressive.has_value();
    AddReason(reason, &first.report);
    if (first.smooth_normals) return Status();
  }
  for (size_t m = 0; m < plans->size(); ++m) {
    if (chosen.ok()) {
      TakeDraco(context, std::move(chosen.value().members[m]), choice.simplified_reason, &(*plans)[m]);
    } else if (!is_stream) {
      AddReason(chosen.status().message(), &(*plans)[m].report);
    }
  }
  return Status();
}

}  // namespace

PrimitivePlan UntouchedPlan(const PackedScene& scene, size_t index) {
  const Source& source = scene.sources[index];
  PrimitivePlan plan;
  plan.places = source.places;
  plan.geometries = source.geometries;
  plan.report.mesh = source.places[0].mesh;
  plan.report.primitive = source.places[0].primitive;
  plan.report.name = AsString(Find(*FindElement(scene.document->json, "meshes", source.places[0].mesh), "name"));
  plan.report.reason = source.reason;
  plan.report.bytes_before = plan.report.bytes_after = source.geometries.size() * source.stored_bytes;
  return plan;
}

std::string ReasonAgainstProgressive(const FamilyContext& context, size_t index, bool* smooth) {
  const Source& source = context.scene->sources[index];
  for (const Place& place : source.places) {
    const uint64_t count = ArraySize(*FindElement(context.scene->document->json, "meshes", place.mesh), "primitives");
    if (count > 1) return "its mesh has " + std::to_string(count) + " primitives, which would not stay joined";
  }
  if (context.members().size() > 1) {
    return "it touches another mesh, from which it would come apart";
  }
  if (!source.targets.empty()) return "has morph targets";
  for (const Attribute& attribute : source.primitive->attributes) {
    if (attribute.name != "POSITION" && attribute.name != "NORMAL") return "has the attribute " + attribute.name;
  }
  const Attribute* normal = source.primitive->Find("NORMAL");
  if (normal == nullptr) return "";
  if (normal->data.components != 3) return "its normals are not of type VEC3";
  *smooth = NormalsAreDerivable(Surface(*source.primitive), VectorsOf(normal->data));
  return *smooth ? "" : "its normals hold creases that the surface alone does not tell";
}

StatusOr<std::vector<PrimitivePlan>> PlanFamily(const FamilyContext& context) {
  const PackOptions& options = *context.options;
  std::vector<PrimitivePlan> plans;
  for (const size_t member : context.members()) {
    PrimitivePlan plan = Untouched(context, member, "");
    plan.report.reason = ReasonAgainstProgressive(context, member, &plan.smooth_normals);
    plans.push_back(std::move(plan));
  }
  PrimitivePlan& first = plans[0];
  const bool may_be_shape = first.report.reason.empty(), plain = options.fallback == Fallback::kPlain;
  const bool is_wanted = options.encode.levels == LevelChoice::kAlways && !first.smooth_normals;
  const bool has_no_rival = plain || is_wanted || IsRate(options.encode.target);
  if (may_be_shape && has_no_rival) {
    LACERTA_RETURN_IF_ERROR(PlanProgressive(context, &first));
    if (first.progressive && first.smooth_normals) {  // taken as it is, but not in silence
      AddReason(CheckDerivedNormals(MeterOf(context, std::optional<Skin>()), *first.progressive).message(), &first.report);
    }
    if (first.progressive) return plans;
  }
  if (!plain) {
    LACERTA_RETURN_IF_ERROR(PlanTogether(context, may_be_shape && !has_no_rival, &plans));
    return plans;
  }
  for (PrimitivePlan& plan : plans) AddReason("left as it is so that every reader opens the asset", &plan.report);
  return plans;
}

}  // namespace lacerta
