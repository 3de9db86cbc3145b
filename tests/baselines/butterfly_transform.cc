#include "baselines/transform.h"
#include "common/butterfly.h"
#include "common/local_frame.h"
#include "encoder/allocation/subband_weights.h"

namespace lacerta::baselines {
namespace {

class ButterflyTransform : public Transform {
 public:
  ButterflyTransform(uint32_t num_base_vertices, const std::vector<Triangle>& base_triangles,
                     std::vector<Topology> topologies)
      : num_base_vertices_(num_base_vertices),
        base_triangles_(base_triangles),
        topologies_(std::move(topologies)),
        stencils_(topologies_[0]),
        energies_(RegularEnergies(num_levels())) {}

  StatusOr<Decomposition> Analyze(const std::vector<Vec3f>& positions) const override {
    Decomposition result;
    LACERTA_ASSIGN_OR_RETURN(result.levels,
                             lacerta::Analyze({base_triangles_, num_base_vertices_, num_levels(), positions}));
    result.base.assign(positions.begin(), positions.begin() + num_base_vertices_);
    return result;
  }

  StatusOr<std::vector<Vec3f>> Synthesize(const Decomposition& decomposition) const override {
    std::vector<Vec3f> positions = decomposition.base;
    for (int level = 0; level < num_levels(); ++level) {
      const Topology& t = topologies_[level];
      std::vector<Vec3f> midpoints = PredictMidpoints(t, stencils_, positions);
      const std::vector<LocalFrame> frames = ComputeLocalFrames(t, positions, midpoints);
      for (uint32_t e = 0; e < t.num_edges(); ++e)
        midpoints[e] += frames[e].ToWorld(decomposition.levels[level].detail[e]);
      positions.insert(positions.end(), midpoints.begin(), midpoints.end());
    }
    return positions;
  }

  const std::vector<double>& energies() const override { return energies_; }
  const std::vector<Topology>& topologies() const override { return topologies_; }

 private:
  int num_levels() const { return static_cast<int>(topologies_.size()); }

  uint32_t num_base_vertices_;
  std::vector<Triangle> base_triangles_;
  std::vector<Topology> topologies_;
  StencilTable stencils_;
  std::vector<double> energies_;
};

}  // namespace

StatusOr<std::unique_ptr<Transform>> MakeButterflyTransform(uint32_t num_base_vertices,
                                                            const std::vector<Triangle>& base_triangles,
                                                            int num_levels) {
  LACERTA_ASSIGN_OR_RETURN(Topology topology, BuildTopology(num_base_vertices, base_triangles));
  std::vector<Topology> topologies = {std::move(topology)};
  while (static_cast<int>(topologies.size()) < num_levels) topologies.push_back(Refine(topologies.back()));
  return std::unique_ptr<Transform>(new ButterflyTransform(num_base_vertices, base_triangles, std::move(topologies)));
}

}  // namespace lacerta::baselines
