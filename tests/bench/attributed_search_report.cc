// Looks for the smallest progressive stream of the surfaces of glTF files, with their attributes: one line of JSON for
// each mesh: attributed_search_report [--psnr DB] [--texels T] [--degrees D] [--effort 0..2] [--most BYTES] FILE...
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "bench/gltf_surfaces.h"
#include "draco/attributed_search.h"
#include "draco/decoded_distance.h"

namespace lacerta {
namespace {

struct Wanted {
  double psnr = 70, texels = 1, degrees = 2;
  AttributedSearchOptions search;
};

Status Report(const NamedSurface& named, const Wanted& wanted) {
  LACERTA_ASSIGN_OR_RETURN(const SurfaceErrorMeter meter, SurfaceErrorMeter::Create(named.mesh));
  ErrorTargets targets = TargetsFor(named.mesh, DistanceOfPsnr(wanted.psnr, meter.diagonal()), wanted.texels, wanted.degrees);
  targets.turned = 5e-4;
  const auto begin = std::chrono::steady_clock::now();
  LACERTA_ASSIGN_OR_RETURN(const AttributedTrial trial, SmallestAttributedStream(named.mesh, meter, targets, wanted.search));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const AttributedStream& stream = trial.stream;
  size_t base_bytes = 0, residual_bytes = 0;
  for (const Bytes& b : stream.bases) base_bytes += b.size();
  for (const size_t b : stream.residual_bytes) residual_bytes += b;
  std::printf("{\"mesh\": \"%s\", \"triangles\": %zu, \"base_triangles\": %zu, \"levels\": %d, \"seconds\": %.1f, \"bytes\": %zu, \"base\": %zu, \"positions\": %zu, "
              "\"psnr\": %.2f, \"turned\": %.5f",
              named.name.c_str(), named.mesh.surface.triangles.size(), stream.decoded.surface.base_triangles.size(), stream.decoded.surface.num_levels, seconds,
              stream.size(), base_bytes, stream.refinement.size() - residual_bytes, Psnr(trial.errors.distance, meter.diagonal()), trial.errors.turned);
  for (size_t a = 0; a < stream.residual_bytes.size(); ++a) {
    std::printf(", \"%s\": {\"bytes\": %zu, \"rms_99\": %.3g}", stream.decoded.attributes[a].name.c_str(), stream.residual_bytes[a], trial.errors.attributes[a].rms_99);
  }
  std::printf("}\n");
  std::fflush(stdout);
  return Status();
}

}  // namespace
}  // namespace lacerta

int main(int argc, char** argv) {
  lacerta::Wanted wanted;
  CLI::App options;
  options.add_option("--psnr", wanted.psnr);
  options.add_option("--texels", wanted.texels);
  options.add_option("--degrees", wanted.degrees);
  options.add_option("--effort", wanted.search.effort);
  options.add_option("--most", wanted.search.most_bytes);
  return lacerta::ReportSurfaces(&options, argc, argv, [&](const auto& surface) { return lacerta::Report(surface, wanted); });
}
