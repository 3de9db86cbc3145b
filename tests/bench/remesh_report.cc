// Remeshes mesh files and prints what came of it, one line of JSON each: remesh_report FILE...
// The remesh has at most twice the vertices of the input. tests/bench/remesh_table.py makes a table of it.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "lacerta/clean.h"
#include "lacerta/decoder.h"
#include "lacerta/mesh_file.h"
#include "lacerta/remesh.h"
#include "lacerta/surface_distance.h"
#include "remesh/base_domain.h"
#include "remesh/decimate.h"
#include "remesh/input_surface.h"
#include "remesh/piercing.h"
#include "remesh/surface_fit.h"

namespace lacerta {
namespace {

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Share of the area of triangles whose normal is reversed against the input's at their vertices.
double FlippedShare(const TriangleMesh& mesh, const std::vector<Vec3f>& normals) {
  double flipped = 0, total = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3f cross = Cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
    const double area = Norm(cross);
    total += area;
    if (Dot(cross, normals[t[0]] + normals[t[1]] + normals[t[2]]) < 0) flipped += area;
  }
  return flipped / total;
}

}  // namespace
}  // namespace lacerta

int main(int argc, char** argv) {
  using namespace lacerta;
  for (int i = 1; i < argc; ++i) {
    const TriangleMesh input = Clean(ReadMeshFile(argv[i]).value()).value().mesh;
    const StatusOr<Topology> topology = BuildTopology(static_cast<uint32_t>(input.positions.size()), input.triangles);
    if (!topology.ok()) {
      std::printf("%s: %s\n", argv[i], topology.status().message().c_str());
      continue;
    }
    const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(input).value();
    const double start = Now();
    const CollapseHistory history = Decimate(input, topology.value(), DecimateOptions());
    const double decimated = Now();
    const InputSurface surface(input, topology.value());
    const double prepared = Now();
    const char* levels_text = std::getenv("LEVELS");
    const int levels = levels_text ? std::atoi(levels_text) : 4;
    const auto base = static_cast<uint32_t>(2.0 * static_cast<double>(input.positions.size()) / std::pow(4.0, levels));
    const auto num_vertices = static_cast<uint32_t>(input.positions.size());
    const BaseDomain domain(history, std::min(history.num_collapses(), num_vertices - base));
    std::vector<Vec3f> positions;
    for (uint32_t v = 0; v < domain.num_vertices(); ++v) positions.push_back(input.positions[domain.input_vertex(v)]);
    PiercingOptions options;
    options.num_levels = levels;
    NormalMesh remesh = Pierce(surface, domain, positions, options);
    const double pierced = Now();
    if (std::getenv("FIT")) {
      SurfaceFitOptions fit;
      if (const char* t = std::getenv("STIFF")) fit.stiffness = std::atof(t);
      if (const char* t = std::getenv("SPV")) fit.samples_per_vertex = std::atof(t);
      FitToInput(surface, fit, &remesh);
    }
    const double fitted = Now();
    const TriangleMesh finest = MeshAtLevel(remesh.mesh, levels).value();
    const SurfaceDistance distance = meter.Measure(finest, SurfaceDistanceOptions::RmsOnly()).value();
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    std::printf(
        "{\"file\": \"%s\", \"triangles\": %zu, \"vertices\": %zu, \"base\": %u, \"coarsest\": %u, \"psnr\": %.2f, \"forward\": %.2f, \"backward\": %.2f, \"normal\": %.4f, \"flipped\": %.6f, "
        "\"decimate\": %.2f, \"prepare\": %.2f, \"pierce\": %.2f, \"fit\": %.2f, \"bytes_per_triangle\": %.0f}\n",
        argv[i], input.triangles.size(), finest.positions.size(), domain.num_vertices(), num_vertices - history.num_collapses(), Psnr(distance.Rms(), meter.diagonal()),
        Psnr(distance.forward.rms, meter.diagonal()), Psnr(distance.backward.rms, meter.diagonal()),
        NormalShare(remesh), FlippedShare(finest, remesh.surface_normals), decimated - start, prepared - decimated,
        pierced - prepared, fitted - pierced, 1024.0 * static_cast<double>(usage.ru_maxrss) / static_cast<double>(input.triangles.size()));
    std::fflush(stdout);
    if (const char* out = std::getenv("OUT")) (void)WriteMeshFile(finest, out);
  }
}
