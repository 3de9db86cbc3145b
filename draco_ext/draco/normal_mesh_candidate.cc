#include "draco/normal_mesh_candidate.h"

#include <algorithm>
#include <utility>

#include "common/base_tags.h"
#include "encoder/paper_mode.h"
#include "encoder/quantizer.h"
#include "encoder/step_law.h"
#include "encoder/stream_writer.h"
#include "encoder/vertex_repair.h"
#include "lacerta/surface_distance.h"
#include "remesh/base_domain.h"
#include "remesh/piercing.h"
#include "remesh/surface_fit.h"

namespace lacerta {
namespace {

TriangleMesh BaseOf(const BaseDomain& domain, const TriangleMesh& input) {
  TriangleMesh base;
  for (uint32_t v = 0; v < domain.num_vertices(); ++v) base.positions.push_back(input.positions[domain.input_vertex(v)]);
  base.triangles = domain.triangles();
  return base;
}

}  // namespace

NormalMeshCandidate::NormalMeshCandidate(CodedBase base, NormalMesh normal_mesh)
    : base_(std::move(base)),
      normal_mesh_(std::move(normal_mesh)),
      target_(MakeSurfaceTarget(normal_mesh_)),
      detail_scales_(DetailScales(target_)) {}

StatusOr<NormalMeshCandidate> NormalMeshCandidate::Create(const InputSurface& surface, const CollapseHistory& history,
                                                          uint32_t num_base_vertices, int num_levels) {
  const TriangleMesh& input = surface.mesh();
  const auto num_vertices = static_cast<uint32_t>(input.positions.size());
  const uint32_t time = std::min(history.num_collapses(), num_vertices - std::min(num_vertices, num_base_vertices));
  BaseDomain domain(history, time);
  const auto nominal_step = static_cast<float>(kNominalStep * BoundingBoxDiagonal(input));
  LACERTA_ASSIGN_OR_RETURN(CodedBase base, EncodeBaseMesh(RoundToLattice(BaseOf(domain, input), nominal_step)));
  domain.Reorder(base.vertex_map, base.mesh.triangles);
  PiercingOptions options;
  options.num_levels = num_levels;
  NormalMesh remesh = Pierce(surface, domain, BaseOf(domain, input).positions, options);
  FitToInput(surface, SurfaceFitOptions(), &remesh);
  return NormalMeshCandidate(std::move(base), std::move(remesh));
}

StatusOr<CodedSurface> NormalMeshCandidate::CodeSurface(double lambda, double descent_lambda, EncodeMode mode) const {
  if (mode == EncodeMode::kPaper) return CodeByModel(normal_mesh_.mesh, lambda);
  const std::vector<Vec3f> base(target_.points.begin(), target_.points.begin() + num_base_vertices());
  const BaseMesh lattice =
      RoundToLattice({base, normal_mesh_.mesh.base_triangles}, static_cast<float>(BaseStepForSlope(lambda)));
  DescentOptions options;
  options.lambda = descent_lambda;
  CodedSurface coded = Descend(target_, QuantizeClosedLoop(target_, lattice, StepsForSlope(target_, detail_scales_, lambda)), options);
  if (target_.keeps_vertices) RepairVertices(target_, &coded);
  return coded;
}

StatusOr<CodedStream> NormalMeshCandidate::Code(double lambda, double descent_lambda, EncodeMode mode) const {
  LACERTA_ASSIGN_OR_RETURN(const CodedSurface coded, CodeSurface(lambda, descent_lambda, mode));
  CodedStream stream;
  LACERTA_ASSIGN_OR_RETURN(stream.base, RecodeBaseMesh(base_, coded.base));
  const Span<const Topology> topologies = Span<const Topology>(target_.topologies.data(), coded.levels.size());
  LACERTA_ASSIGN_OR_RETURN(RefinementBytes refinement, WriteRefinement(coded.base, topologies, coded.steps, coded.levels, normal_mesh_.mesh.tags));
  stream.part_sizes = {stream.base.size()};
  stream.part_sizes.insert(stream.part_sizes.end(), refinement.part_sizes.begin(), refinement.part_sizes.end());
  stream.refinement = std::move(refinement.bytes);
  stream.decoded = {normal_mesh_.mesh.base_triangles, num_base_vertices(), target_.num_levels(), Synthesize(target_, coded),
                    normal_mesh_.mesh.tags};
  stream.plane_distortion = PlaneDistortion(target_, stream.decoded.positions);
  stream.triangles = FinestTriangles();
  return stream;
}

std::vector<Triangle> NormalMeshCandidate::FinestTriangles() const {
  return WithStillTriangles(target_.topologies.back().triangles, normal_mesh_.mesh.base_triangles, normal_mesh_.mesh.tags);
}

TriangleMesh NormalMeshCandidate::RemeshedSurface() const { return {target_.points, FinestTriangles()}; }

}  // namespace lacerta
