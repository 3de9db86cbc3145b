// The inverse of Analyze (encoder/analysis.h), written plainly for tests: no quantization.
#ifndef LACERTA_TESTS_SHAPES_OPEN_LOOP_SYNTHESIS_H_
#define LACERTA_TESTS_SHAPES_OPEN_LOOP_SYNTHESIS_H_

#include <vector>

#include "common/butterfly.h"
#include "common/local_frame.h"
#include "common/subdivision.h"
#include "encoder/analysis.h"
#include "lacerta/mesh.h"

namespace lacerta::shapes {

// Positions of the finest level from base positions (#V0) and the details of all levels.
inline std::vector<Vec3f> Synthesize(Topology topology, std::vector<Vec3f> positions,
                                     const std::vector<LevelCoefficients>& levels) {
  for (const LevelCoefficients& level : levels) {
    const std::vector<Vec3f> predicted = PredictMidpoints(topology, StencilTable(topology), positions);
    const std::vector<LocalFrame> frames = ComputeLocalFrames(topology, positions, predicted);
    for (uint32_t e = 0; e < topology.num_edges(); ++e)
      positions.push_back(predicted[e] + frames[e].ToWorld(level.detail[e]));
    topology = Refine(topology);
  }
  return positions;
}

}  // namespace lacerta::shapes

#endif  // LACERTA_TESTS_SHAPES_OPEN_LOOP_SYNTHESIS_H_
