#include "draco/encode_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "draco/crowded_input.h"
#include "draco/custom_form.h"
#include "draco/decoded_distance.h"
#include "draco/input_proxy.h"
#include "draco/rate_control.h"
#include "draco/search_effort.h"
#include "draco/still_part.h"
#include "draco/subdivided_input.h"
#include "draco/within_memory.h"
#include "draco/zero_level_search.h"
#include "geometry/bounding_box.h"
#include "geometry/for_each_branch.h"
#include "geometry/lean_tree.h"
#include "geometry/triangle_tree.h"
#include "lacerta/clean.h"
#include "lacerta/codec.h"
#include "lacerta/decoder.h"
#include "lacerta/surface_distance.h"
#include "remesh/decimate.h"
#include "remesh/input_surface.h"
#include "remesh/mend_tears.h"
#include "remesh/surface_parts.h"
#include "remesh/unsubdivide.h"

namespace lacerta {
namespace {

constexpr int kMostQualityLayers = 8;

// Measured error of every state that the stream decodes to.
Status ReportLevels(const SurfaceDistanceMeter& meter, const MeasuredStream& coded, const ResolvedTarget& target, EncodeReport* report) {
  const CodedStream& stream = coded.stream;
  LACERTA_ASSIGN_OR_RETURN(ProgressiveDecoder decoder, ProgressiveDecoder::Create(stream.coded.base, {}));
  LACERTA_ASSIGN_OR_RETURN(const RefinementInfo info, ReadRefinementInfo(stream.refinement));
  uint64_t bytes = 0;
  size_t refinement_bytes = 0;
  for (size_t i = 0; i < stream.part_sizes.size(); ++i) {
    const size_t size = stream.part_sizes[i];
    if (i > 0 && info.has_layers) {
      LACERTA_RETURN_IF_ERROR(decoder.Append(Span<const uint8_t>(stream.refinement).Subspan(refinement_bytes).First(size)));
      refinement_bytes += size;
    }
    TriangleMesh mesh{decoder.mesh().positions, decoder.Triangles()};
    if (!info.has_layers) {
      LACERTA_ASSIGN_OR_RETURN(mesh, MeshAtLevel(stream.decoded, static_cast<int>(i)));
    }
    constexpr uint64_t kCoarseSamples = 50'000;  // far from the input, where few tell as much as many
    const bool is_last = i + 1 == stream.part_sizes.size(), is_measured = is_last && !target.is_rate;
    const double distance = is_measured ? DistanceOfPsnr(coded.psnr, meter.diagonal())
                                        : DecodedDistance(meter, mesh, is_last ? SurfaceDistanceOptions::RmsOnly() : SurfaceDistanceOptions::RmsOnly(kCoarseSamples));
    bytes += size;
    report->levels.push_back({mesh.positions.size(), mesh.triangles.size(), bytes, distance, Psnr(distance, meter.diagonal())});
  }
  return Status();
}

// A base section, of either coding, and what follows it.
struct EncodedParts {
  EncodedMesh mesh;
  BaseCoding coding = BaseCoding::kStock;
};

EncodedParts FromZeroLevel(ZeroLevelStream zero, EncodeReport report, std::string reason) {
  report.reason = std::move(reason);
  report.levels = {{zero.mesh.positions.size(), zero.mesh.triangles.size(), zero.stream.size(), zero.distance, zero.psnr}};
  report.measurements = zero.measurements;
  const size_t size = zero.stream.size();
  return {{std::move(zero.stream), {size}, std::move(report)}, zero.coding};
}

StatusOr<EncodedParts> FromRefinement(const SurfaceDistanceMeter& meter, const ChosenStream& chosen, const ResolvedTarget& target, EncodeReport report,
                                      std::string reason) {
  report.progressive = true;
  report.reason = std::move(reason);
  report.normal_share = chosen.normal_share;
  report.remesh_psnr = chosen.remesh_psnr;
  const MeasuredStream& coded = chosen.measured;
  report.measurements = coded.measurements;
  LACERTA_RETURN_IF_ERROR(ReportLevels(meter, coded, target, &report));
  EncodedMesh result;
  result.stream = coded.stream.base;
  result.stream.insert(result.stream.end(), coded.stream.refinement.begin(), coded.stream.refinement.end());
  result.part_sizes = coded.stream.part_sizes;
  result.report = std::move(report);
  return EncodedParts{std::move(result), target.base_coding};
}

// The target of base section and refinement that meets `target` in the form asked for.
ResolvedTarget LessForm(ResolvedTarget target, StreamForm form) {
  if (form == StreamForm::kDraco) return target;
  target.base_coding = BaseCoding::kCompact;
  if (!target.is_rate) return target;
  const Bytes base(static_cast<size_t>(std::min(target.bytes, 1e5)));  // its length is in the custom form
  target.bytes -= static_cast<double>(WriteCustomForm({base, {}}).size() - base.size());
  return target;
}

// Why a simplified mesh was taken.
std::string ReasonForSimpler(const ZeroLevelStream& simpler, const ResolvedTarget& target) {
  if (!simpler.meets_target) return "the target is out of reach; a simplified mesh without levels comes nearest";
  return std::string("a simplified mesh without levels is ") + (target.is_rate ? "closer to the surface" : "smaller");
}

// Why a stream misses the target or leaves more of it than promised; empty where it does neither.
std::string ReasonForMiss(const MeasuredStream& coded, const ResolvedTarget& target) {
  if (!coded.meets_target) return "the target is out of reach; this is the nearest found";
  const auto bytes = static_cast<double>(coded.stream.size());
  if (target.is_rate && bytes < 0.98 * target.bytes) return "no stream found that fills the bytes; this is the nearest";
  if (!target.is_rate && coded.psnr >= target.psnr + 0.3) return "no stream found with less to spare; this is the nearest";
  return "";
}

// What floats do to a mesh far from zero, where a stream that misses a PSNR may owe it to that; else empty.
std::string ReasonInFloats(const TriangleMesh& mesh, const SurfaceDistanceMeter& meter, const ResolvedTarget& target) {
  constexpr double kHeadroom = 6;  // dB: decoded positions are rounded, too, and so is all that leads to them
  const BoundingBox box = BoundsOf(mesh.positions);
  double squared = 0;  // of the error of rounding along an axis, in the mean
  for (int c = 0; c < 3; ++c) {
    const float farthest = std::max(std::fabs(box.low[c]), std::fabs(box.high[c]));
    const double spacing = std::nextafter(farthest, std::numeric_limits<float>::max()) - farthest;
    squared += spacing * spacing / (3 * 12);
  }
  const double psnr = Psnr(std::sqrt(squared), meter.diagonal());
  if (psnr > target.psnr + kHeadroom) return "";
  return "; so far from zero floats hold positions to " + std::to_string(std::lround(psnr)) + " dB: move the mesh nearer to zero";
}

// In the form asked for: the custom form adds a header.
EncodedMesh InForm(StreamForm form, EncodedParts parts) {
  EncodedMesh& mesh = parts.mesh;
  if (form == StreamForm::kDraco) return std::move(mesh);
  const size_t base_size = mesh.part_sizes.front();
  const Span<const uint8_t> stream(mesh.stream);
  Bytes custom = WriteCustomForm({stream.First(base_size), stream.Subspan(base_size), parts.coding});
  const size_t added = custom.size() - mesh.stream.size();
  mesh.stream = std::move(custom);
  mesh.part_sizes.front() += added;
  for (LevelReport& level : mesh.report.levels) level.bytes += added;
  return std::move(mesh);
}

// A mesh on its own connectivity is what it was, vertex for vertex: that is worth some bytes, or dB at a rate.
bool IsWorthItsVertices(const MeasuredStream& own, const MeasuredStream& remeshed, const ResolvedTarget& target) {
  constexpr double kBytes = 1.1, kPsnr = 0.5;
  if (!remeshed.meets_target) return true;
  if (target.is_rate) return own.psnr + kPsnr >= remeshed.psnr;
  return static_cast<double>(own.stream.size()) <= kBytes * static_cast<double>(remeshed.stream.size());
}

bool HasLargeBase(const ChosenStream& chosen, const ResolvedTarget& target, const TriangleMesh& input) {
  const double psnr = TypicalPsnr(target, static_cast<double>(input.positions.size()));
  return static_cast<double>(chosen.measured.stream.coded.base.lattice.size()) > TypicalBase(psnr);
}

// The mesh on its own connectivity where that is subdivided and reaches the target; none else.
std::optional<ChosenStream> EncodeSubdivided(const TriangleMesh& mesh, const SurfaceDistanceMeter& meter,
                                             const ResolvedTarget& target, const EncodeOptions& options) {
  if (mesh.triangles.size() < SurfacePartsOptions().fewest_faces) return std::nullopt;
  const std::optional<Unsubdivided> split = UndoSubdivision(mesh);
  if (!split) return std::nullopt;
  StatusOr<ChosenStream> chosen = CodeSubdivided(mesh, *split, meter, target, options.mode, EffortOf(options.effort));
  if (!chosen.ok() || !chosen.value().measured.meets_target) return std::nullopt;
  return std::move(chosen).value();
}

// The surface as a normal mesh at the target, unless a simplified mesh, which `simpler` then is, outdoes it by far: *is_simpler, and another
// status. simpler: set where levels are to pay. Fills `report`.
StatusOr<ChosenStream> CodeRemeshed(ProxiedInput* input, const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                    const EncodeOptions& options, std::optional<SimplerStream>* simpler, bool* is_simpler, PartsReport* report) {
  const TriangleMesh& mesh = input->Mesh();
  const double psnr = TypicalPsnr(target, static_cast<double>(mesh.positions.size())), distance = DistanceOfPsnr(psnr, meter.diagonal());
  const std::optional<MendedMesh> mended = MendTears(mesh, distance);
  const SurfaceParts parts = SplitSurface(mended ? mended->mesh : mesh);
  if (parts.refined.triangles.empty()) return Unsupported("no component has triangles enough to be worth remeshing");
  if (options.progress) options.progress(0.02, "simplifying");
  const InputSurface surface(parts.refined, parts.topology);
  const SearchEffort effort = EffortOf(options.effort);
  std::optional<CollapseHistory> history;
  ForEachBranch(2, [&](size_t branch) {
    if (branch == 0) history.emplace(Decimate(parts.refined, parts.topology, DecimateOptions()));
    if (branch == 1 && options.levels == LevelChoice::kWhereTheyPay) simpler->emplace(mesh, input->Sequence(), meter, target, effort);
  });
  const StillPart still = PrepareStillPart(parts.still, parts.refined, distance);
  *report = {parts.refined_components,       parts.still_components, still.hidden_components,
             parts.report.flipped_triangles, parts.report.cut_edges, parts.report.split_vertices,
             mended ? mended->closed_tears : 0, mended ? mended->stray_components : 0};
  const RivalStream rival = {[&](double bytes) {
                               const StatusOr<bool> takes_fewer = (*simpler)->TakesFewerThan(bytes);
                               *is_simpler = takes_fewer.ok() && takes_fewer.value();
                               return *is_simpler;
                             },
                             [&](double bytes) { return (*simpler)->MayTakeFewerThan(bytes); },
                             [&](double bytes) { (*simpler)->PrepareBeside(bytes); }};
  const RefinableSurface refinable{surface, *history, still.mesh};
  return CodeAtTarget(refinable, meter, target, options.mode, options.progress, effort, *simpler ? &rival : nullptr);
}

// The surface at the target on its own connectivity, remeshed, or as a simplified mesh without levels, whichever is better. crowding: of
// the mesh (TriangleTree); input: what is remeshed for it.
StatusOr<EncodedParts> EncodeSurface(const TriangleMesh& mesh, ProxiedInput* input, double crowding, const SurfaceDistanceMeter& meter,
                                     const ResolvedTarget& target, const EncodeOptions& options, const MemoryPlan& plan, EncodeReport report) {
  if (options.levels == LevelChoice::kNever) return Unsupported("no refinement levels were asked for");
  if (crowding > kMostCrowding) return Unsupported("too many triangles go through each other for a surface to be followed");
  if (options.progress) options.progress(0.0, "looking at the surface");
  std::optional<ChosenStream> chosen;
  if (plan.may_unsubdivide) chosen = EncodeSubdivided(mesh, meter, target, options);
  report.subdivided_input = chosen.has_value();
  std::optional<SimplerStream> simpler;
  bool is_simpler = false;
  // A base as small as remeshes have is the best there is; a larger one may take more bytes than another surface in all.
  if (!chosen || HasLargeBase(*chosen, target, mesh)) {
    PartsReport parts;
    StatusOr<ChosenStream> remeshed = CodeRemeshed(input, meter, target, options, &simpler, &is_simpler, &parts);
    if (!chosen && !is_simpler && !remeshed.ok()) return remeshed.status();
    const bool is_remeshed = remeshed.ok() && (!chosen || !IsWorthItsVertices(chosen->measured, remeshed.value().measured, target));
    if (is_remeshed) chosen = std::move(remeshed).value();
    if (is_remeshed || !chosen) {
      report.subdivided_input = false;
      report.parts = parts;
    }
  }
  if (options.progress) options.progress(0.95, "comparing with Draco");
  if (simpler && chosen) {
    LACERTA_ASSIGN_OR_RETURN(is_simpler, simpler->IsBetterThan(chosen->measured));
  }
  if (!is_simpler) return FromRefinement(meter, *chosen, target, report, ReasonForMiss(chosen->measured, target));
  report.subdivided_input = false;
  const ZeroLevelStream& stream = simpler->stream();
  return FromZeroLevel(stream, report, ReasonForSimpler(stream, target));
}

// What a target asks for of a mesh, in the form and the layers that the options want.
StatusOr<ResolvedTarget> TargetOf(const EncodeOptions& options, uint64_t num_vertices, double diagonal) {
  LACERTA_ASSIGN_OR_RETURN(const ResolvedTarget asked, ResolveTarget(options.target, num_vertices, diagonal));
  if (options.quality_layers < 1 || options.quality_layers > kMostQualityLayers) {
    return InvalidArgument(std::to_string(options.quality_layers) + " quality layers; 1 to " + std::to_string(kMostQualityLayers) + " are possible");
  }
  ResolvedTarget target = LessForm(asked, options.form);
  target.quality_layers = options.quality_layers;
  return target;
}

// crowding: of the mesh; meter: of the input that it was cleaned from.
StatusOr<EncodedMesh> EncodeCleaned(const TriangleMesh& mesh, const CleanReport& clean, double crowding, const SurfaceDistanceMeter& meter,
                                    const ResolvedTarget& target, const EncodeOptions& options, const MemoryPlan& plan) {
  EncodeReport report;
  report.clean = clean;
  report.input_vertices = mesh.positions.size();
  report.input_triangles = mesh.triangles.size();
  report.diagonal = meter.diagonal();

  ProxiedInput proxied(mesh, meter, target, plan.proxy);
  StatusOr<EncodedParts> encoded = EncodeSurface(mesh, &proxied, crowding, meter, target, options, plan, report);
  if (!encoded.ok()) {  // without refinement, then, with the reason
    if (options.progress) options.progress(0.1, "simplifying");
    LACERTA_ASSIGN_OR_RETURN(ZeroLevelStream zero, crowding > kMostCrowding ? CodeCrowdedInput(mesh, crowding, meter, target)
                                                                            : CodeZeroLevel(proxied.Mesh(), proxied.Sequence(), meter, target, EffortOf(options.effort)));
    const char* const miss = zero.meets_target ? "" : "; the target is out of reach, this is the nearest";
    encoded = FromZeroLevel(std::move(zero), report, encoded.status().message() + miss);
  }
  EncodeReport& made = encoded.value().mesh.report;
  if (!target.is_rate && made.levels.back().psnr < target.psnr) {
    made.reason += ReasonInFloats(mesh, meter, target);
    if (proxied.is_coarse()) made.reason += "; the memory allowed holds the input to " + std::to_string(proxied.Mesh().triangles.size()) + " triangles";
  }
  if (options.progress) options.progress(1.0, "done");
  return InForm(options.form, std::move(encoded).value());
}

StatusOr<EncodedMesh> EncodeUsual(const TriangleMesh& input, const EncodeOptions& options, const MemoryPlan& plan) {
  LACERTA_ASSIGN_OR_RETURN(const CleanedMesh cleaned, Clean(input));
  LACERTA_ASSIGN_OR_RETURN(const ResolvedTarget target, TargetOf(options, cleaned.mesh.positions.size(), BoundingBoxDiagonal(input)));
  const double crowding = TriangleTree(cleaned.mesh).Crowding();  // before the meter: each takes more memory than the mesh
  // Against what came in: a triangle that is there twice counts twice for whoever measures the two files.
  LACERTA_ASSIGN_OR_RETURN(const SurfaceDistanceMeter meter, SurfaceDistanceMeter::Create(input));
  return EncodeCleaned(cleaned.mesh, cleaned.report, crowding, meter, target, options, plan);
}

// As within the memory allowed; where allocations fail all the same, as within less of it.
StatusOr<EncodedMesh> EncodeWithinLess(const TriangleMesh& mesh, const CleanReport& clean, double crowding, const SurfaceDistanceMeter& meter,
                                       const ResolvedTarget& target, const EncodeOptions& options, MemoryPlan plan) {
  const uint64_t num_vertices = mesh.positions.size(), num_triangles = mesh.triangles.size(), least = LeastMemory(num_vertices, num_triangles);
  for (uint64_t memory = options.memory;;) {
    try {
      return EncodeCleaned(mesh, clean, crowding, meter, target, options, plan);
    } catch (const std::bad_alloc&) {
      if (memory <= least) throw;
    }
    memory = std::max(least, memory * 2 / 3);
    LACERTA_ASSIGN_OR_RETURN(plan, PlanMemory(num_vertices, num_triangles, memory));
  }
}

}  // namespace

StatusOr<EncodedMesh> EncodeLean(TriangleMesh mesh, const EncodeOptions& options, const MemoryPlan& plan) {
  const double diagonal = BoundingBoxDiagonal(mesh);
  LACERTA_ASSIGN_OR_RETURN(const CleanReport report, CleanInPlace(&mesh));
  LACERTA_ASSIGN_OR_RETURN(const ResolvedTarget target, TargetOf(options, mesh.positions.size(), diagonal));
  LACERTA_ASSIGN_OR_RETURN(const SurfaceDistanceMeter meter, SurfaceDistanceMeter::CreateLean(mesh));
  const double crowding = LeanTree(mesh).Crowding();
  return EncodeWithinLess(mesh, report, crowding, meter, target, options, plan);
}

namespace {

// mesh: as it may be taken, const or to be used up.
template <typename Mesh>
StatusOr<EncodedMesh> EncodeAsPlanned(Mesh&& mesh, const EncodeOptions& options) {
  LACERTA_ASSIGN_OR_RETURN(const MemoryPlan plan, PlanMemory(mesh.positions.size(), mesh.triangles.size(), options.memory));
  if (!plan.is_lean) {
    try {
      return EncodeUsual(mesh, options, plan);
    } catch (const std::bad_alloc&) {
      if (options.memory == 0) throw;
    }
  }
  return EncodeLean(std::forward<Mesh>(mesh), options, plan);
}

}  // namespace

StatusOr<EncodedMesh> EncodeMesh(const TriangleMesh& mesh, const EncodeOptions& options) {
  return WithinMemory([&] { return EncodeAsPlanned(mesh, options); });
}

StatusOr<EncodedMesh> EncodeMesh(TriangleMesh&& mesh, const EncodeOptions& options) {
  return WithinMemory([&] { return EncodeAsPlanned(std::move(mesh), options); });
}

}  // namespace lacerta
