// Remeshes the surfaces of glTF files with their attributes and prints what the finest level is, before anything is quantized, as one line of
// JSON for each mesh: attributed_levels_report [--base VERTICES] [--levels N] [--psnr DB] [--bare] [--obj PREFIX] FILE...
// --psnr: prints the bytes of the positions at that PSNR, too. --bare: without attributes and groups, to see what their seams cost.
// --levels 0: as many as bring the finest level to the input's number of triangles. --obj: writes both to PREFIX<mesh>.obj, for pictures.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "bench/gltf_surfaces.h"
#include "draco/attributed_candidate.h"
#include "draco/base_mesh_codec.h"
#include "draco/candidate_search.h"
#include "draco/decoded_distance.h"
#include "draco/normal_mesh_candidate.h"
#include "draco/pierced_base.h"
#include "encoder/quantizer.h"
#include "lacerta/surface_distance.h"
#include "remesh/attributed_remesh.h"
#include "remesh/attributed_still.h"
#include "remesh/level_wedges.h"
#include "remesh/simplify_to_errors.h"

namespace lacerta {
namespace {

struct Wanted {
  uint32_t base = 0;
  int levels = 0;
  double psnr = 0;
  bool is_bare = false;
  std::string obj;
};

double Seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// With the first texture coordinates and the first normals, for pictures.
void WriteObj(const AttributedMesh& mesh, const std::string& path) {
  std::ofstream out(path);
  const MeshAttribute *uv = nullptr, *normal = nullptr;
  for (const MeshAttribute& a : mesh.attributes) {
    if (uv == nullptr && a.kind == AttributeKind::kTextureCoordinates) uv = &a;
    if (normal == nullptr && a.kind == AttributeKind::kNormal) normal = &a;
  }
  for (const Vec3f& p : mesh.surface.positions) out << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (size_t i = 0; uv != nullptr && i < uv->values.size(); i += 2) out << "vt " << uv->values[i] << ' ' << 1 - uv->values[i + 1] << '\n';
  for (size_t i = 0; normal != nullptr && i < normal->values.size(); i += 3) {
    out << "vn " << normal->values[i] << ' ' << normal->values[i + 1] << ' ' << normal->values[i + 2] << '\n';
  }
  for (size_t f = 0; f < mesh.surface.triangles.size(); ++f) {
    out << 'f';
    for (size_t k = 0; k < 3; ++k) {
      out << ' ' << mesh.surface.triangles[f][k] + 1 << '/';
      if (uv != nullptr && uv->corners[f][0] != MeshAttribute::kNoValue) out << uv->corners[f][k] + 1;
      if (normal != nullptr && normal->corners[f][0] != MeshAttribute::kNoValue) out << '/' << normal->corners[f][k] + 1;
    }
    out << '\n';
  }
}

// Bytes of the whole stream that meets 1 texel, 2 degrees and a PSNR.
Status ReportStream(const AttributedSurface& input, uint32_t base, int levels, const ErrorTargets& targets) {
  const double start = Seconds();
  LACERTA_ASSIGN_OR_RETURN(const AttributedCandidate candidate, AttributedCandidate::Create(input, base, levels));
  LACERTA_ASSIGN_OR_RETURN(const AttributedTrial trial, candidate.Meet(targets, MeetOptions()));
  size_t base_bytes = 0;
  for (const Bytes& bytes : trial.stream.bases) base_bytes += bytes.size();
  std::printf("  stream of %zu bytes: base %zu", trial.stream.size(), base_bytes);
  for (size_t a = 0; a < candidate.mesh().attributes.size(); ++a) {
    std::printf(", %s %zu (%.2f)", candidate.mesh().attributes[a].name.c_str(), trial.stream.residual_bytes[a], trial.errors.attributes[a].rms_99);
  }
  std::printf("; %.2f dB, turned %.5f, ratio %.3f, %.1f s\n", Psnr(trial.errors.distance, input.meter.diagonal()), trial.errors.turned, trial.ratio,
              Seconds() - start);
  return Status();
}

// Bytes of the positions alone at a PSNR, by bisection.
StatusOr<std::string> PositionBytes(const AttributedMesh& input, const CodedBase& base, const NormalMesh& remesh, double psnr) {
  LACERTA_ASSIGN_OR_RETURN(const SurfaceDistanceMeter meter, SurfaceDistanceMeter::Create(input.surface));
  const NormalMeshCandidate candidate(base, remesh);
  const double usual = std::log(UsualLambda(psnr, meter.diagonal()));
  double low = usual - 5, high = usual + 3;
  std::string best = "out of reach";
  for (int i = 0; i < 9; ++i) {
    const double middle = (low + high) / 2;
    LACERTA_ASSIGN_OR_RETURN(const CodedStream stream, candidate.Code(std::exp(middle), EncodeMode::kDefault));
    const double found = Psnr(DecodedDistance(meter, stream.FinestMesh(), SurfaceDistanceOptions::RmsOnly(50'000)), meter.diagonal());
    (found >= psnr ? low : high) = middle;
    if (found >= psnr) best = "{\"bytes\": " + std::to_string(stream.size()) + ", \"base\": " + std::to_string(stream.base.size()) + "}";
  }
  return best;
}

Status Report(const NamedSurface& named, const Wanted& wanted) {
  const double start = Seconds();
  LACERTA_ASSIGN_OR_RETURN(const SurfaceErrorMeter meter, SurfaceErrorMeter::Create(named.mesh));
  LACERTA_ASSIGN_OR_RETURN(AttributedParts parts, SplitAttributedSurface(named.mesh));
  if (wanted.psnr > 0) {
    constexpr double kTexels = 1, kDegrees = 2, kTextureSize = 1024;
    LACERTA_RETURN_IF_ERROR(SimplifyStill(TargetsFor(named.mesh, DistanceOfPsnr(wanted.psnr, meter.diagonal()), kTexels, kDegrees), kTextureSize, &parts));
  }
  LACERTA_ASSIGN_OR_RETURN(const CollapseHistory history, DecimateAttributed(parts));
  const InputSurface surface(parts.refined.surface, parts.topology);
  AttributedRemeshOptions options;
  options.num_base_vertices = wanted.base;
  const size_t coarsest = history.FacesAt(history.num_collapses()).size();
  const size_t base_faces = std::max<size_t>(coarsest, 2 * wanted.base);
  options.num_levels = wanted.levels;
  if (wanted.levels == 0) {
    for (size_t faces = base_faces; faces < parts.refined.surface.triangles.size(); faces *= 4) ++options.num_levels;
  }
  CodedBase coded;
  if (wanted.psnr > 0) {
    options.order = [&](const TriangleMesh& base) -> StatusOr<BaseOrder> {
      LACERTA_ASSIGN_OR_RETURN(coded, EncodeBaseMesh(RoundToLattice(base, static_cast<float>(kNominalStep * BoundingBoxDiagonal(base)))));
      return BaseOrder{coded.vertex_map, coded.mesh.triangles};
    };
  }
  LACERTA_ASSIGN_OR_RETURN(const AttributedNormalMesh remesh, RemeshAttributed(parts, surface, history, options));
  AttributedSemiRegularMesh mesh = remesh.Semiregular();
  constexpr uint64_t kSamples = 100'000;
  LACERTA_ASSIGN_OR_RETURN(const SurfaceErrors sampled, meter.Measure(FinestLevel(mesh), kSamples));
  const GroupSurface original(named.mesh);
  FitLevelAttributes(original, &mesh);
  const double seconds = Seconds() - start;
  const AttributedMesh finest = FinestLevel(mesh);
  LACERTA_ASSIGN_OR_RETURN(const SurfaceErrors errors, meter.Measure(finest, kSamples));
  std::printf("{\"mesh\": \"%s\", \"triangles\": %zu, \"refined\": %zu, \"base_triangles\": %zu, \"coarsest\": %zu, \"levels\": %d, \"finest\": %zu, "
              "\"normal_share\": %.3f, \"psnr\": %.2f, \"turned\": %.5f",
              named.name.c_str(), named.mesh.surface.triangles.size(), parts.refined.surface.triangles.size(), mesh.surface.base_triangles.size(), coarsest,
              mesh.surface.num_levels, finest.surface.triangles.size(), NormalShare(remesh.surface), Psnr(errors.distance, meter.diagonal()), errors.turned);
  for (size_t a = 0; a < mesh.attributes.size(); ++a) {
    const AttributeError &before = sampled.attributes[a], &error = errors.attributes[a];
    std::printf(", \"%s\": [%.3f, %.3f, %.1f, %.3f]", mesh.attributes[a].name.c_str(), error.rms_99, error.rms, error.max, before.rms_99);
  }
  std::printf(", \"seconds\": %.2f}\n", seconds);
  if (wanted.psnr > 0) {
    LACERTA_ASSIGN_OR_RETURN(const std::string bytes, PositionBytes(named.mesh, coded, remesh.surface, wanted.psnr));
    const ErrorTargets targets = TargetsFor(named.mesh, DistanceOfPsnr(wanted.psnr, meter.diagonal()), 1, 2);
    LACERTA_RETURN_IF_ERROR(ReportStream({original, meter, parts, surface, history}, wanted.base, options.num_levels, targets));
    std::printf("  positions at %.1f dB: %s\n", wanted.psnr, bytes.c_str());
  }
  if (!wanted.obj.empty()) {
    WriteObj(named.mesh, wanted.obj + named.name + ".input.obj");
    WriteObj(finest, wanted.obj + named.name + ".obj");
  }
  return Status();
}

}  // namespace
}  // namespace lacerta

int main(int argc, char** argv) {
  lacerta::Wanted wanted;
  CLI::App options;
  options.add_option("--base", wanted.base);
  options.add_option("--levels", wanted.levels);
  options.add_option("--psnr", wanted.psnr);
  options.add_flag("--bare", wanted.is_bare);
  options.add_option("--obj", wanted.obj);
  return lacerta::ReportSurfaces(&options, argc, argv, [&](lacerta::NamedSurface surface) {
    if (wanted.is_bare) {
      surface.mesh.attributes.clear();
      surface.mesh.groups.clear();
    }
    return lacerta::Report(surface, wanted);
  });
}
