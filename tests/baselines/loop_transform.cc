#include <utility>

#include "baselines/loop_wavelet.h"
#include "baselines/transform.h"
#include "common/local_frame.h"

namespace lacerta::baselines {
namespace {

// Frames of the new vertices of the subdivided, smoothed surface.
std::vector<LocalFrame> FramesOf(const Topology& t, const LoopWavelet& wavelet,
                                 const std::vector<Vec3f>& control_points) {
  std::vector<Vec3f> fine = wavelet.Subdivide(control_points);
  const std::vector<Vec3f> midpoints(fine.begin() + t.num_vertices, fine.end());
  fine.resize(t.num_vertices);
  return ComputeLocalFrames(t, fine, midpoints);
}

double MeanEdgeLength(const Topology& t, const std::vector<Vec3f>& positions) {
  double sum = 0;
  for (const auto& [a, b] : t.edges) sum += Norm(positions[b] - positions[a]);
  return sum / t.num_edges();
}

class LoopTransform : public Transform {
 public:
  explicit LoopTransform(std::vector<Topology> topologies)
      : topologies_(std::move(topologies)), wavelets_(topologies_.begin(), topologies_.end()) {}

  StatusOr<Decomposition> Analyze(const std::vector<Vec3f>& positions) const override {
    Decomposition result;
    result.levels.resize(wavelets_.size());
    result.base = positions;
    for (size_t level = wavelets_.size(); level-- > 0;) {
      LACERTA_ASSIGN_OR_RETURN(LoopWavelet::Bands bands, wavelets_[level].Analyze(result.base));
      const std::vector<LocalFrame> frames = FramesOf(topologies_[level], wavelets_[level], bands.coarse);
      for (size_t e = 0; e < frames.size(); ++e) bands.detail[e] = frames[e].ToLocal(bands.detail[e]);
      result.levels[level] = {std::move(bands.detail), MeanEdgeLength(topologies_[level], bands.coarse)};
      result.base = std::move(bands.coarse);
    }
    return result;
  }

  StatusOr<std::vector<Vec3f>> Synthesize(const Decomposition& decomposition) const override {
    std::vector<Vec3f> positions = decomposition.base;
    for (size_t level = 0; level < wavelets_.size(); ++level) {
      const std::vector<LocalFrame> frames = FramesOf(topologies_[level], wavelets_[level], positions);
      LoopWavelet::Bands bands = {std::move(positions), decomposition.levels[level].detail};
      for (size_t e = 0; e < frames.size(); ++e) bands.detail[e] = frames[e].ToWorld(bands.detail[e]);
      LACERTA_ASSIGN_OR_RETURN(positions, wavelets_[level].Synthesize(bands));
    }
    return positions;
  }

  // By noise of one standard deviation on all coefficients of a level, alone: the operator is linear without the
  // frames.
  Status ProbeEnergies() {
    uint64_t state = 1;
    const auto sign = [&state] {
      return (state = state * 6364136223846793005u + 1442695040888963407u) >> 63 != 0 ? 1.0f : -1.0f;
    };
    for (size_t level = 0; level <= wavelets_.size(); ++level) {
      const size_t count = level == 0 ? topologies_[0].num_vertices : topologies_[level - 1].num_edges();
      std::vector<Vec3f> field, noise;
      for (size_t i = 0; i < count; ++i) noise.push_back({sign(), sign(), sign()});
      if (level == 0) {
        field = noise;
      } else {
        LACERTA_ASSIGN_OR_RETURN(
            field, wavelets_[level - 1].Synthesize({std::vector<Vec3f>(topologies_[level - 1].num_vertices), noise}));
      }
      for (size_t finer = level; finer < wavelets_.size(); ++finer) field = wavelets_[finer].Subdivide(field);
      double sum = 0;
      for (const Vec3f& v : field) sum += SquaredNorm(Vec3Cast<double>(v));
      energies_.push_back(sum / (3.0 * static_cast<double>(count)));
    }
    return Status();
  }

  const std::vector<double>& energies() const override { return energies_; }
  const std::vector<Topology>& topologies() const override { return topologies_; }

 private:
  std::vector<Topology> topologies_;
  std::vector<LoopWavelet> wavelets_;
  std::vector<double> energies_;
};

}  // namespace

StatusOr<std::unique_ptr<Transform>> MakeLoopTransform(uint32_t num_base_vertices,
                                                       const std::vector<Triangle>& base_triangles, int num_levels) {
  LACERTA_ASSIGN_OR_RETURN(Topology topology, BuildTopology(num_base_vertices, base_triangles));
  std::vector<Topology> topologies = {std::move(topology)};
  while (static_cast<int>(topologies.size()) < num_levels) topologies.push_back(Refine(topologies.back()));
  auto transform = std::make_unique<LoopTransform>(std::move(topologies));
  LACERTA_RETURN_IF_ERROR(transform->ProbeEnergies());
  return std::unique_ptr<Transform>(std::move(transform));
}

}  // namespace lacerta::baselines
