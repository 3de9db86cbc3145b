#include "encoder/midpoint_stencils.h"

#include "encoder/for_ranges.h"

namespace lacerta {

MidpointStencils::MidpointStencils(const Topology& topology, const StencilTable& table) : regular_(topology.num_edges()) {
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    const size_t first = entries_.size();
    bool is_regular = true;
    VisitStencil(topology, table, e, [&](uint32_t v, float weight) {
      const size_t k = entries_.size() - first;
      is_regular = is_regular && k < kSize && weight == kWeights[k];
      entries_.push_back({v, weight});
    });
    if (is_regular && entries_.size() == first + kSize) {
      for (size_t k = 0; k < kSize; ++k) regular_[e][k] = entries_[first + k].vertex;
      entries_.resize(first);
    } else {
      others_.push_back({e, first, entries_.size()});
    }
  }
}

void MidpointStencils::Predict(const Vec3f* positions, Vec3f* midpoints) const {
  // The others stand in the first table as well, as stencils of vertex 0, so that this loop has no branch.
  ForRanges(regular_.size(), [&](size_t begin, size_t end) {
    for (size_t e = begin; e < end; ++e) {
      Vec3f sum;
      for (size_t k = 0; k < kSize; ++k) sum += positions[regular_[e][k]] * kWeights[k];
      midpoints[e] = sum;
    }
  });
  for (const Other& other : others_) {
    Vec3f sum;
    for (size_t i = other.first; i < other.end; ++i) sum += positions[entries_[i].vertex] * entries_[i].weight;
    midpoints[other.edge] = sum;
  }
}

std::vector<Vec3f> MidpointStencils::Predict(const std::vector<Vec3f>& positions) const {
  std::vector<Vec3f> midpoints(regular_.size());
  Predict(positions.data(), midpoints.data());
  return midpoints;
}

}  // namespace lacerta
