// Simplifies the surfaces of glTF files to errors of positions, texture coordinates and normals, and prints what remains as one line of
// JSON for each mesh: attributed_report [--psnr DB] [--texels N] [--degrees N] [--all-degrees N] [--turned SHARE] FILE...
// --all-degrees bounds normals and tangents over the whole surface, the others bound 99 % of it.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>

#include "bench/gltf_surfaces.h"
#include "remesh/simplify_to_errors.h"

namespace lacerta {
namespace {

struct Targets {
  double psnr = 70, texels = 1, degrees = 2, all_degrees = std::numeric_limits<double>::infinity(), turned = all_degrees;
};

double Seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Vertices as glTF counts them: one for each tuple of position and attribute values.
size_t CountVertices(const AttributedMesh& mesh) {
  uint32_t num_groups = 1;
  for (const uint32_t group : mesh.groups) num_groups = std::max(num_groups, group + 1);
  size_t count = 0;
  for (const VertexSoup& soup : SplitIntoSoups(mesh, num_groups)) count += soup.positions.size();
  return count;
}

Status Report(const NamedSurface& surface, const Targets& wanted) {
  const AttributedMesh& mesh = surface.mesh;
  LACERTA_ASSIGN_OR_RETURN(const SurfaceErrorMeter meter, SurfaceErrorMeter::Create(mesh));
  ErrorTargets targets = TargetsFor(mesh, DistanceOfPsnr(wanted.psnr, meter.diagonal()), wanted.texels, wanted.degrees);
  for (const MeshAttribute& attribute : mesh.attributes) {
    const bool is_direction = IsDirection(attribute.kind);
    targets.everywhere.push_back(is_direction ? wanted.all_degrees : std::numeric_limits<double>::infinity());
  }
  targets.turned = wanted.turned;
  const double start = Seconds();
  LACERTA_ASSIGN_OR_RETURN(const SimplifiedSurface simplified, SimplifyToErrors(mesh, meter, targets));
  const double seconds = Seconds() - start;
  const size_t before = CountVertices(mesh), after = CountVertices(simplified.mesh);
  std::printf("{\"mesh\": \"%s\", \"vertices\": %zu, \"left\": %zu, \"share\": %.3f, \"triangles\": %zu, \"triangles_left\": %zu, \"psnr\": %.2f, \"turned\": %.5f",
              surface.name.c_str(), before, after, static_cast<double>(after) / static_cast<double>(before), mesh.surface.triangles.size(),
              simplified.mesh.surface.triangles.size(), Psnr(simplified.errors.distance, meter.diagonal()), simplified.errors.turned);
  std::string limit = "POSITION";
  double worst = simplified.errors.distance / targets.distance;
  for (size_t a = 0; a < mesh.attributes.size(); ++a) {
    const AttributeError& error = simplified.errors.attributes[a];
    std::printf(", \"%s\": [%.3f, %.3f, %.1f]", mesh.attributes[a].name.c_str(), error.rms_99, error.rms, error.max);
    if (error.rms_99 / targets.attributes[a] <= worst) continue;
    worst = error.rms_99 / targets.attributes[a];
    limit = mesh.attributes[a].name;
  }
  std::printf(", \"limit\": \"%s\", \"seconds\": %.2f}\n", limit.c_str(), seconds);
  return Status();
}

}  // namespace
}  // namespace lacerta

int main(int argc, char** argv) {
  lacerta::Targets targets;
  CLI::App options;
  options.add_option("--psnr", targets.psnr);
  options.add_option("--texels", targets.texels);
  options.add_option("--degrees", targets.degrees);
  options.add_option("--all-degrees", targets.all_degrees);
  options.add_option("--turned", targets.turned);
  return lacerta::ReportSurfaces(&options, argc, argv, [&](const auto& surface) { return lacerta::Report(surface, targets); });
}
