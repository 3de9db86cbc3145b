#include "pack/plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "document/normals.h"
#include "lacerta/surface_distance.h"
#include "pack/family.h"
#include "pack/find_skin.h"
#include "pack/influence_slots.h"
#include "pack/morphs.h"
#include "pack/rounded.h"
#include "pack/simplified.h"
#include "pack/simplified_morphs.h"
#include "pack/texel_scale.h"

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
  uint64_t texel_side = 1024;
  std::vector<ScenePose> poses;  // where there are skins
};
constexpr size_t kNone = ~size_t{0};

StatusOr<Context> MakeContext(const GltfDocument& document, const PackOptions& options) {
  Context context;
  context.document = &document;
  context.options = &options;
  context.texel_side = TexelSide(document);
  if (ArraySize(document.json, "skins") > 0) context.poses = ScenePoses(document);
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
    std::vector<Primitive*> primitives;
    for (size_t& member : family.members) {
      member = source_of[member];
      primitives.push_back(&*context.sources[member].primitive);
    }
    ArrangeInfluences(std::move(primitives));
  }
  return context;
}

double ErrorOf(const Context& context, size_t family) {
  return FamilyError(context.families, family, TargetPsnr(context.options->encode.target));
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

// A primitive in Draco form, and what its report is to say then.
struct DracoCandidate {
  DracoEncoded encoded;
  PrimitiveReport report;
  std::vector<MorphTarget> targets;
};

// All members of a family in Draco form: parallel to Family::members.
struct FamilyCandidate {
  std::vector<DracoCandidate> members;
  uint64_t bytes = 0;  // with their JSON
};

uint64_t StoredBytes(const FamilyCandidate& candidate) {
  uint64_t sum = 0;
  for (const DracoCandidate& member : candidate.members) {
    sum += member.encoded.bytes.size() + kDracoJsonBytes + BytesOfTargets(member.targets);
  }
  return sum;
}

double TexelsOf(const Context& context, size_t index, uint64_t set) {
  return TexelsPerUnit(*context.document, context.sources[index].places, set, context.texel_side);
}

std::vector<const Primitive*> PrimitivesOf(const Context& context, size_t family) {
  std::vector<const Primitive*> primitives;
  for (const size_t member : context.families.families[family].members) {
    primitives.push_back(&*context.sources[member].primitive);
  }
  return primitives;
}

bool HasJoints(const Source& source) {
  const std::vector<Attribute>& attributes = source.primitive->attributes;
  return std::any_of(attributes.begin(), attributes.end(), [](const Attribute& a) { return IsSkinAttribute(a.name); });
}

// What moves a family; empty where nothing does.
StatusOr<std::optional<Skin>> SkinOf(const Context& context, size_t family) {
  std::vector<const Source*> sources;
  for (const size_t member : context.families.families[family].members) sources.push_back(&context.sources[member]);
  if (std::none_of(sources.begin(), sources.end(), [](const Source* source) { return HasJoints(*source); })) return std::optional<Skin>();
  LACERTA_ASSIGN_OR_RETURN(Skin skin, FindSkin(*context.document, sources, context.poses));
  return std::optional<Skin>(std::move(skin));
}

TexelScale ScaleOf(const Context& context, size_t family) {
  return [&context, family](size_t member, uint64_t set) {
    return TexelsOf(context, context.families.families[family].members[member], set);
  };
}

// targets: of each member in the order of its decoded vertices; empty: none has any.
FamilyCandidate ToCandidate(RoundedFamily rounded, std::vector<std::vector<MorphTarget>> targets) {
  FamilyCandidate candidate;
  for (size_t m = 0; m < rounded.members.size(); ++m) {
    DracoCandidate member;
    member.encoded = std::move(rounded.members[m]);
    if (!targets.empty()) member.targets = std::move(targets[m]);
    member.report.error = rounded.error;
    member.report.position_bits = rounded.precisions[m].positions.bits;
    member.report.attributes = std::move(rounded.reports[m]);
    candidate.members.push_back(std::move(member));
  }
  candidate.bytes = StoredBytes(candidate);
  return candidate;
}

// Fails with kUnsupported where morph targets cannot follow.
StatusOr<FamilyCandidate> ToCandidate(const Context& context, size_t family, RoundedFamily rounded) {
  std::vector<std::vector<MorphTarget>> targets;
  const std::vector<size_t>& members = context.families.families[family].members;
  for (size_t m = 0; m < members.size(); ++m) {
    const Source& source = context.sources[members[m]];
    targets.emplace_back();
    if (source.targets.empty()) continue;
    auto reordered = ReorderTargets({&*source.primitive, &source.targets}, rounded.precisions[m], rounded.members[m].decoded);
    if (!reordered.has_value()) return Unsupported("has morph targets that tell apart what its other attributes do not");
    targets.back() = std::move(*reordered);
  }
  return ToCandidate(std::move(rounded), std::move(targets));
}

// With all vertices, where that is no hopeless way to stay under `most_bytes`. Sets *everywhere to RoundedFamily's.
StatusOr<FamilyCandidate> WithAllVertices(const Context& context, size_t family, const FamilyMeter& meter, uint64_t most_bytes,
                                          std::vector<double>* everywhere) {
  // Vertices with other morph targets must not become one.
  const auto targets_follow = [&](const RoundedFamily& rounded) { return ToCandidate(context, family, rounded).ok(); };
  LACERTA_ASSIGN_OR_RETURN(RoundedFamily rounded, RoundFamily(meter.primitives(), meter, nullptr, {}, targets_follow, most_bytes));
  *everywhere = std::move(rounded.everywhere);
  return ToCandidate(context, family, std::move(rounded));
}

bool HasTargets(const Context& context, size_t family) {
  const std::vector<size_t>& members = context.families.families[family].members;
  return std::any_of(members.begin(), members.end(), [&](size_t member) { return !context.sources[member].targets.empty(); });
}

StatusOr<FamilyCandidate> Simplified(const Context& context, size_t family, const FamilyMeter& meter,
                                     const std::vector<double>& everywhere) {
  const bool held = context.options->attributes.normals_everywhere;
  const std::vector<double> bounds = held ? everywhere : std::vector<double>();
  FamilyCandidate candidate;
  if (HasTargets(context, family)) {
    std::vector<const std::vector<MorphTarget>*> targets;
    for (const size_t member : context.families.families[family].members) targets.push_back(&context.sources[member].targets);
    LACERTA_ASSIGN_OR_RETURN(MorphedFamily simplified, SimplifyMorphedFamily(meter, targets, context.texel_side, bounds));
    candidate = ToCandidate(std::move(simplified.rounded), std::move(simplified.targets));
  } else {
    LACERTA_ASSIGN_OR_RETURN(RoundedFamily simplified, SimplifyFamily(meter, bounds));
    candidate = ToCandidate(std::move(simplified), {});
  }
  for (size_t m = 0; m < candidate.members.size(); ++m) {
    candidate.members[m].report.reason =
        "simplified from " + std::to_string(meter.primitives()[m]->triangles.size()) + " to " +
        std::to_string(candidate.members[m].encoded.decoded.triangles.size()) + " triangles";
  }
  return candidate;
}

// Whether a stream of the whole family with all attributes is what is stored: it is smaller than `least` bytes, or levels
// are wanted whatever they take. Makes it the plan then.
bool PlanStream(size_t family, const Context& context, const FamilyMeter& meter, uint64_t least,
                std::vector<PrimitivePlan>* plans) {
  const PackOptions& options = *context.options;
  const std::vector<size_t>& members = context.families.families[family].members;
  const LevelChoice levels = options.encode.levels;
  if (levels == LevelChoice::kNever || options.fallback != Fallback::kDraco) return false;
  if (!options.simplify && levels != LevelChoice::kAlways) return false;
  if (HasTargets(context, family)) return false;
  size_t most_bytes = std::numeric_limits<size_t>::max();
  if (levels != LevelChoice::kAlways) {
    const uint64_t json = kDracoJsonBytes * members.size() + kProgressiveJsonBytes;
    if (least <= json) return false;
    most_bytes = least - json;
  }
  StatusOr<FamilyStream> stream = StreamFamily(meter, options.encode.effort, most_bytes);
  if (!stream.ok()) {
    for (const size_t member : members) AddReason("no stream: " + stream.status().message(), &(*plans)[member].report);
    return false;
  }
  const auto shared = std::make_shared<const FamilyStream>(std::move(stream).value());
  for (size_t m = 0; m < members.size(); ++m) {
    PrimitivePlan& plan = (*plans)[members[m]];
    PrimitiveReport& report = plan.report;
    plan.family = shared;
    plan.group = m;
    report.storage = PrimitiveStorage::kProgressive;
    report.reason = "with its attributes in " + std::to_string(shared->part_sizes.size() - 1) + " levels";
    report.attributes = shared->reports[m];
    report.encode = shared->encode;
    report.error = shared->description.errors.back();
    report.target_error = ErrorOf(context, family);
    // The refinement is that of all; the first carries it.
    report.bytes_after = shared->description.base_lengths[m] + (m == 0 ? shared->bytes.size() - shared->part_sizes[0] : 0);
  }
  return true;
}

// The smallest of what there is, Draco with all vertices and Draco of a simplified surface, for a whole family: one that
// stayed as it is would come apart from neighbors that are rounded.
void PlanFamily(size_t family, const Context& context, std::vector<PrimitivePlan>* plans) {
  const std::vector<size_t>& members = context.families.families[family].members;
  const bool is_stream = (*plans)[members[0]].progressive.has_value();
  uint64_t least = 0;
  for (const size_t member : members) least += (*plans)[member].report.bytes_before;
  if (is_stream) least = std::min(least, (*plans)[members[0]].progressive->stream.size() + kDracoJsonBytes + kProgressiveJsonBytes);
  std::vector<double> everywhere;
  const StatusOr<std::optional<Skin>> skin = SkinOf(context, family);
  const FamilyMeter meter(PrimitivesOf(context, family), ErrorOf(context, family), context.options->attributes, context.texel_side,
                          ScaleOf(context, family), skin.ok() && skin.value().has_value() ? &*skin.value() : nullptr);
  const uint64_t most_bytes = is_stream ? least : std::numeric_limits<uint64_t>::max();
  StatusOr<FamilyCandidate> chosen = WithAllVertices(context, family, meter, most_bytes, &everywhere);
  std::string against = chosen.ok() ? "" : chosen.status().message();
  if (chosen.ok() && chosen.value().bytes >= least) {
    against = "compressed it would be larger (" + std::to_string(chosen.value().bytes) + " bytes with their description)";
    chosen = Unsupported(against);
  }
  if (chosen.ok()) least = chosen.value().bytes;
  std::string simplified_reason;
  if (context.options->simplify && !is_stream) {  // streams have tried a simplified surface themselves
    StatusOr<FamilyCandidate> simplified =
        skin.ok() ? Simplified(context, family, meter, everywhere) : StatusOr<FamilyCandidate>(skin.status());
    if (simplified.ok() && simplified.value().bytes < least) {
      chosen = std::move(simplified);
      least = chosen.value().bytes;
    } else {
      simplified_reason = simplified.ok() ? "simplified it would be larger" : "not simplified: " + simplified.status().message();
    }
  }
  if (!is_stream && PlanStream(family, context, meter, least, plans)) return;
  for (size_t m = 0; m < members.size(); ++m) {
    PrimitivePlan& plan = (*plans)[members[m]];
    if (!chosen.ok()) {
      if (!is_stream) AddReason(against, &plan.report);
      continue;
    }
    DracoCandidate& candidate = chosen.value().members[m];
    PrimitiveReport& report = plan.report;
    if (is_stream) {
      report.reason = "all its vertices in Draco are smaller than a stream (" +
                      std::to_string(plan.progressive->stream.size()) + " bytes)";
      report.encode = {};
      plan.progressive.reset();
      plan.smooth_normals = false;
    }
    if (!candidate.report.reason.empty()) AddReason(candidate.report.reason, &report);
    if (!simplified_reason.empty()) AddReason(simplified_reason, &report);
    report.storage = PrimitiveStorage::kDraco;
    report.bytes_after = candidate.encoded.bytes.size() + BytesOfTargets(candidate.targets);
    report.error = candidate.report.error;
    report.target_error = ErrorOf(context, family);
    report.position_bits = candidate.report.position_bits;
    report.attributes = std::move(candidate.report.attributes);
    plan.targets = std::move(candidate.targets);
    plan.draco = std::move(candidate.encoded);
  }
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
  plan.report.bytes_before = source.stored_bytes + BytesOfTargets(source.targets);
  return plan;
}

// A budget means the whole file where more than one stream has to share it; those streams alone meet theirs to 2 %.
bool IsSharedBudget(const GltfDocument& document, const PackOptions& options) {
  if (options.encode.target.kind != EncodeTarget::Kind::kBytes) return false;
  const std::vector<Place> places = AllPlaces(document);
  if (places.size() != 1) return true;
  const Json* attributes = Find(PrimitiveAt(document, places[0]), "attributes");
  return attributes != nullptr && attributes->size() > 1;
}

// Plans for errors.
StatusOr<std::vector<PrimitivePlan>> PlanForErrors(const GltfDocument& document, const PackOptions& options) {
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
  }
  for (size_t f = 0; f < context.families.families.size(); ++f) {
    const std::vector<size_t>& members = context.families.families[f].members;
    const bool is_stream = plans[members[0]].progressive.has_value();
    const bool plain = options.fallback == Fallback::kPlain;
    if (is_stream && (refine_always || IsRate(options.encode.target) || plain)) continue;
    if (!plain) {
      PlanFamily(f, context, &plans);
      continue;
    }
    for (const size_t member : members) {
      AddReason("left as it is so that every reader opens the asset", &plans[member].report);
    }
  }
  for (PrimitivePlan& plan : plans) {
    if (plan.report.storage == PrimitiveStorage::kUntouched) plan.report.bytes_after = plan.report.bytes_before;
  }
  return plans;
}

uint64_t BytesOf(const std::vector<PrimitivePlan>& plans) {
  uint64_t sum = 0;
  for (const PrimitivePlan& plan : plans) sum += plan.report.bytes_after;
  return sum;
}

// What a scene took at a quality.
struct BudgetTrial {
  double psnr = 0.0;       // dB
  double log_bytes = 0.0;  // ln
};

// The quality at which the budget is thought to be met, by what was tried so far (at least once): between the nearest trials that fit it
// and that do not, or, in steps that never shrink, beyond the last one. Bytes jump where a mesh becomes a stream: where two trials on one
// side follow each other, the middle is next.
double NextPsnr(const std::vector<BudgetTrial>& trials, double log_budget) {
  const BudgetTrial *fits = nullptr, *exceeds = nullptr;
  for (const BudgetTrial& trial : trials) (trial.log_bytes <= log_budget ? fits : exceeds) = &trial;
  if (fits != nullptr && exceeds != nullptr) {
    const auto is_over = [&](const BudgetTrial& trial) { return trial.log_bytes > log_budget; };
    const bool creeps = is_over(trials.back()) == is_over(trials[trials.size() - 2]);
    const double share = creeps ? 0.5 : (log_budget - fits->log_bytes) / (exceeds->log_bytes - fits->log_bytes);
    return fits->psnr + (exceeds->psnr - fits->psnr) * std::clamp(share, 0.1, 0.9);
  }
  constexpr double kBeyond = 0.5, kMostStep = 20.0;  // dB
  constexpr double kLeastPsnr = 20.0, kMostPsnr = 130.0;
  const BudgetTrial& last = trials.back();
  double log_bytes_per_decibel = 0.08, least_step = kBeyond;
  if (trials.size() > 1) {
    const BudgetTrial& before = trials[trials.size() - 2];
    log_bytes_per_decibel = std::clamp((last.log_bytes - before.log_bytes) / (last.psnr - before.psnr), 0.01, 0.3);
    least_step = std::fabs(last.psnr - before.psnr);
  }
  const double step = std::fabs(log_budget - last.log_bytes) / log_bytes_per_decibel + kBeyond;
  const double taken = std::min(std::max(step, least_step), kMostStep);
  return std::clamp(last.psnr + (fits != nullptr ? taken : -taken), kLeastPsnr, kMostPsnr);
}

// The scene's error is the same everywhere, in world units, so a byte more lowers it about as much in one mesh as in
// another; the smallest error whose meshes fit into the budget is looked for. Attributes are let go with the positions.
StatusOr<std::vector<PrimitivePlan>> PlanForBytes(const GltfDocument& document, const PackOptions& options) {
  constexpr int kMostTrials = 7;
  constexpr double kGoodEnough = 0.96;  // sizes scatter by some percent between neighboring qualities
  constexpr double kNoChange = 0.2;     // dB
  constexpr double kMostTurned = 0.01;  // share of the area
  constexpr double kAttributesFrom = 70.0;  // dB: above, their own targets hold
  const auto budget = options.encode.target.value;
  double psnr = kAttributesFrom;
  std::vector<BudgetTrial> trials;
  std::optional<std::vector<PrimitivePlan>> best;
  for (int trial = 0; trial < kMostTrials; ++trial) {
    PackOptions at = options;
    at.encode.target = {EncodeTarget::Kind::kPsnr, psnr};
    const double slack = std::max(1.0, std::pow(10.0, (kAttributesFrom - psnr) / 20.0));
    for (double* target : {&at.attributes.uv_texels, &at.attributes.normal_degrees, &at.attributes.color, &at.attributes.custom}) *target *= slack;
    at.attributes.normal_degrees = std::min(at.attributes.normal_degrees, 30.0);
    at.attributes.turned = std::min(at.attributes.turned * slack, kMostTurned);
    LACERTA_ASSIGN_OR_RETURN(std::vector<PrimitivePlan> plans, PlanForErrors(document, at));
    const auto bytes = static_cast<double>(BytesOf(plans));
    const bool fits = bytes <= budget;
    trials.push_back({psnr, std::log(std::max(bytes, 1.0))});
    // Where nothing fits, the smallest is the best there is.
    const double known = best.has_value() ? static_cast<double>(BytesOf(*best)) : 0.0;
    const bool better = !best.has_value() || (fits ? known > budget || bytes > known : bytes < known);
    if (better) best = std::move(plans);
    if (fits && bytes >= kGoodEnough * budget) break;
    const double next = NextPsnr(trials, std::log(budget));
    if (std::fabs(next - psnr) < kNoChange) break;
    psnr = next;
  }
  return std::move(*best);
}

}  // namespace

StatusOr<std::vector<PrimitivePlan>> PlanPrimitives(const GltfDocument& document, const PackOptions& options) {
  return IsSharedBudget(document, options) ? PlanForBytes(document, options) : PlanForErrors(document, options);
}

}  // namespace lacerta
