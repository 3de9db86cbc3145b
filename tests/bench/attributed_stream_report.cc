// Remeshes the surfaces of glTF files with their attributes, codes them and prints what the streams weigh and how far they are off, as
// one line of JSON for each mesh: attributed_stream_report [--base VERTICES] [--levels N] [--psnr DB] [--texels T] [--degrees D] FILE...
// --psnr: of the positions. Texels are those of a texture of 1024. --levels 0: as many as bring the finest level to the input's size.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "bench/gltf_surfaces.h"
#include "draco/attributed_stream.h"
#include "draco/candidate_search.h"
#include "draco/decoded_distance.h"
#include "lacerta/surface_distance.h"
#include "remesh/attributed_remesh.h"
#include "remesh/attributed_still.h"
#include "remesh/simplify_to_errors.h"

namespace lacerta {
namespace {

struct Wanted {
  uint32_t base = 0;
  int levels = 0;
  double psnr = 70, texels = 0.5, degrees = 1;
};

constexpr double kTextureSize = 1024;

AttributedStreamOptions OptionsFor(const AttributedNormalMesh& mesh, const Wanted& wanted, double lambda) {
  AttributedStreamOptions options;
  options.lambda = lambda;
  for (const LevelAttribute& a : mesh.attributes) {
    const bool is_direction = IsDirection(a.kind);
    options.errors.push_back(is_direction                                    ? wanted.degrees
                             : a.kind == AttributeKind::kTextureCoordinates ? wanted.texels / kTextureSize
                                                                            : 1.0 / 256);
  }
  return options;
}

Status Report(const NamedSurface& named, const Wanted& wanted) {
  LACERTA_ASSIGN_OR_RETURN(const SurfaceErrorMeter meter, SurfaceErrorMeter::Create(named.mesh));
  LACERTA_ASSIGN_OR_RETURN(AttributedParts parts, SplitAttributedSurface(named.mesh));
  LACERTA_RETURN_IF_ERROR(SimplifyStill(TargetsFor(named.mesh, DistanceOfPsnr(wanted.psnr, meter.diagonal()), wanted.texels, wanted.degrees), kTextureSize, &parts));
  LACERTA_ASSIGN_OR_RETURN(const CollapseHistory history, DecimateAttributed(parts));
  const InputSurface surface(parts.refined.surface, parts.topology);
  AttributedRemeshOptions options;
  options.num_base_vertices = wanted.base;
  options.num_levels = wanted.levels;
  const size_t base_faces = std::max<size_t>(history.FacesAt(history.num_collapses()).size(), 2 * wanted.base);
  for (size_t faces = base_faces; wanted.levels == 0 && faces < parts.refined.surface.triangles.size(); faces *= 4) ++options.num_levels;
  LACERTA_ASSIGN_OR_RETURN(AttributedNormalMesh remesh, RemeshAttributed(parts, surface, history, options));
  AttributedSemiRegularMesh fitted = remesh.Semiregular();
  FitLevelAttributes(GroupSurface(named.mesh), &fitted);
  remesh.attributes = fitted.attributes;

  const double usual = std::log(UsualLambda(wanted.psnr, meter.diagonal()));
  double low = usual - 5, high = usual + 3;
  AttributedStream stream;
  double psnr = 0;
  for (int i = 0; i < 7; ++i) {
    const double middle = (low + high) / 2;
    LACERTA_ASSIGN_OR_RETURN(AttributedStream coded, EncodeAttributedStream(remesh, OptionsFor(remesh, wanted, std::exp(middle))));
    LACERTA_ASSIGN_OR_RETURN(const AttributedMesh decoded, AttributedMeshAtLevel(coded.decoded, options.num_levels));
    LACERTA_ASSIGN_OR_RETURN(const SurfaceErrors errors, meter.Measure(decoded, 50'000));
    const double found = Psnr(errors.distance, meter.diagonal());
    (found >= wanted.psnr ? low : high) = middle;
    if (found < wanted.psnr && psnr >= wanted.psnr) continue;
    stream = std::move(coded);
    psnr = found;
  }
  size_t base_bytes = 0, residual_bytes = 0;
  for (const Bytes& b : stream.bases) base_bytes += b.size();
  for (const size_t b : stream.residual_bytes) residual_bytes += b;
  LACERTA_ASSIGN_OR_RETURN(const AttributedMesh decoded, AttributedMeshAtLevel(stream.decoded, options.num_levels));
  LACERTA_ASSIGN_OR_RETURN(const SurfaceErrors errors, meter.Measure(decoded, 100'000));
  std::printf("{\"mesh\": \"%s\", \"triangles\": %zu, \"base_triangles\": %zu, \"levels\": %d, \"finest\": %zu, \"psnr\": %.2f, \"bytes\": %zu, \"base\": %zu, "
              "\"positions\": %zu, \"turned\": %.5f",
              named.name.c_str(), named.mesh.surface.triangles.size(), remesh.surface.mesh.base_triangles.size(), options.num_levels,
              decoded.surface.triangles.size(), psnr, stream.size(), base_bytes, stream.refinement.size() - residual_bytes, errors.turned);
  for (size_t a = 0; a < remesh.attributes.size(); ++a) {
    std::printf(", \"%s\": {\"bytes\": %zu, \"coded_error\": %.3g, \"rms_99\": %.3g, \"rms\": %.3g}", remesh.attributes[a].name.c_str(), stream.residual_bytes[a],
                stream.errors[a], errors.attributes[a].rms_99, errors.attributes[a].rms);
  }
  std::printf("}\n");
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
  options.add_option("--texels", wanted.texels);
  options.add_option("--degrees", wanted.degrees);
  return lacerta::ReportSurfaces(&options, argc, argv, [&](const auto& surface) { return lacerta::Report(surface, wanted); });
}
