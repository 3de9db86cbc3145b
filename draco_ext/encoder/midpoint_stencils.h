// The stencils of all edges of one level as flat tables, for an encoder that predicts the same midpoints a hundred times.
#ifndef LACERTA_ENCODER_MIDPOINT_STENCILS_H_
#define LACERTA_ENCODER_MIDPOINT_STENCILS_H_

#include <array>
#include <cstdint>
#include <vector>

#include "common/butterfly.h"
#include "common/subdivision.h"
#include "lacerta/mesh.h"

namespace lacerta {

// Predicts what PredictMidpoints (common/butterfly.h) does, to the last bit, without walking the topology.
class MidpointStencils {
 public:
  MidpointStencils() = default;  // of no edges
  MidpointStencils(const Topology& topology, const StencilTable& table);

  // From #V positions into #E midpoints, which may lie behind them in one array.
  void Predict(const Vec3f* positions, Vec3f* midpoints) const;
  std::vector<Vec3f> Predict(const std::vector<Vec3f>& positions) const;

 private:
  static constexpr size_t kSize = 8;
  static constexpr std::array<float, kSize> kWeights = {0.5f, 0.5f, 0.125f, -0.0625f, -0.0625f, 0.125f, -0.0625f, -0.0625f};

  // A stencil of other weights or another length: entries [first, end).
  struct Other {
    uint32_t edge;
    size_t first, end;
  };
  struct Entry {
    uint32_t vertex;
    float weight;
  };

  std::vector<std::array<uint32_t, kSize>> regular_;  // #E: the vertices that kWeights belong to, in the order of VisitStencil
  std::vector<Other> others_;                         // few on fine levels
  std::vector<Entry> entries_;
};

}  // namespace lacerta

#endif  // LACERTA_ENCODER_MIDPOINT_STENCILS_H_
