#include "draco/subdivided_input.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "common/subdivision.h"
#include "draco/pierced_base.h"
#include "encoder/quantizer.h"
#include "remesh/input_surface.h"

namespace lacerta {
namespace {

// Whether decoded vertices are nearer to their places than edges are long, by root mean squares.
bool TellsVertices(const std::vector<Vec3f>& decoded, const TriangleMesh& expected) {
  double miss = 0, length = 0;
  for (size_t v = 0; v < decoded.size(); ++v) {
    const double distance = Norm(decoded[v] - expected.positions[v]);
    miss += distance * distance;
  }
  for (const Triangle& t : expected.triangles) {
    for (size_t k = 0; k < 3; ++k) {
      const double edge = Norm(expected.positions[t[(k + 1) % 3]] - expected.positions[t[k]]);
      length += edge * edge;
    }
  }
  return miss / static_cast<double>(decoded.size()) < length / (3.0 * static_cast<double>(expected.triangles.size()));
}

}  // namespace

StatusOr<NormalMeshCandidate> SubdividedCandidate(const TriangleMesh& input, const Unsubdivided& split, BaseCoding coding) {
  TriangleMesh base;
  for (uint32_t v = 0; v < split.num_base_vertices; ++v) base.positions.push_back(input.positions[split.input_vertex[v]]);
  base.triangles = split.base_triangles;
  const auto nominal_step = static_cast<float>(kNominalStep * BoundingBoxDiagonal(input));
  LACERTA_ASSIGN_OR_RETURN(CodedBase coded, EncodeBaseMesh(RoundToLattice(base, nominal_step), coding));

  const Unsubdivided ordered = Reorder(split, coded.vertex_map, coded.mesh.triangles);
  const InputSurface surface(input, BuildTopology(static_cast<uint32_t>(input.positions.size()), input.triangles).value());
  NormalMesh mesh;
  mesh.mesh.base_triangles = ordered.base_triangles;
  mesh.mesh.num_base_vertices = ordered.num_base_vertices;
  mesh.mesh.num_levels = ordered.num_levels;
  for (const uint32_t v : ordered.input_vertex) {
    mesh.mesh.positions.push_back(input.positions[v]);
    mesh.surface_normals.push_back(surface.vertex_normal(v));
  }
  mesh.piercing.assign(mesh.mesh.positions.size() - ordered.num_base_vertices, PiercingKind::kParametric);
  mesh.keeps_vertices = true;
  return NormalMeshCandidate(std::move(coded), std::move(mesh));
}

StatusOr<ChosenStream> CodeSubdivided(const TriangleMesh& input, const Unsubdivided& split, const SurfaceDistanceMeter& meter,
                                      const ResolvedTarget& target, EncodeMode mode, const SearchEffort& effort) {
  LACERTA_ASSIGN_OR_RETURN(const NormalMeshCandidate candidate, SubdividedCandidate(input, split, target.base_coding));
  ChosenStream chosen;
  chosen.remesh_psnr = Psnr(0, meter.diagonal());
  chosen.normal_share = NormalShare(candidate.normal_mesh());
  CandidateSearch search(candidate, chosen.remesh_psnr, meter, target, mode, effort);
  LACERTA_RETURN_IF_ERROR(search.Score().status());  // a good start, at little cost
  LACERTA_ASSIGN_OR_RETURN(chosen.measured, search.Meet());
  if (target.is_rate && !TellsVertices(chosen.measured.stream.decoded.positions, candidate.RemeshedSurface())) {
    return Unsupported("too few bytes to tell the vertices of the subdivided mesh from their neighbors");
  }
  return chosen;
}

}  // namespace lacerta
