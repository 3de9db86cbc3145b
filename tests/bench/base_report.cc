// Codes base meshes of mesh files in compact form and as stock Draco streams, and prints the bytes of both as one line of JSON each:
// base_report FILE...
//
// Bases are what the collapses of the encoder leave of the refined components at 200, 600, 2000 and 5000 vertices, on lattices of 8 to
// 12 bits along the longest side. Bytes of Draco's connectivity are those of the same mesh with all vertices at one point, coded in the
// same way; its positions are the rest.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

#include "bench/must.h"
#include "lacerta/decoder.h"
#include "draco/base_mesh_codec.h"
#include "encoder/compact_base_encoder.h"
#include "encoder/quantizer.h"
#include "geometry/bounding_box.h"
#include "lacerta/clean.h"
#include "lacerta/mesh_file.h"
#include "remesh/base_domain.h"
#include "remesh/decimate.h"
#include "remesh/surface_parts.h"

namespace lacerta {
namespace {

void Report(const std::string& name, const TriangleMesh& mesh, int bits) {
  const auto [low, high] = BoundsOf(mesh.positions);
  const Vec3f size = high - low;
  const BaseMesh base = RoundToLattice(mesh, std::ldexp(std::max({size.x, size.y, size.z}), -bits));
  const CompactBaseBytes compact = Must(EncodeCompactBaseSmallest(base), name);
  const CompactBase decoded = Must(DecodeCompactBase(compact.bytes, {}), name);
  if (decoded.mesh.lattice != compact.mesh.lattice || decoded.mesh.triangles != compact.mesh.triangles) {
    std::fprintf(stderr, "%s: decoded base differs\n", name.c_str());
    std::exit(1);
  }
  const CodedBase draco = Must(EncodeBaseMesh(base), name);
  BaseMesh flat = draco.mesh;
  for (auto& p : flat.lattice) p = {0, 0, 0};
  const size_t draco_connectivity = Must(RecodeBaseMesh(draco, flat), name).size();
  std::printf("{\"mesh\": \"%s\", \"vertices\": %zu, \"triangles\": %zu, \"bits\": %d, \"bytes\": %zu, \"connectivity\": %zu, \"draco_bytes\": %zu, "
              "\"draco_connectivity\": %zu}\n",
              name.c_str(), base.lattice.size(), base.triangles.size(), bits, compact.bytes.size(), compact.connectivity_bytes,
              draco.stream.size(), draco_connectivity);
}

void ReportFile(const std::string& path) {
  const std::string name = std::filesystem::path(path).stem().string();
  const TriangleMesh cleaned = Must(Clean(Must(ReadMeshFile(path), path)), path).mesh;
  const SurfaceParts parts = SplitSurface(cleaned);
  const CollapseHistory history = Decimate(parts.refined, parts.topology, DecimateOptions());
  const auto num_vertices = static_cast<uint32_t>(parts.refined.positions.size());
  for (const uint32_t wanted : {200u, 600u, 2000u, 5000u}) {
    if (wanted > num_vertices || wanted < num_vertices - history.num_collapses()) continue;
    const BaseDomain domain(history, num_vertices - wanted);
    for (const int bits : {8, 9, 10, 11, 12}) Report(name, {domain.PositionsOn(parts.refined), domain.triangles()}, bits);
  }
}

}  // namespace
}  // namespace lacerta

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: base_report FILE...\n");
    return 2;
  }
  for (int i = 1; i < argc; ++i) lacerta::ReportFile(argv[i]);
  return 0;
}
