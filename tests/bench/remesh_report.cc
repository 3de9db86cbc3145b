// Remeshes mesh files and prints what came of each as one line of JSON: remesh_report [--levels N] [--out FOLDER] FILE...
//
// Levels: 4 and 3, whichever comes closer to the input; 2 or 1 where no base is small enough for those, or too much of the remesh is
// reversed. The base is as large as it may be for a remesh of at most twice the vertices of the refined components. --levels: that
// number alone. --out: where to write the finest levels, as NAME.ply. Peak memory is that of the process once the first remesh stands, before anything is
// measured, so only that of the first file means anything.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "lacerta/clean.h"
#include "lacerta/decoder.h"
#include "lacerta/mesh_file.h"
#include "lacerta/remesh.h"
#include "lacerta/surface_distance.h"
#include "remesh/base_domain.h"
#include "remesh/decimate.h"
#include "remesh/input_surface.h"
#include "remesh/piercing.h"
#include "remesh/reversal.h"
#include "remesh/surface_fit.h"
#include "remesh/surface_parts.h"
#include "remesh_measures.h"

namespace lacerta {
namespace {

struct Options {
  int levels = 0;  // 0: to be chosen
  std::string out;
};

double Now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double PeakBytes() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

// What is prepared once per file.
struct Input {
  explicit Input(const TriangleMesh& cleaned)
      : started(Now()),
        parts(SplitSurface(cleaned)),
        split(Now()),
        history(Decimate(parts.refined, parts.topology, DecimateOptions())),
        decimated(Now()),
        surface(parts.refined, parts.topology),
        prepared(Now()) {}

  double started;
  SurfaceParts parts;
  double split;
  CollapseHistory history;
  double decimated;
  InputSurface surface;
  double prepared;
};

// A remesh with a certain number of levels.
struct Attempt {
  std::vector<uint32_t> input_vertex;  // of the base vertices
  NormalMesh pierced, fitted;
  double pierce_seconds = 0, fit_seconds = 0;
  double psnr = 0;
  double reversed = 0;  // share of the area, as the remesher finds it
};

double FinestVertices(const BaseDomain& domain, int levels) {
  const Topology& t = domain.topology();
  return static_cast<double>(SubdividedCounts({t.num_vertices, t.num_edges(), t.num_faces()}, levels).vertices);
}

// The domain with the largest base of which `levels` levels have at most `limit` vertices, or the coarsest if none has; without some
// collapses.
BaseDomain ChooseDomain(const Input& input, int levels, double limit, const std::vector<uint32_t>& held) {
  const auto num_vertices = static_cast<double>(input.parts.refined.positions.size());
  double base = limit / std::pow(4.0, levels);
  for (;;) {
    const auto time = static_cast<uint32_t>(std::min<double>(input.history.num_collapses(), std::max(0.0, num_vertices - std::floor(base))));
    BaseDomain domain(input.history, input.history.CutWithout(held, time));
    const double reached = FinestVertices(domain, levels);
    if (reached <= limit || time == input.history.num_collapses()) return domain;
    base = std::min(base * limit / reached, std::min<double>(base, domain.num_vertices()) - 1);
  }
}

// For each base vertex the first one that is a copy of the same vertex, as the encoder joins them.
std::vector<uint32_t> JoinedVertices(const BaseDomain& domain, const std::vector<uint32_t>& source_vertex) {
  std::vector<uint32_t> joined(domain.num_vertices());
  std::unordered_map<uint32_t, uint32_t> first;
  for (uint32_t v = 0; v < joined.size(); ++v) joined[v] = first.emplace(source_vertex[domain.input_vertex(v)], v).first->second;
  return joined;
}

Attempt Remesh(const Input& input, BaseDomain domain, int levels) {
  Attempt attempt;
  domain.Join(JoinedVertices(domain, input.parts.source_vertex));
  for (uint32_t v = 0; v < domain.num_vertices(); ++v) attempt.input_vertex.push_back(domain.input_vertex(v));
  PiercingOptions options;
  options.num_levels = levels;
  const double start = Now();
  attempt.pierced = Pierce(input.surface, domain, domain.PositionsOn(input.parts.refined), options);
  attempt.pierce_seconds = Now() - start;
  attempt.fitted = attempt.pierced;
  const double pierced = Now();
  FitToInput(input.surface, SurfaceFitOptions(), &attempt.fitted);
  attempt.fit_seconds = Now() - pierced;
  return attempt;
}

TriangleMesh Finest(const NormalMesh& mesh) { return MeshAtLevel(mesh.mesh, mesh.mesh.num_levels).value(); }

SurfaceDistance DistanceOf(const SurfaceDistanceMeter& meter, const NormalMesh& mesh) {
  return meter.Measure(Finest(mesh), SurfaceDistanceOptions::RmsOnly()).value();
}

// Components that do not have the topology of the input's, summed over the levels; each level that is no manifold counts as one.
uint64_t NumChanged(const Input& input, const Attempt& attempt) {
  const Components components = FindComponents(input.parts.topology);
  uint64_t changed = 0;
  for (int level = 0; level <= attempt.fitted.mesh.num_levels; ++level) {
    const TriangleMesh mesh = MeshAtLevel(attempt.fitted.mesh, level).value();
    const StatusOr<Topology> topology = BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles);
    changed += topology.ok() ? NumChangedComponents(components, topology.value(), attempt.input_vertex) : 1;
  }
  return changed;
}

// Remeshes, again with a finer base where too much comes out reversed, as often as that helps; the remesh with the least of it. None
// where no base is small enough, unless `anyhow`.
std::optional<Attempt> RemeshWithin(const Input& input, int levels, double limit, bool anyhow) {
  std::optional<Attempt> best;
  std::vector<uint32_t> held;
  for (int round = 0; round < kReversalRounds; ++round) {
    const BaseDomain domain = ChooseDomain(input, levels, limit, held);
    if (FinestVertices(domain, levels) > limit && !(anyhow && round == 0)) break;
    Attempt attempt = Remesh(input, domain, levels);
    const double started = Now();
    const ReversedPart part = FindReversed(input.surface, attempt.fitted);
    attempt.fit_seconds += Now() - started;
    attempt.reversed = part.share;
    if (best) {
      attempt.pierce_seconds += best->pierce_seconds;
      attempt.fit_seconds += best->fit_seconds;
    }
    if (best && best->reversed < attempt.reversed) {
      best->pierce_seconds = attempt.pierce_seconds;
      best->fit_seconds = attempt.fit_seconds;
    } else {
      best = std::move(attempt);
    }
    if (!HoldReversed(part, domain, &held)) break;
  }
  return best;
}

// Less reversed area where one has too much of it, else closer to the input.
bool IsBetter(const Attempt& a, const Attempt& b) {
  const bool a_is_sound = a.reversed <= kMostReversed, b_is_sound = b.reversed <= kMostReversed;
  if (a_is_sound != b_is_sound) return a_is_sound;
  return a_is_sound ? a.psnr > b.psnr : a.reversed < b.reversed;
}

uint64_t NumNotFinite(const std::vector<Vec3f>& positions) {
  return static_cast<uint64_t>(std::count_if(positions.begin(), positions.end(), [](const Vec3f& p) {
    return !std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z);
  }));
}

// One member of a JSON object; numbers that JSON does not have are null.
void Print(const char* name, double value, const char* format) {
  std::printf(", \"%s\": ", name);
  std::printf(std::isfinite(value) ? format : "null", value);
}
void Print(const char* name, uint64_t value) { std::printf(", \"%s\": %llu", name, static_cast<unsigned long long>(value)); }

void PrintCurve(const char* name, const SurfaceDistance& d, double diagonal) {
  Print((std::string(name) + "_rms").c_str(), d.Rms() / diagonal, "%.3g");
  Print((std::string(name) + "_max").c_str(), d.Hausdorff() / diagonal, "%.3g");
}

void PrintInput(const TriangleMesh& cleaned, const Input& input) {
  const Topology& t = input.parts.topology;
  uint64_t creases = 0;
  for (uint32_t e = 0; e < t.num_edges(); ++e) creases += t.on_curve[e] && !t.is_border(e);
  Print("triangles", cleaned.triangles.size());
  Print("vertices", cleaned.positions.size());
  Print("refined_components", input.parts.refined_components);
  Print("still_components", input.parts.still_components);
  Print("refined_triangles", input.parts.refined.triangles.size());
  Print("refined_vertices", input.parts.refined.positions.size());
  Print("flipped", input.parts.report.flipped_triangles);
  Print("cut_edges", input.parts.report.cut_edges);
  Print("split_vertices", input.parts.report.split_vertices);
  Print("borders", input.parts.report.borders);
  Print("crease_edges", creases);
}

// The normals of a remesh, zero at the vertices of creases, where the input has several.
std::vector<Vec3f> NormalsOffCreases(std::vector<Vec3f> normals, const Topology& topology) {
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    if (!topology.on_curve[e] || topology.is_border(e)) continue;
    for (const uint32_t v : topology.edges[e]) normals[v] = {};
  }
  return normals;
}

void PrintRemesh(const Input& input, const Attempt& best, const SurfaceDistanceMeter& meter) {
  const NormalMesh& fitted = best.fitted;
  const TriangleMesh finest = Finest(fitted);
  Topology topology = BuildTopology(fitted.mesh.num_base_vertices, fitted.mesh.base_triangles, fitted.mesh.tags).value();
  for (int level = 0; level < fitted.mesh.num_levels; ++level) topology = Refine(topology);
  const SurfaceDistance distance = DistanceOf(meter, fitted);
  const std::vector<Vec3f> normals = NormalsOffCreases(fitted.surface_normals, topology);
  const ReversedShare reversed = MeasureReversed(input.surface, finest, normals);
  const double diagonal = meter.diagonal();
  Print("base_vertices", uint64_t{fitted.mesh.num_base_vertices});
  Print("levels", static_cast<uint64_t>(fitted.mesh.num_levels));
  Print("remesh_vertices", finest.positions.size());
  Print("normal_share", NormalShare(fitted), "%.5f");
  Print("psnr_pierced", Psnr(DistanceOf(meter, best.pierced).Rms(), diagonal), "%.2f");
  Print("psnr", best.psnr, "%.2f");
  Print("psnr_forward", Psnr(distance.forward.rms, diagonal), "%.2f");
  Print("psnr_backward", Psnr(distance.backward.rms, diagonal), "%.2f");
  Print("reversed", reversed.confirmed, "%.3g");
  Print("reversed_at_closest", reversed.at_closest, "%.3g");
  Print("reversed_pierced", MeasureReversed(input.surface, Finest(best.pierced), normals).confirmed, "%.3g");
  Print("not_finite", NumNotFinite(finest.positions));
  Print("topology_changes", NumChanged(input, best));
  PrintCurve("border", CurveDistance(input.parts.refined, input.parts.topology, finest, topology, Curve::kBorder), diagonal);
  PrintCurve("crease", CurveDistance(input.parts.refined, input.parts.topology, finest, topology, Curve::kCrease), diagonal);
}

Status Report(const std::string& path, const Options& options) {
  LACERTA_ASSIGN_OR_RETURN(const TriangleMesh mesh, ReadMeshFile(path));
  LACERTA_ASSIGN_OR_RETURN(const CleanedMesh cleaned, Clean(mesh));
  const Input input(cleaned.mesh);
  const std::string name = std::filesystem::path(path).stem().string();
  std::printf("{\"mesh\": \"%s\"", name.c_str());
  PrintInput(cleaned.mesh, input);
  std::optional<Attempt> best;
  if (!input.parts.refined.triangles.empty()) {
    const double limit = 2.0 * static_cast<double>(input.parts.refined.positions.size());
    std::optional<SurfaceDistanceMeter> meter;
    for (int levels = options.levels ? options.levels : 4; levels > 0 && !(best && levels < 3 && best->reversed <= kMostReversed); --levels) {
      std::optional<Attempt> made = RemeshWithin(input, levels, limit, options.levels || levels == 1);
      if (!made) continue;
      Attempt attempt = std::move(*made);
      if (!best) {
        Print("bytes_per_triangle", PeakBytes() / static_cast<double>(cleaned.mesh.triangles.size()), "%.0f");
        LACERTA_ASSIGN_OR_RETURN(meter, SurfaceDistanceMeter::Create(input.parts.refined));
      }
      attempt.psnr = Psnr(DistanceOf(*meter, attempt.fitted).Rms(), meter->diagonal());
      if (!best || IsBetter(attempt, *best)) best = std::move(attempt);
      if (options.levels) break;
    }
    PrintRemesh(input, *best, *meter);
    if (!options.out.empty()) LACERTA_RETURN_IF_ERROR(WriteMeshFile(Finest(best->fitted), options.out + "/" + name + ".ply"));
  }
  Print("split_s", input.split - input.started, "%.2f");
  Print("decimate_s", input.decimated - input.split, "%.2f");
  Print("prepare_s", input.prepared - input.decimated, "%.2f");
  Print("pierce_s", best ? best->pierce_seconds : 0, "%.2f");
  Print("fit_s", best ? best->fit_seconds : 0, "%.2f");
  std::printf("}\n");
  std::fflush(stdout);
  return Status();
}

}  // namespace
}  // namespace lacerta

int main(int argc, char** argv) {
  lacerta::Options options;
  int failures = 0;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--levels" && i + 1 < argc) {
      options.levels = std::atoi(argv[++i]);
    } else if (word == "--out" && i + 1 < argc) {
      options.out = argv[++i];
    } else if (const lacerta::Status status = lacerta::Report(word, options); !status.ok()) {
      std::fprintf(stderr, "%s: %s\n", word.c_str(), status.message().c_str());
      ++failures;
    }
  }
  return failures > 0;
}
