#include "encoder/analysis.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "common/butterfly.h"
#include "common/local_frame.h"
#include "common/subdivision.h"

namespace lacerta {
namespace {

Status CheckShape(const SemiRegularMesh& mesh, const Topology& base) {
  if (mesh.num_levels < 0) return InvalidArgument("a mesh cannot have " + std::to_string(mesh.num_levels) + " levels");
  const LevelCounts counts = SubdividedCounts({base.num_vertices, base.num_edges(), base.num_faces()}, mesh.num_levels);
  if (counts.faces > std::numeric_limits<uint32_t>::max() || counts.vertices != mesh.positions.size()) {
    return InvalidArgument("a mesh of " + std::to_string(mesh.num_levels) + " levels on this base has " +
                           std::to_string(counts.vertices) + " vertices, but " + std::to_string(mesh.positions.size()) +
                           " positions were given");
  }
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3f& p = mesh.positions[v];
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
    return InvalidArgument("the position of vertex " + std::to_string(v) + " is not finite");
  }
  return Status();
}

LevelCoefficients AnalyzeLevel(const Topology& coarse, const std::vector<Vec3f>& coarse_positions,
                               Span<Vec3f> new_positions) {
  const std::vector<Vec3f> predicted = PredictMidpoints(coarse, StencilTable(coarse), coarse_positions);
  const std::vector<LocalFrame> frames = ComputeLocalFrames(coarse, coarse_positions, predicted);
  LevelCoefficients level;
  level.detail.reserve(coarse.num_edges());
  double length = 0.0;
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
    level.detail.push_back(coarse.is_copy(e) ? Vec3f() : frames[e].ToLocal(new_positions[e] - predicted[e]));
    length += Norm(coarse_positions[coarse.edges[e][1]] - coarse_positions[coarse.edges[e][0]]);
  }
  if (coarse.num_edges() > 0) level.mean_edge_length = length / coarse.num_edges();
  return level;
}

}  // namespace

StatusOr<std::vector<LevelCoefficients>> Analyze(const SemiRegularMesh& mesh) {
  LACERTA_ASSIGN_OR_RETURN(Topology topology, BuildTopology(mesh.num_base_vertices, mesh.base_triangles, mesh.tags));
  LACERTA_RETURN_IF_ERROR(CheckShape(mesh, topology));
  std::vector<LevelCoefficients> levels;
  for (int level = 1; level <= mesh.num_levels; ++level) {
    const std::vector<Vec3f> coarse(mesh.positions.begin(), mesh.positions.begin() + topology.num_vertices);
    levels.push_back(AnalyzeLevel(topology, coarse, Span<Vec3f>(mesh.positions).Subspan(topology.num_vertices)));
    if (level < mesh.num_levels) topology = Refine(topology);
  }
  return levels;
}

double NormalDetailShare(const std::vector<LevelCoefficients>& levels, const NormalTolerance& tolerance) {
  size_t count = 0, normal = 0;
  for (const LevelCoefficients& level : levels) {
    const double absolute = tolerance.share_of_edge_length * level.mean_edge_length;
    for (const Vec3f& d : level.detail) {
      const double tangential = std::hypot(static_cast<double>(d.x), static_cast<double>(d.y));
      ++count;
      if (tangential <= absolute || tangential <= tolerance.share_of_normal * std::fabs(d.z)) ++normal;
    }
  }
  return count == 0 ? 1.0 : static_cast<double>(normal) / static_cast<double>(count);
}

}  // namespace lacerta
