#include "draco/normal_mesh_candidate.h"

#include <algorithm>
#include <utility>

#include "common/base_tags.h"
#include "encoder/layer_split.h"
#include "encoder/layer_writer.h"
#include "encoder/paper_mode.h"
#include "encoder/quantizer.h"
#include "encoder/step_law.h"
#include "encoder/stream_writer.h"
#include "encoder/vertex_repair.h"

namespace lacerta {

NormalMeshCandidate::NormalMeshCandidate(CodedBase base, NormalMesh normal_mesh)
    : base_(std::move(base)),
      normal_mesh_(std::move(normal_mesh)),
      target_(MakeSurfaceTarget(normal_mesh_)),
      detail_scales_(DetailScales(target_)) {}

// Whether decoders, who take base vertices at one point of the lattice for joined ones, join the borders of cuts and no others.
bool NormalMeshCandidate::JoinsTheCuts(const BaseMesh& lattice) const {
  BaseTags tags = normal_mesh_.mesh.tags;
  if (tags.joined.empty()) return true;
  tags.joined = FirstAtSamePoint(lattice.lattice);
  const Topology& wanted = target_.topologies.front();
  Topology joined = wanted;
  return SetTags(tags, &joined).ok() && joined.edges == wanted.edges && joined.master == wanted.master;
}

// The base on a lattice of that step, or of one so much finer that cuts are closed and nothing else is.
BaseMesh NormalMeshCandidate::BaseLattice(const TriangleMesh& base, double step) const {
  constexpr int kMostHalvings = 24;
  BaseMesh lattice = RoundToLattice(base, static_cast<float>(step));
  for (int i = 0; i < kMostHalvings && !JoinsTheCuts(lattice); ++i) {
    step /= 2;
    lattice = RoundToLattice(base, static_cast<float>(step));
  }
  return lattice;
}

// The remesh rounded to the lattice and the steps of a slope. decoded: becomes what a decoder makes of it.
CodedSurface NormalMeshCandidate::FirstRounding(const CodingSlope& slope, std::vector<Vec3f>* decoded) const {
  const std::vector<Vec3f> base(target_.points.begin(), target_.points.begin() + num_base_vertices());
  const BaseMesh lattice = BaseLattice({base, normal_mesh_.mesh.base_triangles}, BaseStepForSlope(slope.base_lambda, num_base_vertices()));
  std::vector<LevelSteps> steps = StepsForSlope(target_, slope.last_detailed, slope.step_lambda);
  if (!target_.keeps_vertices) {
    // Levels far beyond the last detailed one hardly ever keep a coefficient: not looking at them takes a fraction of the time.
    constexpr size_t kTriedSilentLevels = 1;
    for (size_t i = static_cast<size_t>(slope.last_detailed) + kTriedSilentLevels; i < steps.size(); ++i) steps[i] = steps[i].Silent();
  }
  return QuantizeClosedLoop(target_, lattice, steps, decoded);
}

StatusOr<CodedSurface> NormalMeshCandidate::CodeSurface(const CodingSlope& slope, EncodeMode mode, const CodedSurface* from,
                                                        std::vector<Vec3f>* decoded) const {
  if (mode == EncodeMode::kPaper) {
    LACERTA_ASSIGN_OR_RETURN(CodedSurface coded, CodeByModel(normal_mesh_.mesh, slope.lambda));
    *decoded = Synthesize(target_, coded);
    return coded;
  }
  DescentOptions options;
  options.lambda = slope.lambda;
  options.passes = slope.passes;
  if (from != nullptr) *decoded = Synthesize(target_, *from);
  CodedSurface coded = Descend(target_, from != nullptr ? *from : FirstRounding(slope, decoded), options, decoded);
  if (target_.keeps_vertices) {
    RepairVertices(target_, &coded);
    *decoded = Synthesize(target_, coded);
  }
  return coded;
}

StatusOr<CodedStream> NormalMeshCandidate::Code(const CodingSlope& slope, EncodeMode mode, const CodedSurface* from) const {
  std::vector<Vec3f> decoded;
  CodedStream stream;
  LACERTA_ASSIGN_OR_RETURN(stream.coded, CodeSurface(slope, mode, from, &decoded));
  LACERTA_ASSIGN_OR_RETURN(stream.base, RecodeBaseMesh(base_, stream.coded.base));
  LACERTA_ASSIGN_OR_RETURN(RefinementBytes refinement, Write(stream.coded, slope));
  stream.part_sizes = {stream.base.size()};
  stream.part_sizes.insert(stream.part_sizes.end(), refinement.part_sizes.begin(), refinement.part_sizes.end());
  stream.refinement = std::move(refinement.bytes);
  stream.decoded = {normal_mesh_.mesh.base_triangles, num_base_vertices(), target_.num_levels(), std::move(decoded),
                    normal_mesh_.mesh.tags};
  stream.plane_distortion = PlaneDistortion(target_, stream.decoded.positions);
  stream.triangles = FinestTriangles();
  return stream;
}

StatusOr<RefinementBytes> NormalMeshCandidate::Write(const CodedSurface& coded, const CodingSlope& slope) const {
  const BaseStepField base_step = base_.coding == BaseCoding::kCompact ? BaseStepField::kLeftOut : BaseStepField::kWritten;
  const BaseTags& tags = normal_mesh_.mesh.tags;
  const Span<const Topology> topologies(target_.topologies.data(), coded.levels.size());
  if (slope.quality_layers > 1) {
    constexpr int kLayerPasses = 2;
    const std::vector<QualityLayer> layers = SplitIntoLayers(target_, detail_scales_, coded, slope.lambda, slope.quality_layers, kLayerPasses);
    if (layers.size() > 1)
      return WriteLayers(coded.base, topologies, coded.steps, coded.levels, OrderSegments(target_, layers), tags, base_step);
  }
  return WriteRefinement(coded.base, topologies, coded.steps, coded.levels, tags, base_step);
}

std::vector<Triangle> NormalMeshCandidate::FinestTriangles() const {
  return WithStillTriangles(target_.topologies.back().triangles, normal_mesh_.mesh.base_triangles, normal_mesh_.mesh.tags);
}

TriangleMesh NormalMeshCandidate::RemeshedSurface() const { return {target_.points, FinestTriangles()}; }

}  // namespace lacerta
